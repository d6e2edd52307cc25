#include "inspector/run/draw_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace broadmark::tests {
namespace {

TEST(DrawGate, NeverTimesWhileDrawing) {
  DrawGate gate;
  std::atomic<bool> drawing = false;
  std::atomic<int> met = 0;
  std::atomic<int> drawn = 0;
  std::atomic<bool> done = false;
  std::thread timer([&] {
    while (drawn < 500) {
      gate.beginTiming();
      const bool seen = drawing;
      if (!gate.endTiming() && seen) ++met;
    }
    done = true;
  });
  while (!done) {
    gate.beginDrawing();
    drawing = true;
    ++drawn;
    drawing = false;
    gate.endDrawing();
  }
  timer.join();
  EXPECT_EQ(met, 0);
}

TEST(DrawGate, ALongFrameLetsTheOtherSideDrawAndIsCalledDisturbed) {
  DrawGate gate;
  gate.beginTiming();
  std::thread drawer([&] {
    gate.beginDrawing();
    gate.endDrawing();
  });
  drawer.join();
  EXPECT_TRUE(gate.endTiming());
  gate.beginTiming();
  EXPECT_FALSE(gate.endTiming());
}

}  // namespace
}  // namespace broadmark::tests
