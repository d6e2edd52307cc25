// The window's contents, drawn off-screen, with events from the real input queue.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/render/colouring.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/offscreen_context.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/inspector.h"

namespace broadmark::tests {

class InspectorTest : public testing::Test {
 protected:
  explicit InspectorTest(Preferences preferences = {}, const std::filesystem::path& autosaves = {},
                         ExecutorFactory make_executor = makeInProcessExecutor)
      : context(makeOffscreenContext(GlSource::automatic)),
        gl(*context),
        inspector(gl, algorithmsAndFaultyOnes(), std::move(preferences), 1,
                  std::move(make_executor), simulateInProcess, autosaves),
        former_directory(std::filesystem::current_path()) {
    std::filesystem::current_path(directory / "");  // the folder of screenshots
    setParameters(inspector.session().draft.scene(), {{"objects", "40"}, {"frames", "20"}});
  }
  ~InspectorTest() override {
    // A running batch writes below the directory that is about to be removed.
    BackgroundBake& bake = inspector.session().jobs.get<BackgroundBake>();
    bake.cancel();
    bake.wait();
    std::filesystem::current_path(former_directory);
  }

  void draw(int pictures = 1) {
    for (int i = 0; i < pictures; ++i) {
      const Framebuffer target(gl, width, height, 1);
      inspector.draw(input, width, height, 1.0 / 60, [&] { target.bind(); });
    }
  }

  Picture picture() {
    const Framebuffer target(gl, width, height, 1);
    inspector.draw(input, width, height, 1.0 / 60, [&] { target.bind(); });
    return target.read();
  }

  /// Draws until the queue is empty and the session is idle.
  void waitUntilIdle() {
    for (int i = 0; i < 400; ++i) {
      inspector.session().jobs.get<BackgroundReading>().wait();
      draw();
      inspector.session().runs.waitUntilIdle(kForever);
      if (i > 2 && input.empty()) return;
    }
  }

  void colourBy(std::string_view mode) {
    const auto found = std::ranges::find(colourModes(), mode, &ColourMode::id);
    ASSERT_NE(found, colourModes().end()) << mode;
    inspector.session().display.colouring =
        static_cast<std::size_t>(std::distance(colourModes().begin(), found));
  }

  void click(const std::string& widget) {
    const WidgetPlace* place = inspector.ui().find(widget);
    ASSERT_NE(place, nullptr) << widget;
    press(centreOf(*place));
  }

  static ImVec2 centreOf(const WidgetPlace& place) {
    return {(place.min.x + place.max.x) / 2, (place.min.y + place.max.y) / 2};
  }

  void press(ImVec2 at) {
    input.push({.kind = InputEvent::Kind::move, .x = at.x, .y = at.y});
    for (const bool down : {true, false}) {
      input.push({.kind = InputEvent::Kind::button, .code = 0, .down = down});
    }
  }

  void key(Key which, const std::vector<Key>& held = {}) {
    const auto push = [this](Key code, bool down) {
      input.push({.kind = InputEvent::Kind::key, .code = code, .down = down});
    };
    for (const Key modifier : held) push(modifier, true);
    for (const bool down : {true, false}) push(which, down);
    for (const Key modifier : held) push(modifier, false);
  }

  void ctrl(Key which) { key(which, {GLFW_KEY_LEFT_CONTROL}); }

  void type(std::string_view letters) {
    for (const char letter : letters) {
      input.push({.kind = InputEvent::Kind::character, .code = letter});
    }
  }

  bool isShown(const std::string& widget) { return inspector.ui().find(widget) != nullptr; }

  std::string value(const std::string& name) {
    return inspector.value(name).value_or("(no such value)");
  }

  std::unique_ptr<OffscreenContext> context;
  Gl gl;
  Inspector inspector;
  InputQueue input;
  TemporaryDirectory directory;
  std::filesystem::path former_directory;
  int width = 960;
  int height = 600;
};

}  // namespace broadmark::tests
