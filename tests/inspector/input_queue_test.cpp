#include "broadmark/render/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

namespace broadmark::tests {
namespace {

class InputQueueTest : public testing::Test {
 protected:
  InputQueueTest() : context(ImGui::CreateContext()) {}
  ~InputQueueTest() override { ImGui::DestroyContext(context); }

  void press(Key key, bool down) {
    queue.push({.kind = InputEvent::Kind::key, .code = key, .down = down});
  }

  ImGuiContext* context;
  InputQueue queue;
};

TEST_F(InputQueueTest, AQuickPressIsSeenAsDownAndThenUp) {
  press(GLFW_KEY_SPACE, true);
  press(GLFW_KEY_SPACE, false);
  ImGuiIO& io = ImGui::GetIO();
  queue.applyTo(io);
  EXPECT_TRUE(io.KeysDown[GLFW_KEY_SPACE]);
  queue.applyTo(io);
  EXPECT_FALSE(io.KeysDown[GLFW_KEY_SPACE]);
  EXPECT_TRUE(queue.empty());
}

TEST_F(InputQueueTest, TheMouseIsSeenWhereItClicksBeforeDuringAndAfter) {
  const auto move = [&](float x) { queue.push({.kind = InputEvent::Kind::move, .x = x, .y = 6}); };
  const auto button = [&](bool down) {
    queue.push({.kind = InputEvent::Kind::button, .code = 0, .down = down});
  };
  move(4);
  move(5);
  button(true);
  move(50);
  button(false);
  move(60);
  ImGuiIO& io = ImGui::GetIO();
  struct Picture {
    float x;
    bool down;
  };
  for (const Picture& expected : {Picture{5, false}, {5, true}, {50, true}, {50, false}}) {
    queue.applyTo(io);
    EXPECT_EQ(io.MousePos.x, expected.x);
    EXPECT_EQ(io.MouseDown[0], expected.down);
  }
}

TEST_F(InputQueueTest, AClickWithoutAMoveTakesTwoPictures) {
  queue.push({.kind = InputEvent::Kind::move, .x = 5, .y = 6});
  ImGuiIO& io = ImGui::GetIO();
  queue.applyTo(io);
  queue.push({.kind = InputEvent::Kind::move, .x = 5, .y = 6});
  queue.push({.kind = InputEvent::Kind::button, .code = 0, .down = true});
  queue.push({.kind = InputEvent::Kind::button, .code = 0, .down = false});
  queue.applyTo(io);
  EXPECT_TRUE(io.MouseDown[0]);
  queue.applyTo(io);
  EXPECT_FALSE(io.MouseDown[0]);
}

TEST_F(InputQueueTest, AModifierIsDownWithItsKey) {
  press(GLFW_KEY_LEFT_CONTROL, true);
  press(GLFW_KEY_A, true);
  press(GLFW_KEY_A, false);
  press(GLFW_KEY_LEFT_CONTROL, false);
  ImGuiIO& io = ImGui::GetIO();
  queue.applyTo(io);
  EXPECT_TRUE(io.KeyCtrl);
  EXPECT_TRUE(io.KeysDown[GLFW_KEY_A]);
}

TEST_F(InputQueueTest, UnknownNumbersAreNoHarm) {
  press(-1, true);
  press(100000, true);
  queue.push({.kind = InputEvent::Kind::button, .code = 77, .down = true});
  queue.applyTo(ImGui::GetIO());
  EXPECT_TRUE(queue.empty());
}

TEST_F(InputQueueTest, KeysHaveNames) {
  EXPECT_EQ(keyNamed("Escape"), GLFW_KEY_ESCAPE);
  EXPECT_EQ(keyNamed("a"), GLFW_KEY_A);
  EXPECT_EQ(keyNamed("F12"), GLFW_KEY_F12);
  EXPECT_EQ(keyNamed("F13"), 0);
  EXPECT_EQ(keyNamed("Hyper"), 0);
}

}  // namespace
}  // namespace broadmark::tests
