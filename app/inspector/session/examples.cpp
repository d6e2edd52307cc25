#include "inspector/session/examples.h"

#include <string>
#include <utility>

#include "broadmark/scenes/authored_simulation.h"
#include "request/plugins.h"

namespace broadmark {
namespace {

constexpr const char* kPreviewFrames = "240";

/// Boxes that move by a quarter of their edge in each frame, past others at rest. All coordinates
/// are multiples of 1/16: boxes touch in exactly one number before they overlap.
scenes::AuthoredScene touchingBoxes() {
  constexpr int kRows = 4;
  constexpr int kColumns = 6;
  scenes::AuthoredScene scene{.name = "Find the bug",
                              .world = {{-16, -8, -16, 0}, {16, 8, 16, 0}},
                              .parameters = {{"engine", "kinematic"},
                                             {"frames", "240"},
                                             {"gravity_y", "0"},
                                             {"restitution", "1"},
                                             {"friction", "0"},
                                             {"linear_damping", "0"},
                                             {"time_step", "0.03125"}},
                              .bodies = {}};
  for (int layer = 0; layer < 3; ++layer) {
    for (int row = 0; row < kRows; ++row) {
      const auto y = static_cast<float>(4 * layer - 4);
      const auto z = static_cast<float>(8 * row - 12);
      for (int column = 0; column < kColumns; ++column) {
        const auto x = static_cast<float>(5 * column - 12);
        scene.bodies.push_back({.frozen = true, .pose = {.position = {x, y, z}}});
      }
      // Crosses the row above the boxes at rest; only the one in the middle is low enough.
      const float height = layer == 1 && row == 2 ? 0.5F : 1.5F;
      const float side = row % 2 == 0 ? -14.5F : 14.5F;
      scene.bodies.push_back({.pose = {.position = {side, y + height, z + 0.25F}},
                              .linear_velocity = {side < 0 ? 8.0F : -8.0F, 0, 0}});
    }
  }
  return scene;
}

std::unique_ptr<Simulation> simulationOf(const Example& example, std::uint32_t objects) {
  auto simulation = makeSimulation(example.scene, example.engine);
  setParameters(*simulation, {{"objects", std::to_string(objects)}});
  return simulation;
}

/// Shows the authored scene of an example, simulated.
void openTouchingBoxes(Session& session) {
  session.document.load(touchingBoxes());
  session.document.simulate();
}

}  // namespace

std::span<const Example> examples() {
  static const std::vector<Example> all = {
      {"A pile", "2,000 bodies come to rest", "freefall", 2000, 250, {"kd"}, "Timeline"},
      {.name = "A million bodies",
       .doc = "in motion, unchecked",
       .scene = "brownian",
       .objects = 1'000'000,
       .preview_objects = 4000,
       .algorithms = {"tide"},
       .panel = "Timeline",
       .engine = "kinematic",
       .check = false},
      {"Shooter", "characters and projectiles", "shooter", 4000, 1000, {"tide"}, "Phases"},
      {"City", "buildings and traffic", "city", 8000, 800, {"columns"}, "Results"},
      {.name = "Find the bug",
       .doc = "stops at a missed pair",
       .scene = nullptr,
       .objects = 0,
       .preview_objects = 0,
       .algorithms = {},
       .panel = "Mismatches",
       .plugin = "find-the-bug"},
      {.name = "Compare two",
       .doc = "sap beside columns",
       .scene = "explosion",
       .objects = 4000,
       .preview_objects = 300,
       .algorithms = {"sap", "columns"},
       .panel = "Compare",
       .beside = true},
  };
  return all;
}

std::unique_ptr<Simulation> previewOf(const Example& example) {
  if (example.scene == nullptr) return scenes::makeAuthoredSimulation(touchingBoxes(), {});
  auto simulation = simulationOf(example, example.preview_objects);
  setParameters(*simulation, {{"frames", kPreviewFrames}});
  return simulation;
}

void openExample(Session& session, const Example& example) {
  const auto open = [&session, &example] {
    session.notices.catchErrors([&] {
      session.showSecond(false);
      session.tracks.clear();
      session.playback.reading.clear();
      if (example.plugin != nullptr) session.plugins.loadShipped(example.plugin);
      for (const char* algorithm : example.algorithms) session.tracks.add(algorithm);
      session.mismatches.check = session.mismatches.stop_at_mismatch = true;
      if (example.scene == nullptr) {
        openTouchingBoxes(session);
      } else {
        session.draft.adopt(simulationOf(example, example.objects));
        session.draft.simulate();
      }
      if (!example.check) session.mismatches.uncheckSource();
      session.showSecond(example.beside);
      session.notices.raisePanel("Algorithms");
      session.notices.raisePanel(example.panel);
      session.play(true);
    });
  };
  if (example.scene == nullptr) {
    session.document.closeThen(open);  // it replaces the authored scene
  } else {
    open();
  }
}

}  // namespace broadmark
