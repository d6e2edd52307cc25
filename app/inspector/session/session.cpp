#include "inspector/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "broadmark/error.h"
#include "run/export_case.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Maximum number of bodies with trails.
constexpr std::size_t kMaxTrails = 2;

}  // namespace

Session::Session(std::vector<Algorithm> algorithms, ExecutorFactory make_executor,
                 SimulationHost host)
    : tracks(std::move(algorithms)),
      jobs(make_executor, host),
      runs(std::move(make_executor), std::move(host)) {
  playback.on_source_change = [this] {
    selection.reset();
    mismatches.reset();
    if (second) second->frame.reset();
    reported_failure_.clear();
    notices.status = {};  // the message was about the previous source
  };
  playback.on_frame_change = [this](bool forward) { mismatches.onFrameChange(forward); };
  tracks.on_change = [this] { mismatches.clearStop(); };
}

void Session::advance(const RunProgress& progress, double seconds) {
  reportFinishedJobs();
  showRead();
  available_frames_ = progress.available_frames;
  open_frames_ = progress.source == playback.source() ? progress.frames : nullptr;
  plugins.reloadRebuilt(progress);
  waited_seconds_ = playback.hasReached(progress) ? 0 : waited_seconds_ + seconds;
  if (!playback.update(progress)) return;
  if (!first_selection.empty()) selection.select(std::exchange(first_selection, {}));
  timeline.update(playback.source(), playback.lastFrame(), playback.frame());
  reportFailure(progress);
  document.advance(progress);
  mismatches.advance(progress);
  plugins.compare(progress);
  playback.advance(progress, seconds);
}

bool Session::busy() {
  return playback.playing() || playback.replaying() || !runs.isIdle() || jobs.running();
}

std::string Session::waitsFor(const RunProgress& progress) const {
  constexpr double kPatienceSeconds = 0.5;
  return waited_seconds_ > kPatienceSeconds ? progress.activity : "";
}

ViewRequest Session::request() const {
  ViewRequest request{.source = playback.source(),
                      .tracks = tracks.specs(),
                      .frame = playback.frame(),
                      .playing = playback.playing(),
                      .check = mismatches.check,
                      .stop_at_mismatch = mismatches.stop_at_mismatch,
                      .acknowledged = mismatches.acknowledged(),
                      .shown_track = tracks.shown(),
                      .structure = display.structure || display.colourMode().of_tests,
                      .trail_bodies = selection.bodies(),
                      .second = second};
  if (request.trail_bodies.size() > kMaxTrails) request.trail_bodies.clear();
  return request;
}

void Session::postRequest() {
  if (ViewRequest now = request(); now != posted_request_) {
    runs.request(now);
    posted_request_ = std::move(now);
  }
}

void Session::reportFailure(const RunProgress& progress) {
  if (progress.failure == reported_failure_) return;
  reported_failure_ = progress.failure;
  if (progress.failure.empty()) return;
  playback.pause();
  notices.reportError(progress.failure);
}

void Session::reportFinishedJobs() {
  for (Job* const job : jobs.all()) {
    if (!job->consumeFinished()) continue;
    const JobStatus status = job->status();
    if (!status.failure.empty()) notices.reportError(status.failure);
    if (!status.file.empty()) notices.on_file_used(status.file);
    if (status.outcome.empty()) continue;
    notices.setStatus(status.outcome, status.is_error ? Severity::error : Severity::note);
  }
}

void Session::play(bool on) {
  if (on && !playback.source()) {
    notices.setStatus("nothing is open: simulate a scene, or open a file", Severity::warning);
    return;
  }
  if (on && document.atRest()) document.simulate();
  playback.play(on);
}

void Session::saveRecording(const fs::path& path) {
  notices.catchErrors([&] {
    if (!open_frames_) throw InputError("nothing is open");
    startSave(jobs.get<BackgroundSave>(), open_frames_(available_frames_), path);
  });
}

void Session::exportCase(const Case& test_case, const FailingFrame& failing, fs::path file) {
  const SceneInfo scene = playback.scene();
  if (!file.has_extension()) file += recordingExtension(scene);
  notices.catchErrors([&] {
    requireExportable(file, failing.source->recording, scene);
    if (!open_frames_ || failing.source != playback.source()) {
      throw InputError("exporting a case: another scene has been opened");
    }
    startExport(jobs.get<CaseExport>(), test_case, open_frames_(failing.frame), failing.difference,
                file, jobs.make_executor);
  });
}

void Session::startDuel(double max_seconds) {
  notices.catchErrors([&] {
    if (!open_frames_) throw InputError("duel: nothing is open");
    std::vector<Case> cases;
    for (const TrackSpec& track : tracks.specs()) cases.push_back(track.test_case);
    broadmark::startDuel(jobs.get<BackgroundDuel>(), cases, open_frames_(available_frames_),
                         max_seconds, jobs.make_executor);
  });
}

void Session::showSecond(bool on) {
  second.reset();
  if (!on) return;
  SecondViewRequest request;
  const auto other = std::ranges::find_if(
      tracks.list, [this](const TrackEdit& track) { return track.number != tracks.shown(); });
  if (other != tracks.list.end()) request.track = other->number;
  // Without another answer to show, freeze the current frame in the second view.
  if (other == tracks.list.end() && tracks.shown() == 0) request.frame = playback.frame();
  second = std::move(request);
}

void Session::openInSecondView(const fs::path& recording) {
  notices.catchErrors([&] {
    FrameProviderRequest source = recordingSource(recording, {}, playback.reading);
    second =
        SecondViewRequest{.source = std::make_shared<const FrameProviderRequest>(std::move(source)),
                          .frame = {},
                          .track = tracks.shown()};
  });
}

}  // namespace broadmark
