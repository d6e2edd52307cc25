#include "inspector/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/recordings/swept_frames.h"
#include "broadmark/render/colouring.h"
#include "broadmark/scenes/authored_simulation.h"
#include "run/export_case.h"
#include "run/recordings.h"
#include "sources/make_source.h"
#include "sources/results.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

bool sameWish(const Wish& a, const Wish& b) {
  return a.footage == b.footage && a.frame == b.frame && a.playing == b.playing &&
         a.check == b.check && a.stop_at_mismatch == b.stop_at_mismatch &&
         a.known_mismatch == b.known_mismatch && a.shown_lane == b.shown_lane &&
         a.structure == b.structure && a.tracked == b.tracked && a.second == b.second &&
         std::ranges::equal(a.lanes, b.lanes,
                            [](const LaneSpec& x, const LaneSpec& y) { return x.same(y); });
}

/// The parameters that a recording was baked with; "": unknown. Only the frames have to be right.
std::string parametersOf(const Recording& recording, const fs::path& path) {
  try {
    const std::string& stated = recording.origin().scene_parameters;
    const std::string text = stated.empty() ? bakedParameters(path) : stated;
    return text.empty() ? "" : formatSceneParameters(*parseSceneParameters(text, path.string()));
  } catch (const InputError&) {
    return "";
  }
}

/// At most so many bodies are followed through the last frames.
constexpr std::size_t kMostTracked = 2;

}  // namespace

Session::Session(std::vector<Algorithm> algorithms, HostMaker make_host)
    : draft(makeSimulation("freefall")),
      lanes(std::move(algorithms)),
      benchmark(make_host),
      runs(make_host),
      make_host_(std::move(make_host)) {
  playback.on_show = [this] {
    selection.follow({});
    mismatches.reset();
    if (second) second->frame.reset();
    noticed_failure_.clear();
    notices.status = {};  // it told of what was open before
  };
  playback.on_move = [this](bool forward) { mismatches.moved(forward); };
  lanes.on_change = [this] { mismatches.forgetStop(); };
  selection.body_count = [this] {
    return document.shown() ? document.desk.editor.scene().bodies.size() : playback.scene().objects;
  };
  selection.companions = [this](BodySelection::Bodies bodies) {
    return document.shown() ? document.desk.editor.withGroups(std::move(bodies)) : bodies;
  };
  selection.on_select = [this](const BodySelection::Bodies& bodies) {
    if (document.shown()) document.desk.editor.select(bodies);
  };
  document.on_save = [this](const fs::path& path) { tellOfFile(path); };
}

void Session::advance(const RunProgress& progress, double seconds) {
  noticeBake();
  noticeBenchmark();
  noticeDuel();
  noticeExport();
  noticeReport();
  if (!playback.follow(progress)) return;
  timeline.follow(playback.footage(), playback.lastFrame(), playback.frame());
  noticeFailure(progress);
  document.advance(progress);
  mismatches.advance(progress);
  playback.passTime(seconds);
  if (playback.hasReached(progress)) playback.advance(seconds);
}

bool Session::busy() { return playback.playing() || !runs.settled() || atWork(); }

void Session::end(std::function<void()> then) {
  if (atWork()) {
    ending = std::move(then);
  } else {
    document.leave(std::move(then));
  }
}

const ColourMode& ViewOptions::colourMode() const {
  return colourModes()[colouring % colourModes().size()];
}

Wish Session::wish() const {
  Wish wish{.footage = playback.footage(),
            .lanes = lanes.specs(),
            .frame = playback.frame(),
            .playing = playback.playing(),
            .check = mismatches.check,
            .stop_at_mismatch = mismatches.stop_at_mismatch,
            .known_mismatch = mismatches.known(),
            .shown_lane = lanes.shown(),
            .structure = view.structure || view.colourMode().of_tests,
            .tracked = selection.bodies(),
            .second = second};
  if (wish.tracked.size() > kMostTracked) wish.tracked.clear();
  return wish;
}

void Session::commit() {
  if (Wish now = wish(); !sameWish(now, committed_)) {
    runs.wish(now);
    committed_ = std::move(now);
  }
  for (const auto& act : std::exchange(put_off_, {})) notices.attempt(act);
}

void Session::noticeFailure(const RunProgress& progress) {
  if (progress.failure == noticed_failure_) return;
  noticed_failure_ = progress.failure;
  if (progress.failure.empty()) return;
  playback.pause();
  notices.complain(progress.failure);
}

void Session::noticeExport() {
  if (!case_export.takeEnd()) return;
  const CaseExport::Report report = case_export.report();
  if (report.state == TaskState::failed) notices.complain(report.failure);
  if (report.state == TaskState::done) {
    notices.say(fmt::format("exported: {}", report.file.string()));
  }
}

void Session::noticeBake() {
  if (!bake.takeEnd()) return;
  const BackgroundBake::Report report = bake.report();
  if (!report.failure.empty()) notices.complain(report.failure);
  notices.say(report.text(), report.failed() > 0 ? Message::Kind::error : Message::Kind::note);
}

void Session::noticeBenchmark() {
  if (!benchmark.takeEnd()) return;
  const BackgroundBenchmark::Report report = benchmark.report();
  if (!report.failure.empty()) return notices.complain(report.failure);
  notices.say(fmt::format("{}: {}", report.file.string(), report.text()),
              report.failed() > 0 ? Message::Kind::error : Message::Kind::note);
}

void Session::noticeDuel() {
  if (!duel.takeEnd()) return;
  const BackgroundDuel::Report report = duel.report();
  if (!report.failure.empty()) notices.complain(report.failure);
}

void Session::noticeReport() {
  if (!report_page.takeEnd()) return;
  const BackgroundReport::Report report = report_page.report();
  if (!report.failure.empty()) return notices.complain(report.failure);
  if (report.state == TaskState::done) {
    notices.say(fmt::format("report page: {}", fs::absolute(report.page).string()));
  }
}

void Session::chooseScene(const std::string& scene, const std::string& engine) {
  ParameterValues values = parameterValues(*draft);
  draft = makeSimulation(scene, engine);
  // What the user has probably chosen.
  for (const char* shared : {"objects", "frames", "object_type", "seed", "engine"}) {
    const auto value = values.find(shared);
    const ParameterValues there = parameterValues(*draft);
    if (value == values.end() || !there.contains(shared)) continue;
    if (std::string(shared) == "engine" && !engine.empty()) continue;
    setParameters(*draft, {*value});
  }
}

void Session::simulate() { playback.show(simulationFootage()); }

FootageRequest Session::simulationFootage() const {
  const std::string text = formatSceneParameters(*draft);
  return {.open =
              [text, swept = swept_] {
                return std::make_unique<Footage>(parseSceneParameters(text, "scene parameters"),
                                                 swept);
              },
          .source = FootageSource::simulation,
          .title = draft->listing().name,
          .scene_parameters = text};
}

bool Session::draftIsOpen() const {
  return playback.footage() &&
         playback.footage()->scene_parameters == formatSceneParameters(*draft);
}

ParameterValues Session::openParameters() const {
  if (!playback.footage() || playback.footage()->scene_parameters.empty()) return {};
  const auto simulation =
      parseSceneParameters(playback.footage()->scene_parameters, playback.footage()->title);
  ParameterValues values = parameterValues(*simulation);
  values["scene"] = simulation->listing().id;
  return values;
}

void Session::open(const fs::path& path) {
  notices.attempt([&] {
    OpenedSource opened = openSource(path.string(), {.algorithms = lanes.algorithms()});
    if (opened.results) {
      listCases(path, std::move(*opened.results));
    } else {
      openEntry(std::move(opened.entries.at(0)), Opened::at_rest);
    }
    tellOfFile(path);
  });
}

void Session::openCase(const fs::path& file, const std::string& id) {
  notices.attempt([&] {
    OpenedSource opened =
        openSource(file.string(), {.case_id = id, .algorithms = lanes.algorithms()});
    openEntry(std::move(opened.entries.at(0)), Opened::in_motion);
  });
}

void Session::openCase(OpenedResults::Row& row) {
  try {
    openEntry(entryOf(row.result, results->file(), lanes.algorithms()), Opened::in_motion);
    row.obstacle.clear();
  } catch (const InputError& error) {
    row.obstacle = error.what();
    notices.say(row.obstacle, Message::Kind::error);
  }
}

void Session::open(Plan plan) {
  for (const Case& run : plan.cases) lanes.add(run);
  if (auto& unchosen = plan.unchosen_case) {
    listCases(unchosen->file, std::move(unchosen->results));
    tellOfFile(unchosen->file);
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
  enterSource(entry.source, document_is, entry.known ? entry.known->id : "");
  if (entry.cases.empty()) return;
  lanes.clear();
  for (const Case& run : entry.cases) lanes.add(run);
  const std::optional<FrameDifference> difference = entry.knownDifference();
  if (!difference) return;
  playback.seek(difference->frame);
  mismatches.check = mismatches.stop_at_mismatch = true;
  notices.bringUp("Mismatches");
}

void Session::enterSource(Source& source, Opened document_is, const std::string& case_id) {
  const auto show = [&](FootageRequest footage) {
    if (!case_id.empty()) {
      footage.source = FootageSource::results;
      footage.title = case_id;
    }
    playback.show(std::move(footage));
  };
  swept_ = source.reference.reading.contains("swept");
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(source.simulation.get())) {
    const fs::path file = source.simulation->input();
    if (swept_)
      throw InputError("--swept: not of a scene that is edited: bake it, or add --headless");
    document.start(authored->document(), file);
    if (document_is == Opened::in_motion) document.simulate();
  } else if (source.simulation) {
    // A hash that is expected would be known only after the last frame.
    draft = std::move(source.simulation);
    show(simulationFootage());
  } else if (source.imported) {
    show(importFootage(source.reference));
    tellOfFile(source.reference.path);
  } else if (!source.reference.path.empty()) {
    show(recordingFootage(source.reference.path, source.expected_hash));
    tellOfFile(source.reference.path);
  }
}

FootageRequest Session::recordingFootage(const fs::path& path, const std::string& hash) const {
  // A bad one is an error at once, and changes nothing.
  const std::string parameters = parametersOf(*openRecordingFile(path), path);
  const auto open = [path, hash, swept = swept_] {
    std::unique_ptr<Recording> recording = openRecordingFile(path);
    if (!hash.empty()) {
      requireHash(path.string(), swept ? sweptHash(recording->hash()) : recording->hash(), hash);
    }
    return std::make_unique<Footage>(std::move(recording), swept);
  };
  return {.open = open,
          .source = FootageSource::recording,
          .title = path.filename().string(),
          .recording = path,
          .scene_parameters = parameters};
}

FootageRequest Session::importFootage(const RecordingReference& reference) const {
  const auto open = [reference, swept = swept_]() -> std::unique_ptr<Footage> {
    ReadingOptions reading;
    setParameters(reading, reference.reading);
    const auto import = importOf(reference.path);
    if (!import) throw InputError(fmt::format("{}: no longer there", reference.path));
    Source source = importedSource({reference.path}, *import, reading);
    return std::make_unique<Footage>(std::move(source.imported), swept);
  };
  return {.open = open,
          .source = FootageSource::import,
          .title = fs::path(reference.path).filename().string()};
}

void Session::listCases(const fs::path& file, Results listed) {
  results.emplace(file, std::move(listed), lanes.algorithms());
  notices.bringUp("Cases");
}

void Session::play(bool on) {
  if (on && !playback.footage()) {
    notices.say("nothing is open: simulate a scene, or open a file", Message::Kind::warning);
    return;
  }
  if (on && document.atRest()) document.simulate();
  playback.play(on);
}

void Session::saveRecording(const fs::path& path) {
  later([this, path] {
    runs.withFootage([&](Footage* footage) {
      if (footage == nullptr) throw InputError("nothing is open");
      footage->save(path);
    });
    notices.say(fmt::format("recorded: {}", path.string()));
    tellOfFile(path);
  });
}

void Session::exportCase(const Case& run, std::shared_ptr<const Snapshot> snapshot, fs::path file) {
  const SceneInfo scene = playback.scene();
  if (!file.has_extension()) file += recordingExtension(scene);
  later([this, run, snapshot, file, scene] {
    requireExportable(file, snapshot->footage->recording, scene);
    std::unique_ptr<IndexedFrames> source;
    if (snapshot->footage == playback.footage()) {
      runs.withFootage([&](Footage* footage) {
        if (footage != nullptr) source = footage->source(snapshot->frame);
      });
    }
    if (!source) throw InputError("exporting a case: another scene has been opened");
    case_export.start(run, std::move(source), snapshot->difference, file, make_host_);
  });
}

void Session::startDuel(double most_seconds) {
  later([this, most_seconds] {
    std::vector<Case> cases;
    for (const LaneSpec& lane : lanes.specs()) cases.push_back(lane.run);
    std::unique_ptr<IndexedFrames> frames;
    runs.withFootage([&](Footage* footage) {
      if (footage != nullptr) frames = footage->source(footage->known());
    });
    if (!frames) throw InputError("duel: nothing is open");
    duel.start(cases, std::move(frames), most_seconds, make_host_);
  });
}

void Session::showSecond(bool on) {
  second.reset();
  if (!on) return;
  second.emplace();
  const auto other = std::ranges::find_if(
      lanes.list, [this](const LaneEdit& lane) { return lane.number != lanes.shown(); });
  if (other != lanes.list.end()) second->lane = other->number;
  // Without another algorithm's answer it is the same one's, and stays where it is.
  if (other == lanes.list.end() && lanes.shown() == 0) second->frame = playback.frame();
}

void Session::showBeside(const fs::path& recording) {
  notices.attempt([&] {
    FootageRequest footage = recordingFootage(recording, {});
    if (!second) showSecond(true);
    second->footage = std::make_shared<const FootageRequest>(std::move(footage));
    second->frame.reset();
    second->lane = lanes.shown();
  });
}

void Session::openExport() {
  const CaseExport::Report report = case_export.report();
  notices.attempt([&] {
    swept_ = false;
    playback.show(recordingFootage(report.file, {}));
    lanes.clear();
    lanes.add(report.run);
    playback.seek(static_cast<std::int64_t>(report.frames));
    tellOfFile(report.file);
  });
}

}  // namespace broadmark
