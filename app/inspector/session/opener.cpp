// Opens files of all kinds, cases of results, and plans.

#include <memory>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/scenes/authored_simulation.h"
#include "inspector/session/frame_provider_requests.h"
#include "inspector/session/session.h"
#include "sources/make_source.h"
#include "sources/results.h"

namespace broadmark {

namespace fs = std::filesystem;

void Session::open(const fs::path& path) {
  notices.attempt([&] {
    OpenedSource opened = openSource(path.string(), {.algorithms = tracks.algorithms()});
    if (opened.results) {
      listCases(path, std::move(*opened.results));
    } else {
      openEntry(std::move(opened.entries.at(0)), Opened::at_rest);
    }
    notices.on_file(path);
  });
}

void Session::openCase(const fs::path& file, const std::string& id) {
  notices.attempt([&] {
    OpenedSource opened =
        openSource(file.string(), {.case_id = id, .algorithms = tracks.algorithms()});
    openEntry(std::move(opened.entries.at(0)), Opened::in_motion);
  });
}

void Session::openCase(OpenedResults::Row& row) {
  try {
    openEntry(entryOf(row.result, results->file(), tracks.algorithms()), Opened::in_motion);
    row.obstacle.clear();
  } catch (const InputError& error) {
    row.obstacle = error.what();
    notices.say(row.obstacle, Severity::error);
  }
}

void Session::open(Plan plan) {
  for (const Case& test_case : plan.cases) tracks.add(test_case);
  if (auto& unchosen = plan.unchosen_case) {
    listCases(unchosen->file, std::move(unchosen->results));
    notices.on_file(unchosen->file);
  }
  if (!plan.entries.empty()) openEntry(std::move(plan.entries.front()), Opened::in_motion);
}

void Session::openEntry(PlanEntry entry, Opened document_is) {
  if (dynamic_cast<scenes::SceneDocument*>(entry.source.simulation.get()) == nullptr) {
    enter(entry, document_is);
    return;
  }
  // std::function wants what can be copied.
  const auto waiting = std::make_shared<PlanEntry>(std::move(entry));
  document.leave([this, waiting, document_is] { enter(*waiting, document_is); });
}

void Session::enter(PlanEntry& entry, Opened document_is) {
  enterSource(entry, document_is);
  if (entry.cases.empty()) return;
  tracks.clear();
  for (const Case& test_case : entry.cases) tracks.add(test_case);
  const std::optional<FrameDifference> difference = entry.knownDifference();
  if (!difference) return;
  playback.seek(difference->frame);
  mismatches.check = mismatches.stop_at_mismatch = true;
  notices.bringUp("Mismatches");
}

void Session::enterSource(PlanEntry& entry, Opened document_is) {
  Source& source = entry.source;
  const auto show = [&](FrameProviderRequest request) {
    if (entry.known) {
      request.origin = FrameOrigin::results;
      request.title = entry.known->id;
    }
    playback.show(std::move(request));
  };
  playback.swept = source.reference.reading.contains("swept");
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(source.simulation.get())) {
    const fs::path file = source.simulation->input();
    if (playback.swept)
      throw InputError("--swept: not of a scene that is edited: bake it, or add --headless");
    document.start(authored->document(), file);
    if (document_is == Opened::in_motion) document.simulate();
  } else if (source.simulation) {
    // A hash that is expected would be known only after the last frame.
    draft.take(std::move(source.simulation));
    show(simulationSource(draft.scene(), playback.swept));
  } else if (source.imported) {
    show(importSource(source.reference, playback.swept));
    notices.on_file(source.reference.path);
  } else if (!source.reference.path.empty()) {
    show(recordingSource(source.reference.path, source.expected_hash, playback.swept));
    notices.on_file(source.reference.path);
  }
}

void Session::listCases(const fs::path& file, Results listed) {
  results.emplace(file, std::move(listed), tracks.algorithms());
  notices.bringUp("Cases");
}

void Session::openExport(const ExportReport& report) {
  notices.attempt([&] {
    playback.swept = false;
    playback.show(recordingSource(report.file, {}, playback.swept));
    tracks.clear();
    tracks.add(report.test_case);
    playback.seek(static_cast<std::int64_t>(report.now.frames));
    notices.on_file(report.file);
  });
}

}  // namespace broadmark
