#include "inspector/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "case_reference.h"
#include "cases.h"
#include "inspector/mismatch.h"
#include "broadmark/files.h"
#include "broadmark/error.h"
#include "broadmark/names.h"
#include "original/settings.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

bool sameWish(const Wish& a, const Wish& b) {
  return a.footage == b.footage && a.frame == b.frame && a.check == b.check &&
         a.stop_at_mismatch == b.stop_at_mismatch && a.known_mismatch == b.known_mismatch &&
         a.shown_lane == b.shown_lane && a.structure == b.structure && a.tracked == b.tracked &&
         std::ranges::equal(a.lanes, b.lanes,
                            [](const LaneSpec& x, const LaneSpec& y) { return x.same(y); });
}

/// At most so many bodies are followed through the last frames.
constexpr std::size_t kMostTracked = 2;

}  // namespace

LaneSpec LaneEdit::spec() const {
  const std::unique_ptr<BroadPhase> fresh = algorithm.create();
  ParameterValues changed = parameterValues(*parameters);
  const ParameterValues defaults = parameterValues(*fresh);
  std::erase_if(changed, [&](const auto& value) {
    return defaults.contains(value.first) && defaults.at(value.first) == value.second;
  });
  return {.number = number,
          .run = {.algorithm = algorithm,
                  .isa = algorithm.vectorised ? isa : Isa::scalar,
                  .threads = algorithm.parallel ? threads : 1,
                  .device = device,
                  .parameters = std::move(changed)}};
}

Session::Session(std::vector<Algorithm> available)
    : algorithms(std::move(available)), draft(makeSimulation("freefall")) {}

void Session::advance(const RunProgress& progress, double seconds) {
  noticeBake();
  noticeExport();
  if (progress.footage != wish.footage || !progress.footage) return;
  scene_ = progress.scene;
  scene_known_ = true;
  if (progress.failure != noticed_failure_) {
    noticed_failure_ = progress.failure;
    if (!progress.failure.empty()) {
      playback.playing = false;
      complain(progress.failure);
    }
  }
  wish.frame = std::min(wish.frame, scene_.frames);
  noticeAuthored(progress);
  noticeStop(progress);
  const bool there = progress.doing.empty() && progress.snapshot &&
                     progress.snapshot->footage == wish.footage &&
                     progress.snapshot->frame == wish.frame;
  if (there) visitStop(progress);
  if (there && std::exchange(searching_, false)) {
    say(fmt::format("no further mismatch up to frame {}", wish.frame));
  }
  if (!playback.playing || !there) return;
  playback.due += seconds * playback.frames_per_second;
  if (playback.due < 1) return;
  const double frames = std::floor(playback.due);
  playback.due = std::min(playback.due - frames, 1.0);
  if (wish.frame == scene_.frames) {
    if (playback.loop) {
      wish.frame = 0;
    } else {
      playback.playing = false;
    }
    return;
  }
  // What cannot keep pace is shown frame by frame.
  seek(wish.frame + static_cast<std::int64_t>(std::min(frames, 4.0)));
}

void Session::noticeStop(const RunProgress& progress) {
  if (!progress.stop) {
    noticed_stop_.reset();
    return;
  }
  const bool known = wish.known_mismatch && *wish.known_mismatch >= progress.stop->frame;
  if (known || (noticed_stop_ && noticed_stop_->frame == progress.stop->frame)) return;
  noticed_stop_ = to_visit_ = progress.stop;
  playback.playing = false;
  searching_ = false;
  wish.frame = progress.stop->frame;
  wish.shown_lane = progress.stop->lane;
  wanted_panels.emplace_back("Mismatches");
  const LaneEdit* wrong = lane(progress.stop->lane);
  say(fmt::format("{} is wrong in frame {}", wrong ? wrong->algorithm.id : "an algorithm",
                  progress.stop->frame),
      Message::Kind::error);
}

void Session::visitStop(const RunProgress& progress) {
  const Snapshot& seen = *progress.snapshot;
  if (!to_visit_ || !seen.checked || seen.frame != to_visit_->frame || seen.lane != to_visit_->lane)
    return;
  to_visit_.reset();
  const auto report =
      std::ranges::find(progress.lanes, seen.lane, [](const auto& l) { return l.spec.number; });
  const float margin = report == progress.lanes.end() ? 0 : report->margin;
  const std::vector<WrongPair> wrong = wrongPairs(seen.difference, *seen.boxes, margin);
  if (!wrong.empty()) visit(wrong.front().pair);
}

void Session::noticeExport() {
  if (!case_export.takeEnd()) return;
  const CaseExport::Report report = case_export.report();
  if (report.state == CaseExport::State::failed) complain(report.failure);
  if (report.state == CaseExport::State::done) {
    say(fmt::format("exported: {}", report.file.string()));
  }
}

void Session::commit() {
  wish.structure = view.structure;
  wish.tracked = selection;
  if (wish.tracked.size() > kMostTracked) wish.tracked.clear();
  if (!sameWish(wish, committed_)) {
    committed_ = wish;
    runs.wish(wish);
  }
  for (const auto& act : std::exchange(put_off_, {})) attempt(act);
}

void Session::chooseScene(const std::string& scene, const std::string& engine) {
  ParameterValues values = parameterValues(*draft);
  draft = makeSimulation(scene, engine);
  // What both scenes have in common and the user has probably chosen.
  for (const char* shared : {"objects", "frames", "object_type", "seed", "engine"}) {
    const auto value = values.find(shared);
    const ParameterValues there = parameterValues(*draft);
    if (value == values.end() || !there.contains(shared)) continue;
    if (std::string(shared) == "engine" && !engine.empty()) continue;
    setParameters(*draft, {*value});
  }
}

void Session::simulate() {
  const std::string text = formatSceneParameters(*draft);
  source_path.clear();
  show(fmt::format("{} (live)", draft->listing().name), [text] {
    return std::make_unique<Footage>(parseSceneParameters(text, "scene parameters"));
  });
}

void Session::show(std::string title, std::function<std::unique_ptr<Footage>()> open,
                   std::uint64_t scene) {
  wish.footage = std::make_shared<const FootageRequest>(
      FootageRequest{.open = std::move(open), .title = std::move(title), .scene = scene});
  wish.frame = 0;
  wish.known_mismatch.reset();
  noticed_stop_.reset();
  noticed_failure_.clear();
  playback.due = 0;
  selection.clear();
  scene_ = {};
  scene_known_ = false;
}

void Session::open(const fs::path& path) {
  attempt([&] {
    if (path.extension() == ".json") {
      openJson(path);
    } else {
      openRecording(path, {});
    }
    if (on_file) on_file(path);
  });
}

void Session::openRecording(const fs::path& path, const std::string& hash) {
  openRecordingFile(path);  // a bad one is told at once, and what is looked at stays
  show(path.filename().string(), [path, hash] {
    std::unique_ptr<Recording> recording = openRecordingFile(path);
    if (!hash.empty()) requireHash(path.string(), recording->hash(), hash);
    return std::make_unique<Footage>(std::move(recording));
  });
  source_path = path;
}

void Session::openJson(const fs::path& path) {
  const std::string text = readTextFile(path);
  const std::string kind = jsonKind(text, path.string());
  if (kind == scenes::kAuthoredSceneSchema) {
    const auto scene =
        std::make_shared<scenes::AuthoredScene>(scenes::parseAuthoredScene(text, path.string()));
    leaveDocument([this, scene, path] { author(std::move(*scene), path); });
    return;
  }
  if (kind == kResultsSchema) {
    CaseChoice choice{.file = path};
    for (const CaseResult& result : parseResults(text, path.string()).cases) {
      choice.cases.push_back({.id = result.id,
                              .status = result.status,
                              .reason = result.reason,
                              .wrong = !result.differences.empty()});
    }
    choice.all = std::ranges::none_of(choice.cases, &CaseChoice::Item::wrong);
    case_choice = std::move(choice);
    return;
  }
  draft = parseSceneParameters(text, path.string());
  simulate();
}

void Session::author(scenes::AuthoredScene scene, fs::path path, bool unsaved) {
  desk.start(std::move(scene), std::move(path), unsaved);
  author_scene_ = 0;
  showAuthored();
  wanted_panels.emplace_back("Author");
}

void Session::authorFrame() {
  if (!wish.footage || authoringAtRest()) return;
  // What is looked at is opened anew and goes on to that frame: then its bodies are known wholly.
  FrameToAuthor wanted{.former = wish.footage,
                       .frame = wish.frame,
                       .shown = {},
                       .scene = std::make_shared<scenes::AuthoredScene>()};
  show(fmt::format("frame {} of {}", wish.frame, wish.footage->title),
       [former = wish.footage, frame = wish.frame, scene = wanted.scene] {
         *scene = sceneFromFootage(*former, frame);
         return stillOf(*scene);
       });
  wanted.shown = wish.footage;
  frame_to_author_ = std::move(wanted);
}

void Session::noticeAuthored(const RunProgress& progress) {
  if (!frame_to_author_ || frame_to_author_->shown != progress.footage) return;
  const FrameToAuthor wanted = *std::exchange(frame_to_author_, {});
  if (progress.failure.empty()) {
    author(std::move(*wanted.scene), {}, true);
  } else {
    wish.footage = wanted.former;
    wish.frame = wanted.frame;
    scene_known_ = false;
  }
}

void Session::edit(const std::function<void(scenes::SceneEditor&)>& change) {
  const std::uint64_t before = desk.editor.revision();
  attempt([&] { change(desk.editor); });
  if (desk.editor.revision() != before || !authoring()) {
    showAuthored();
  } else {
    selection = desk.editor.selection();
  }
}

void Session::showDocument(std::function<std::unique_ptr<Footage>()> open, bool moves) {
  // Another world is looked at from anew.
  const Aabb& world = desk.editor.scene().world;
  if (author_scene_ == 0 || world != author_world_) author_scene_ = ++last_author_scene_;
  author_world_ = world;
  playback.playing = false;
  source_path.clear();
  show(desk.title() + (moves ? " (live)" : ""), std::move(open), author_scene_);
  author_footage_ = wish.footage;
  author_moves_ = moves;
  selection = desk.editor.selection();
}

void Session::showAuthored() { showDocument(desk.still(), false); }

void Session::simulateAuthored() { showDocument(desk.live(), true); }

bool Session::saveAuthored(const fs::path& path) {
  return attempt([&] {
    desk.save(path);
    say(fmt::format("saved: {}", desk.path().string()));
    if (on_file) on_file(desk.path());
  });
}

void Session::bakeAuthored(fs::path path) {
  if (!path.has_extension()) path += kAabbsExtension;
  attempt([&] { bake.start(desk.simulation(), std::move(path)); });
}

void Session::noticeBake() {
  if (!bake.takeEnd()) return;
  const BackgroundBake::Report report = bake.report();
  if (!report.failure.empty()) complain(report.failure);
  say(report.text(), report.failed() > 0 ? Message::Kind::error : Message::Kind::note);
}

void Session::leaveDocument(std::function<void()> then) {
  if (desk.isModified()) {
    leaving = std::move(then);
  } else {
    then();
  }
}

std::size_t Session::bodyCount() const {
  return authoring() ? desk.editor.scene().bodies.size() : scene_.objects;
}

void Session::open(Source source) {
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(source.simulation.get())) {
    author(authored->document(), source.simulation->input());
    simulateAuthored();
  } else if (source.simulation) {
    // Its hash would be known only after the last frame.
    draft = std::move(source.simulation);
    simulate();
  } else {
    openRecording(source.reference.path, source.expected_hash);
    if (on_file) on_file(source.reference.path);
  }
}

void Session::openCase(const fs::path& results, const std::string& id) {
  attempt([&] { open(broadmark::openCase(results, id, algorithms)); });
}

void Session::open(CaseReference reference) {
  open(std::move(reference.source));
  lanes.clear();
  addLane(reference.run);
  if (!reference.difference) return;
  wish.frame = reference.difference->frame;
  wish.check = wish.stop_at_mismatch = true;
  wanted_panels.emplace_back("Mismatches");
}

void Session::saveRecording(const fs::path& path) {
  later([this, path] {
    runs.withFootage([&](Footage* footage) {
      if (footage == nullptr) throw InputError("nothing is open that could be recorded");
      footage->save(path);
    });
    say(fmt::format("recorded: {}", path.string()));
    if (on_file) on_file(path);
  });
}

void Session::play(bool on) {
  if (on && authoringAtRest()) simulateAuthored();
  if (on && wish.frame == scene_.frames && scene_.frames > 0) wish.frame = 0;
  if (on) acknowledgeStop();
  playback.playing = on;
  playback.due = 0;
}

void Session::acknowledgeStop() {
  if (noticed_stop_) wish.known_mismatch = noticed_stop_->frame;
}

void Session::seek(std::int64_t frame) {
  // What is only being opened may have any number of frames; it is set right then.
  const std::int64_t last = scene_known_ ? scene_.frames : std::numeric_limits<std::int32_t>::max();
  const auto wanted = static_cast<std::uint32_t>(std::clamp<std::int64_t>(frame, 0, last));
  if (wanted > wish.frame) acknowledgeStop();
  wish.frame = wanted;
  searching_ = false;
}

void Session::step(int frames) {
  playback.playing = false;
  seek(static_cast<std::int64_t>(wish.frame) + frames);
}

LaneEdit& Session::addLane(const std::string& algorithm_id) {
  const auto found = std::ranges::find(algorithms, algorithm_id, &Algorithm::id);
  if (found == algorithms.end()) {
    std::vector<std::string> ids;
    for (const Algorithm& algorithm : algorithms) ids.push_back(algorithm.id);
    throw InputError(unknownName("algorithm", algorithm_id, ids));
  }
  LaneEdit& added = lanes.emplace_back();
  added.number = ++last_lane_number_;
  added.algorithm = *found;
  added.parameters = found->create();
  added.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (lanes.size() == 1) wish.shown_lane = added.number;
  lanesChanged();
  return added;
}

LaneEdit& Session::addLane(const Case& run) {
  LaneEdit& added = addLane(run.algorithm.id);
  if (run.algorithm.vectorised) added.isa = run.isa;
  if (run.algorithm.parallel) added.threads = run.threads;
  added.device = run.device;
  setParameters(*added.parameters, run.parameters);
  lanesChanged();
  return added;
}

void Session::removeLane(int number) {
  std::erase_if(lanes, [&](const LaneEdit& edit) { return edit.number == number; });
  if (wish.shown_lane == number) wish.shown_lane = lanes.empty() ? 0 : lanes.front().number;
  lanesChanged();
}

void Session::showLane(int number) { wish.shown_lane = number; }

void Session::lanesChanged() {
  wish.lanes.clear();
  for (const LaneEdit& edit : lanes) wish.lanes.push_back(edit.spec());
  wish.known_mismatch.reset();
  noticed_stop_.reset();
}

LaneEdit* Session::lane(int number) {
  const auto found = std::ranges::find(lanes, number, &LaneEdit::number);
  return found == lanes.end() ? nullptr : &*found;
}

void Session::nextMismatch(const RunProgress& progress) {
  playback.playing = false;
  wish.check = wish.stop_at_mismatch = true;
  if (const auto known = nextKnownMismatch(progress.lanes, wish.frame)) {
    seek(known->frame);
    showLane(known->lane);
    return;
  }
  seek(scene_.frames);
  searching_ = true;
}

void Session::endSearch(const RunProgress& progress) {
  searching_ = false;
  std::uint32_t reached = progress.snapshot ? progress.snapshot->frame : 0;
  for (const LaneReport& lane : progress.lanes) reached = std::max(reached, lane.frame);
  wish.frame = std::min(reached, wish.frame);
}

void Session::exportCase(const Case& run, std::shared_ptr<const Snapshot> snapshot, fs::path file) {
  if (!file.has_extension()) file += kAabbsExtension;
  later([this, run, snapshot, file] {
    requireExportable(file, source_path);
    std::unique_ptr<FrameSource> source;
    if (snapshot->footage == wish.footage) {
      runs.withFootage([&](Footage* footage) {
        if (footage != nullptr) source = footage->source(snapshot->frame);
      });
    }
    if (!source) throw InputError("exporting a case: another scene has been opened meanwhile");
    case_export.start(run, std::move(source), snapshot->difference, file);
  });
}

void Session::openExport() {
  const CaseExport::Report report = case_export.report();
  attempt([&] {
    openRecording(report.file, {});
    lanes.clear();
    addLane(report.run);
    wish.frame = static_cast<std::uint32_t>(report.frames);
    if (on_file) on_file(report.file);
  });
}

void Session::select(std::vector<std::uint32_t> bodies) {
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  const std::size_t count = bodyCount();
  std::erase_if(bodies, [&](std::uint32_t body) { return body >= count; });
  selection = std::move(bodies);
  if (authoring()) desk.editor.select(selection);
}

void Session::toggleSelected(std::uint32_t body) {
  const auto place = std::ranges::lower_bound(selection, body);
  if (place != selection.end() && *place == body) {
    selection.erase(place);
  } else {
    selection.insert(place, body);
  }
  select(std::move(selection));
}

bool Session::isSelected(std::uint32_t body) const {
  return std::ranges::binary_search(selection, body);
}

void Session::visit(Pair pair) {
  select({pair.a, pair.b});
  fly_to = selection;
}

void Session::say(std::string text, Message::Kind kind) { status = {kind, std::move(text)}; }

void Session::complain(std::string text) {
  say(text, Message::Kind::error);
  errors.push_back(std::move(text));
}

bool Session::attempt(const std::function<void()>& act) {
  try {
    act();
    return true;
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return false;
}

std::string formatFrameTable(const RunProgress& progress) {
  std::string table = "algorithm,isa,threads,frame";
  for (const Phase phase : kAllPhases) table += fmt::format(",{}_ns", phaseName(phase));
  table += ",pairs,missed,extra,checked,disturbed\n";
  for (const LaneReport& lane : progress.lanes) {
    const Case& run = lane.spec.run;
    for (std::uint32_t frame = 1; frame <= lane.frames.size(); ++frame) {
      const FrameRecord* record = lane.record(frame);
      if (record == nullptr) continue;
      table += fmt::format("{},{},{},{}", run.algorithm.id, isaName(run.isa), run.threads, frame);
      for (const Phase phase : kAllPhases) table += fmt::format(",{}", record->times[phase]);
      table += fmt::format(",{},{},{},{:d},{:d}\n", record->pairs, record->missed, record->extra,
                           record->checked, record->disturbed);
    }
  }
  return table;
}

}  // namespace broadmark
