#include "inspector/case_export.h"

#include "case_reference.h"
#include "broadmark/error.h"

namespace broadmark {

const char* exportStateName(CaseExport::State state) {
  switch (state) {
    case CaseExport::State::idle:
      return "idle";
    case CaseExport::State::running:
      return "running";
    case CaseExport::State::done:
      return "done";
    case CaseExport::State::cancelled:
      return "cancelled";
    case CaseExport::State::failed:
      return "failed";
  }
  return "";
}

CaseExport::~CaseExport() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void CaseExport::start(const Case& run, std::unique_ptr<FrameSource> source, FrameDifference known,
                       std::filesystem::path file) {
  if (running()) throw InputError("a case is being exported already: cancel it first");
  if (thread_.joinable()) thread_.join();
  cancelled_ = false;
  ended_ = false;
  const std::size_t bodies = source->scene().objects;
  report_ = {.state = State::running,
             .run = run,
             .file = std::move(file),
             .whole_bodies = bodies,
             .whole_frames = known.frame,
             .bodies = bodies,
             .frames = known.frame};
  thread_ = std::thread(
      [this, source = std::move(source), known = std::move(known)] { work(*source, known); });
}

CaseExport::Report CaseExport::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void CaseExport::work(FrameSource& source, const FrameDifference& known) {
  State end = State::failed;
  std::string failure;
  try {
    end = shrinkAndWrite(source, known);
  } catch (const std::bad_alloc&) {
    failure = "exporting the case: out of memory";
  } catch (const std::exception& error) {
    failure = error.what();
  }
  {
    const std::lock_guard lock(mutex_);
    report_.state = end;
    report_.failure = std::move(failure);
  }
  ended_ = true;
}

CaseExport::State CaseExport::shrinkAndWrite(FrameSource& source, const FrameDifference& known) {
  const Report begun = report();
  const auto note = [this](const ShrinkProgress& now) {
    const std::lock_guard lock(mutex_);
    report_.trials = now.trials;
    report_.bodies = now.bodies;
    report_.frames = now.frames;
  };
  const ShrunkCase shrunk =
      shrinkCase(begun.run, source, known,
                 {.progress = note, .cancelled = [this] { return cancelled_.load(); }});
  if (!shrunk.minimal) return State::cancelled;
  writePart(begun.file, source, shrunk.selection);
  note({.trials = shrunk.trials,
        .bodies = shrunk.selection.bodies.size(),
        .frames = shrunk.selection.frames.size() - 1});
  const std::lock_guard lock(mutex_);
  report_.command = reproducingCommand(begun.run, begun.file);
  return State::done;
}

}  // namespace broadmark
