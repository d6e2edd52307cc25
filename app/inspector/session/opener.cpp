#include "inspector/session/opener.h"

#include <memory>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/scenes/authored_simulation.h"
#include "inspector/session/footage_requests.h"
#include "inspector/session/session.h"
#include "sources/make_source.h"
#include "sources/results.h"

namespace broadmark {

namespace fs = std::filesystem;

void Opener::open(const fs::path& path) {
  to_.notices.attempt([&] {
    OpenedSource opened = openSource(path.string(), {.algorithms = to_.lanes.algorithms()});
    if (opened.results) {
      listCases(path, std::move(*opened.results));
    } else {
      openEntry(std::move(opened.entries.at(0)), Opened::at_rest);
    }
    to_.notices.on_file(path);
  });
}

void Opener::openCase(const fs::path& file, const std::string& id) {
  to_.notices.attempt([&] {
    OpenedSource opened =
        openSource(file.string(), {.case_id = id, .algorithms = to_.lanes.algorithms()});
    openEntry(std::move(opened.entries.at(0)), Opened::in_motion);
  });
}

void Opener::openCase(OpenedResults::Row& row) {
  try {
    openEntry(entryOf(row.result, to_.results->file(), to_.lanes.algorithms()), Opened::in_motion);
    row.obstacle.clear();
  } catch (const InputError& error) {
    row.obstacle = error.what();
    to_.notices.say(row.obstacle, Message::Kind::error);
  }
}

void Opener::open(Plan plan) {
  for (const Case& run : plan.cases) to_.lanes.add(run);
  if (auto& unchosen = plan.unchosen_case) {
    listCases(unchosen->file, std::move(unchosen->results));
    to_.notices.on_file(unchosen->file);
  }
  if (!plan.entries.empty()) openEntry(std::move(plan.entries.front()), Opened::in_motion);
}

void Opener::openEntry(PlanEntry entry, Opened document_is) {
  if (dynamic_cast<scenes::SceneDocument*>(entry.source.simulation.get()) == nullptr) {
    enter(entry, document_is);
    return;
  }
  // std::function wants what can be copied.
  const auto waiting = std::make_shared<PlanEntry>(std::move(entry));
  to_.document.leave([this, waiting, document_is] { enter(*waiting, document_is); });
}

void Opener::enter(PlanEntry& entry, Opened document_is) {
  enterSource(entry, document_is);
  if (entry.cases.empty()) return;
  to_.lanes.clear();
  for (const Case& run : entry.cases) to_.lanes.add(run);
  const std::optional<FrameDifference> difference = entry.knownDifference();
  if (!difference) return;
  to_.playback.seek(difference->frame);
  to_.mismatches.check = to_.mismatches.stop_at_mismatch = true;
  to_.notices.bringUp("Mismatches");
}

void Opener::enterSource(PlanEntry& entry, Opened document_is) {
  Source& source = entry.source;
  const auto show = [&](FootageRequest footage) {
    if (entry.known) {
      footage.source = FootageSource::results;
      footage.title = entry.known->id;
    }
    to_.playback.show(std::move(footage));
  };
  to_.playback.swept = source.reference.reading.contains("swept");
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(source.simulation.get())) {
    const fs::path file = source.simulation->input();
    if (to_.playback.swept)
      throw InputError("--swept: not of a scene that is edited: bake it, or add --headless");
    to_.document.start(authored->document(), file);
    if (document_is == Opened::in_motion) to_.document.simulate();
  } else if (source.simulation) {
    // A hash that is expected would be known only after the last frame.
    to_.draft.take(std::move(source.simulation));
    show(simulationFootage(to_.draft.scene(), to_.playback.swept));
  } else if (source.imported) {
    show(importFootage(source.reference, to_.playback.swept));
    to_.notices.on_file(source.reference.path);
  } else if (!source.reference.path.empty()) {
    show(recordingFootage(source.reference.path, source.expected_hash, to_.playback.swept));
    to_.notices.on_file(source.reference.path);
  }
}

void Opener::listCases(const fs::path& file, Results listed) {
  to_.results.emplace(file, std::move(listed), to_.lanes.algorithms());
  to_.notices.bringUp("Cases");
}

void Opener::openExport(const ExportReport& report) {
  to_.notices.attempt([&] {
    to_.playback.swept = false;
    to_.playback.show(recordingFootage(report.file, {}, to_.playback.swept));
    to_.lanes.clear();
    to_.lanes.add(report.run);
    to_.playback.seek(static_cast<std::int64_t>(report.frames));
    to_.notices.on_file(report.file);
  });
}

}  // namespace broadmark
