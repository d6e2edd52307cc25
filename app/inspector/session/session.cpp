#include "inspector/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/recordings/recording.h"
#include "run/export_case.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Maximum bodies shown over the last frames.
constexpr std::size_t kMaxTrails = 2;

}  // namespace

Session::Session(std::vector<Algorithm> algorithms, ExecutorFactory make_host)
    : tracks(std::move(algorithms)), jobs(make_host), runs(std::move(make_host)) {
  playback.on_show = [this] {
    selection.reset();
    mismatches.reset();
    if (second) second->frame.reset();
    noticed_failure_.clear();
    notices.status = {};  // it told of what was open before
  };
  playback.on_move = [this](bool forward) { mismatches.moved(forward); };
  tracks.on_change = [this] { mismatches.forgetStop(); };
}

void Session::advance(const RunProgress& progress, double seconds) {
  noticeJobs();
  known_frames_ = progress.known_frames;
  frames_ = progress.source == playback.source() ? progress.frames : nullptr;
  if (!playback.follow(progress)) return;
  timeline.follow(playback.source(), playback.lastFrame(), playback.frame());
  noticeFailure(progress);
  document.advance(progress);
  mismatches.advance(progress);
  playback.advance(progress, seconds);
}

bool Session::busy() { return playback.playing() || !runs.isIdle() || jobs.running(); }

ViewRequest Session::request() const {
  ViewRequest request{.source = playback.source(),
                      .tracks = tracks.specs(),
                      .frame = playback.frame(),
                      .playing = playback.playing(),
                      .check = mismatches.check,
                      .stop_at_mismatch = mismatches.stop_at_mismatch,
                      .known_mismatch = mismatches.known(),
                      .shown_track = tracks.shown(),
                      .structure = display.structure || display.colourMode().of_tests,
                      .trail_bodies = selection.bodies(),
                      .second = second};
  if (request.trail_bodies.size() > kMaxTrails) request.trail_bodies.clear();
  return request;
}

void Session::commit() {
  if (ViewRequest now = request(); now != committed_) {
    runs.request(now);
    committed_ = std::move(now);
  }
}

void Session::noticeFailure(const RunProgress& progress) {
  if (progress.failure == noticed_failure_) return;
  noticed_failure_ = progress.failure;
  if (progress.failure.empty()) return;
  playback.pause();
  notices.complain(progress.failure);
}

void Session::noticeJobs() {
  for (Job* const job : jobs.all()) {
    if (!job->takeEnd()) continue;
    const JobStatus ended = job->status();
    if (!ended.failure.empty()) notices.complain(ended.failure);
    if (ended.outcome.empty()) continue;
    notices.say(ended.outcome, ended.faulty ? Severity::error : Severity::note);
  }
}

void Session::play(bool on) {
  if (on && !playback.source()) {
    notices.say("nothing is open: simulate a scene, or open a file", Severity::warning);
    return;
  }
  if (on && document.atRest()) document.simulate();
  playback.play(on);
}

void Session::saveRecording(const fs::path& path) {
  notices.attempt([&] {
    if (!frames_) throw InputError("nothing is open");
    const auto frames = frames_(known_frames_);
    RecordingWriter writer(path, frames->scene());
    recordAll(*frames, writer);
    writer.finish();
    notices.say(fmt::format("recorded: {}", path.string()));
    notices.on_file(path);
  });
}

void Session::exportCase(const Case& test_case, std::shared_ptr<const Snapshot> snapshot,
                         fs::path file) {
  const SceneInfo scene = playback.scene();
  if (!file.has_extension()) file += recordingExtension(scene);
  notices.attempt([&] {
    requireExportable(file, snapshot->source->recording, scene);
    if (!frames_ || snapshot->source != playback.source()) {
      throw InputError("exporting a case: another scene has been opened");
    }
    startExport(jobs.get<CaseExport>(), test_case, frames_(snapshot->frame), snapshot->difference,
                file, jobs.make_host);
  });
}

void Session::startDuel(double max_seconds) {
  notices.attempt([&] {
    if (!frames_) throw InputError("duel: nothing is open");
    std::vector<Case> cases;
    for (const TrackSpec& track : tracks.specs()) cases.push_back(track.test_case);
    broadmark::startDuel(jobs.get<BackgroundDuel>(), cases, frames_(known_frames_), max_seconds,
                         jobs.make_host);
  });
}

void Session::showSecond(bool on) {
  second.reset();
  if (!on) return;
  second.emplace();
  const auto other = std::ranges::find_if(
      tracks.list, [this](const TrackEdit& track) { return track.number != tracks.shown(); });
  if (other != tracks.list.end()) second->track = other->number;
  // Without another algorithm's answer it is the same one's, and stays where it is.
  if (other == tracks.list.end() && tracks.shown() == 0) second->frame = playback.frame();
}

void Session::showBeside(const fs::path& recording) {
  notices.attempt([&] {
    FrameProviderRequest source = recordingSource(recording, {}, playback.swept);
    second =
        SecondViewRequest{.source = std::make_shared<const FrameProviderRequest>(std::move(source)),
                          .frame = {},
                          .track = tracks.shown()};
  });
}

}  // namespace broadmark
