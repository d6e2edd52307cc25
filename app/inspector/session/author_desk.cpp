#include "inspector/session/author_desk.h"

#include <utility>

#include "broadmark/files.h"
#include "broadmark/scenes/authored_simulation.h"
#include "inspector/run/run_thread.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

SceneInfo infoOf(const scenes::AuthoredScene& scene) {
  return {.name = scene.name,
          .object_type = scenes::objectTypeName(scene),
          .objects = static_cast<std::uint32_t>(scene.bodies.size()),
          .frames = 0,
          .world = scene.world,
          .filter = scenes::collisionFilterOf(scene)};
}

}  // namespace

AuthorDesk::AuthorDesk() { chooseBrush(0); }

void AuthorDesk::start(scenes::AuthoredScene scene, fs::path path, bool unsaved) {
  editor = scenes::SceneEditor(std::move(scene));
  path_ = std::move(path);
  unsaved_ = unsaved;
}

void AuthorDesk::save(fs::path path) {
  if (!path.has_extension()) path += ".json";
  writeTextFile(path, scenes::formatAuthoredScene(editor.scene()));
  editor.markSaved();
  path_ = std::move(path);
  unsaved_ = false;
}

std::string AuthorDesk::title() const {
  return path_.empty() ? editor.scene().name : path_.filename().string();
}

FootageOpener AuthorDesk::still() const {
  auto boxes = std::make_shared<const std::vector<Aabb>>(boxesOf(editor.scene()));
  return [info = infoOf(editor.scene()), boxes] { return std::make_unique<Footage>(info, *boxes); };
}

FootageOpener AuthorDesk::live() const {
  return [scene = std::make_shared<const scenes::AuthoredScene>(editor.scene()), path = path_] {
    return std::make_unique<Footage>(scenes::makeAuthoredSimulation(*scene, path));
  };
}

std::unique_ptr<Simulation> AuthorDesk::simulation() const {
  return scenes::makeAuthoredSimulation(editor.scene(), path_);
}

void AuthorDesk::chooseBrush(std::size_t which) {
  brush_ = brushes.at(which).create();
  chosen_brush_ = which;
}

scenes::Stroke AuthorDesk::stroke() const {
  return scenes::paint(*brush_, paint, paint_at, editor.scene().bodies);
}

scenes::AuthoredScene sceneFromFootage(const FootageRequest& request, std::uint32_t frame) {
  const std::unique_ptr<Footage> footage = request.open();
  while (footage->known() < frame) footage->extend();
  return footage->authoredScene(frame);
}

std::unique_ptr<Footage> stillOf(const scenes::AuthoredScene& scene) {
  return std::make_unique<Footage>(infoOf(scene), boxesOf(scene));
}

}  // namespace broadmark
