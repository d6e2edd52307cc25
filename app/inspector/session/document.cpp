#include "inspector/session/document.h"

#include <fmt/format.h>

#include <utility>

#include "broadmark/files.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/transformation.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// A source of a single frame: the scene's bodies at their initial poses.
FrameProviderOpener staticSource(const scenes::AuthoredScene& scene) {
  const SceneInfo info{.name = scene.name,
                       .object_type = scenes::objectTypeName(scene),
                       .objects = static_cast<std::uint32_t>(scene.bodies.size()),
                       .frames = 0,
                       .world = scene.world,
                       .filter = scenes::collisionFilterOf(scene)};
  const auto boxes = std::make_shared<const std::vector<Aabb>>(boxesOf(scene));
  return [info, boxes](const SimulationHost&, const CancelQuery&) {
    return std::make_unique<FrameProvider>(info, *boxes);
  };
}

}  // namespace

std::unique_ptr<Simulation> Document::simulation() const {
  return scenes::makeAuthoredSimulation(editor.scene(), path_);
}

void Document::load(scenes::AuthoredScene scene, fs::path path, bool unsaved) {
  editor = scenes::SceneEditor(std::move(scene));
  path_ = std::move(path);
  unsaved_ = unsaved;
  ++loads_;
  scene_ = 0;
  show();
  notices_.raisePanel("Author");
}

void Document::loadCurrentFrame() {
  if (playback_.source() && !atRest()) readCurrentFrame();
}

void Document::changeInFrame(const scenes::Transformation& change, bool plays) {
  readCurrentFrame();
  pending_frame_->change = change;
  pending_frame_->plays = plays;
}

void Document::readCurrentFrame() {
  // Reopen the source and simulate up to the frame, which provides all properties of the bodies.
  PendingFrame pending{.previous = playback_.source(),
                       .frame = playback_.frame(),
                       .shown = {},
                       .scene = std::make_shared<scenes::AuthoredScene>()};
  playback_.show({.open =
                      [previous = pending.previous, frame = pending.frame, scene = pending.scene](
                          const SimulationHost& host, const CancelQuery& cancelled) {
                        const std::unique_ptr<FrameProvider> provider =
                            previous->open(host, cancelled);
                        while (provider->lastAvailable() < frame) provider->simulateNext();
                        *scene = provider->authoredScene(frame);
                        return staticSource(*scene)(host, cancelled);
                      },
                  .origin = FrameOrigin::authored,
                  .title = fmt::format("frame {} of {}", pending.frame, pending.previous->title)});
  pending.shown = playback_.source();
  pending_frame_ = std::move(pending);
}

void Document::advance(const RunProgress& progress) {
  if (!pending_frame_ || pending_frame_->shown != progress.source) return;
  const PendingFrame pending = *std::exchange(pending_frame_, {});
  if (!progress.failure.empty()) {
    playback_.restore(pending.previous, pending.frame);
  } else if (pending.change) {
    playFrom(pending);
  } else {
    load(std::move(*pending.scene), {}, true);
  }
}

void Document::playFrom(const PendingFrame& frame) {
  std::vector<scenes::AuthoredBody>& bodies = frame.scene->bodies;
  if (bodies.size() != editor.scene().bodies.size()) {
    notices_.reportError("bodies have come or gone: use From this frame, and drag there");
    playback_.restore(frame.previous, frame.frame);
    return;
  }
  edit([&](scenes::SceneEditor& edited) {
    const scenes::BodyIds selected = edited.selection();
    for (const std::uint32_t id : selected) {
      scenes::AuthoredBody& body = bodies[id];
      const Pose moved = transformedPose(body, *frame.change);
      body.shape = transformedShape(body, *frame.change);
      body.pose = moved;
    }
    edited.selectAll();
    std::size_t next = 0;
    edited.change(fmt::format("drag in frame {} of", frame.frame),
                  [&](scenes::AuthoredBody& body) { body = bodies[next++]; });
    edited.select(selected);
  });
  simulate();
  if (frame.plays) playback_.play(true);
}

void Document::edit(const std::function<void(scenes::SceneEditor&)>& change) {
  const std::uint64_t before = editor.revision();
  notices_.catchErrors([&] { change(editor); });
  if (editor.revision() != before || !shown()) show();
}

void Document::add(const std::function<scenes::Stroke()>& paint_stroke) {
  std::optional<std::size_t> added;
  std::size_t left_out = 0;
  edit([&](scenes::SceneEditor& edited) {
    scenes::Stroke stroke = paint_stroke();
    left_out = stroke.left_out;
    const std::size_t count = stroke.bodies.size();
    edited.add(std::move(stroke.bodies));
    added = count;
  });
  if (added && left_out == 0) {
    notices_.setStatus(fmt::format("{} added", counted(*added, "body", "bodies")));
  } else if (added) {
    notices_.setStatus(fmt::format("no room for {}", counted(left_out, "body", "bodies")),
                       Severity::warning);
  }
}

void Document::showFrames(FrameProviderOpener open, bool simulated) {
  // A different world resets the camera.
  const Aabb& world = editor.scene().world;
  if (scene_ == 0 || world != world_) scene_ = ++last_scene_;
  world_ = world;
  playback_.pause();
  playback_.show({.open = std::move(open),
                  .origin = FrameOrigin::authored,
                  .title = title() + (simulated ? ", simulated" : ", at its start"),
                  .scene = scene_});
  source_ = playback_.source();
  simulated_ = simulated;
}

void Document::show() { showFrames(staticSource(editor.scene()), false); }

void Document::simulate() {
  const auto scene = std::make_shared<const scenes::AuthoredScene>(editor.scene());
  showFrames(
      [scene, path = path()](const SimulationHost& host, const CancelQuery& cancelled) {
        return std::make_unique<FrameProvider>(
            host(scenes::makeAuthoredSimulation(*scene, path), cancelled));
      },
      true);
}

bool Document::save(fs::path path) {
  if (!path.has_extension()) path += ".json";
  return notices_.catchErrors([&] {
    writeTextFile(path, scenes::formatAuthoredScene(editor.scene()));
    editor.markSaved();
    path_ = path;
    unsaved_ = false;
    notices_.setStatus(fmt::format("saved: {}", path.string()));
    notices_.on_file_used(path);
  });
}

void Document::bake(fs::path path) {
  if (!path.has_extension()) path += recordingExtension(simulation()->scene());
  notices_.catchErrors(
      [&] { startBake(jobs_.get<BackgroundBake>(), simulation(), std::move(path), jobs_.host); });
}

void Document::closeThen(std::function<void()> then) {
  if (isModified()) {
    pending_close = std::move(then);
  } else {
    then();
  }
}

}  // namespace broadmark
