// Opens files of all kinds, cases of results, and plans.

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/scenes/authored_simulation.h"
#include "inspector/session/frame_provider_requests.h"
#include "inspector/session/session.h"
#include "sources/make_source.h"
#include "sources/results.h"

namespace broadmark {

namespace fs = std::filesystem;

void Session::open(const fs::path& path) {
  if (isLibraryFile(path)) return plugins.load(path);
  notices.catchErrors([&] {
    if (auto import = importOf(path.string())) {
      startReading(jobs.get<BackgroundReading>(), path, std::move(*import));
      replaced_by_reading_ = playback.source();
      return;
    }
    OpenedSource opened = openSource(path.string(), {.algorithms = tracks.algorithms()});
    if (opened.results) {
      showResults(path, std::move(*opened.results));
    } else {
      openEntry(std::move(opened.entries.at(0)), DocumentStart::at_rest);
    }
    notices.on_file_used(path);
  });
}

void Session::showRead() {
  if (!replaced_by_reading_) return;
  BackgroundReading& job = jobs.get<BackgroundReading>();
  const bool is_wanted = playback.source() == *replaced_by_reading_;
  if (!is_wanted) job.cancel();
  if (job.running()) return;
  replaced_by_reading_.reset();
  const ReadingReport report = job.report();
  if (!is_wanted || report.state != TaskState::done) return;
  notices.catchErrors([&] {
    PlanEntry entry;
    entry.source = std::move(*report.source);
    openEntry(std::move(entry), DocumentStart::at_rest);
  });
}

void Session::openCase(const fs::path& file, const std::string& id) {
  notices.catchErrors([&] {
    OpenedSource opened =
        openSource(file.string(), {.case_id = id, .algorithms = tracks.algorithms()});
    openEntry(std::move(opened.entries.at(0)), DocumentStart::in_motion);
  });
}

void Session::openCase(OpenedResults::Row& row) {
  try {
    openEntry(entryOf(row.result, results->file(), tracks.algorithms()), DocumentStart::in_motion);
    row.obstacle.clear();
  } catch (const InputError& error) {
    row.obstacle = error.what();
    notices.setStatus(row.obstacle, Severity::error);
  }
}

void Session::open(Plan plan) {
  mismatches.check = plan.request.policy.check != CheckMode::off;
  for (const Case& test_case : plan.cases) tracks.add(test_case);
  if (auto& unchosen = plan.unchosen_case) {
    showResults(unchosen->file, std::move(unchosen->results));
    notices.on_file_used(unchosen->file);
  }
  if (plan.entries.empty()) return;
  // A scene opens for editing, unless one of its later frames is asked for.
  PlanEntry& entry = plan.entries.front();
  const bool at_rest = !plan.request.frame && !entry.known;
  openEntry(std::move(entry), at_rest ? DocumentStart::at_rest : DocumentStart::in_motion);
}

void Session::openEntry(PlanEntry entry, DocumentStart start) {
  if (dynamic_cast<scenes::SceneDocument*>(entry.source.simulation.get()) == nullptr) {
    loadEntry(entry, start);
    return;
  }
  // std::function requires copyable captures.
  const auto shared = std::make_shared<PlanEntry>(std::move(entry));
  document.closeThen([this, shared, start] { loadEntry(*shared, start); });
}

void Session::loadEntry(PlanEntry& entry, DocumentStart start) {
  loadSource(entry, start);
  if (entry.cases.empty()) return;
  tracks.clear();
  for (const Case& test_case : entry.cases) tracks.add(test_case);
  const std::optional<FrameDifference> difference = entry.knownDifference();
  if (!difference) return;
  playback.seek(difference->frame);
  mismatches.check = mismatches.stop_at_mismatch = true;
  notices.raisePanel("Mismatches");
}

void Session::loadSource(PlanEntry& entry, DocumentStart start) {
  Source& source = entry.source;
  const auto show = [&](FrameProviderRequest request) {
    if (entry.known) {
      request.origin = FrameOrigin::results;
      request.title = entry.known->id;
    }
    playback.show(std::move(request));
  };
  playback.reading = adaptersIn(source.reference.reading);
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(source.simulation.get())) {
    const fs::path file = source.simulation->input();
    if (!playback.reading.empty()) {
      throw InputError(
          fmt::format("{}: not available for an authored scene: bake it, or add --headless",
                      parameterOption(playback.reading.begin()->first)));
    }
    document.load(authored->document(), file);
    if (!file.empty()) notices.on_file_used(file);
    if (start == DocumentStart::in_motion) document.simulate();
  } else if (source.simulation) {
    // The hash is not verified: it is known only after the last frame.
    draft.adopt(std::move(source.simulation));
    show(simulationSource(draft.scene(), playback.reading));
  } else if (source.imported) {
    show(importSource(source, playback.reading));
    notices.on_file_used(source.reference.path);
  } else if (!source.reference.path.empty()) {
    show(recordingSource(source.reference.path, source.expected_hash, playback.reading));
    notices.on_file_used(source.reference.path);
  }
}

void Session::showResults(const fs::path& file, Results listed) {
  results.emplace(file, std::move(listed), tracks.algorithms());
  notices.raisePanel("Cases");
}

void Session::openExport(const ExportReport& report) {
  notices.catchErrors([&] {
    playback.reading.clear();
    playback.show(recordingSource(report.file, {}, playback.reading));
    tracks.clear();
    tracks.add(report.test_case);
    playback.seek(static_cast<std::int64_t>(report.progress.frames));
    notices.on_file_used(report.file);
  });
}

}  // namespace broadmark
