#include "inspector/session/document.h"

#include <fmt/format.h>

#include <utility>

#include "broadmark/files.h"
#include "broadmark/scenes/authored_simulation.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// The scene where its bodies start, as source of a single frame.
FrameProviderOpener stillOf(const scenes::AuthoredScene& scene) {
  const SceneInfo info{.name = scene.name,
                       .object_type = scenes::objectTypeName(scene),
                       .objects = static_cast<std::uint32_t>(scene.bodies.size()),
                       .frames = 0,
                       .world = scene.world,
                       .filter = scenes::collisionFilterOf(scene)};
  const auto boxes = std::make_shared<const std::vector<Aabb>>(boxesOf(scene));
  return [info, boxes] { return std::make_unique<FrameProvider>(info, *boxes); };
}

}  // namespace

std::unique_ptr<Simulation> Document::simulation() const {
  return scenes::makeAuthoredSimulation(editor.scene(), path_);
}

void Document::start(scenes::AuthoredScene scene, fs::path path, bool unsaved) {
  editor = scenes::SceneEditor(std::move(scene));
  path_ = std::move(path);
  unsaved_ = unsaved;
  scene_ = 0;
  show();
  notices_.bringUp("Author");
}

void Document::startFromFrame() {
  if (!playback_.source() || atRest()) return;
  // The shown source is reopened and advanced to that frame, where all of its bodies are known.
  FrameToTake wanted{.former = playback_.source(),
                     .frame = playback_.frame(),
                     .shown = {},
                     .scene = std::make_shared<scenes::AuthoredScene>()};
  playback_.show({.open =
                      [former = wanted.former, frame = wanted.frame, scene = wanted.scene] {
                        const std::unique_ptr<FrameProvider> provider = former->open();
                        while (provider->known() < frame) provider->extend();
                        *scene = provider->authoredScene(frame);
                        return stillOf(*scene)();
                      },
                  .origin = FrameOrigin::authored,
                  .title = fmt::format("frame {} of {}", wanted.frame, wanted.former->title)});
  wanted.shown = playback_.source();
  to_take_ = std::move(wanted);
}

void Document::advance(const RunProgress& progress) {
  if (!to_take_ || to_take_->shown != progress.source) return;
  const FrameToTake wanted = *std::exchange(to_take_, {});
  if (progress.failure.empty()) {
    start(std::move(*wanted.scene), {}, true);
  } else {
    playback_.showAgain(wanted.former, wanted.frame);
  }
}

void Document::edit(const std::function<void(scenes::SceneEditor&)>& change) {
  const std::uint64_t before = editor.revision();
  notices_.attempt([&] { change(editor); });
  if (editor.revision() != before || !shown()) show();
}

void Document::add(const std::function<scenes::Stroke()>& painted) {
  std::optional<std::size_t> added;
  std::size_t left_out = 0;
  edit([&](scenes::SceneEditor& edited) {
    scenes::Stroke stroke = painted();
    left_out = stroke.left_out;
    const std::size_t count = stroke.bodies.size();
    edited.add(std::move(stroke.bodies));
    added = count;
  });
  if (added && left_out == 0) {
    notices_.say(fmt::format("{} added", counted(*added, "body", "bodies")));
  } else if (added) {
    notices_.say(fmt::format("no room for {}", counted(left_out, "body", "bodies")),
                 Severity::warning);
  }
}

void Document::showAs(FrameProviderOpener open, bool moves) {
  // A different world gets a new camera.
  const Aabb& world = editor.scene().world;
  if (scene_ == 0 || world != world_) scene_ = ++last_scene_;
  world_ = world;
  playback_.pause();
  playback_.show({.open = std::move(open),
                  .origin = FrameOrigin::authored,
                  .title = title() + (moves ? ", simulated" : ", at its start"),
                  .scene = scene_});
  source_ = playback_.source();
  moves_ = moves;
}

void Document::show() { showAs(stillOf(editor.scene()), false); }

void Document::simulate() {
  const auto scene = std::make_shared<const scenes::AuthoredScene>(editor.scene());
  showAs(
      [scene, path = path()] {
        return std::make_unique<FrameProvider>(scenes::makeAuthoredSimulation(*scene, path));
      },
      true);
}

bool Document::save(fs::path path) {
  if (!path.has_extension()) path += ".json";
  return notices_.attempt([&] {
    writeTextFile(path, scenes::formatAuthoredScene(editor.scene()));
    editor.markSaved();
    path_ = path;
    unsaved_ = false;
    notices_.say(fmt::format("saved: {}", path.string()));
    notices_.on_file(path);
  });
}

void Document::bake(fs::path path) {
  if (!path.has_extension()) path += recordingExtension(simulation()->scene());
  notices_.attempt([&] { startBake(bake_, simulation(), std::move(path)); });
}

void Document::leave(std::function<void()> then) {
  if (isModified()) {
    leaving = std::move(then);
  } else {
    then();
  }
}

}  // namespace broadmark
