// A recorded drawing of a structure, for later display.
//
// Example:
//
//   RecordedDrawing drawing(2);  // of a scene of two bodies
//   drawing.cell({{0, 0, 0}, {4, 4, 4}}, 0, 2);
//   drawing.tests(1, 5);
//   const std::uint32_t population = drawing.boxes().front().population;  // 2
//   const std::uint32_t tests = drawing.tests()[1];                       // 5
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "broadmark/debug_draw.h"

namespace broadmark {

/// Records an algorithm's drawing, up to `kMaxItems` boxes and as many lines, and its test counts
/// by body. A value: it refers to neither algorithm nor scene.
class RecordedDrawing final : public DebugDraw {
 public:
  static constexpr std::size_t kMaxItems = 500'000;

  /// A call of box() or cell().
  struct Box {
    Aabb box;
    StructureRole role = StructureRole::cell;
    int level = 0;
    std::uint32_t population = 0;  ///< 0: not reported
  };
  /// A call of line().
  struct Segment {
    std::array<float, 3> from{};
    std::array<float, 3> to{};
    StructureRole role = StructureRole::split;
  };

  /// For a scene of `bodies` bodies; test counts of other bodies are dropped.
  explicit RecordedDrawing(std::size_t bodies = 0) : bodies_(bodies) {}
  /// Restores a recorded drawing from what the functions below return; `tests` are by body.
  RecordedDrawing(std::vector<Box> boxes, std::vector<Segment> lines, std::size_t dropped,
                  std::vector<std::uint32_t> tests)
      : bodies_(tests.size()),
        boxes_(std::move(boxes)),
        lines_(std::move(lines)),
        dropped_(dropped),
        tests_(std::move(tests)) {}

  void box(const Aabb& box, StructureRole role, int level) override {
    append(boxes_, {box, role, level});
  }
  void cell(const Aabb& box, int level, std::uint32_t population) override {
    append(boxes_, {box, StructureRole::cell, level, population});
  }
  void line(const std::array<float, 3>& from, const std::array<float, 3>& to,
            StructureRole role) override {
    append(lines_, {from, to, role});
  }
  void tests(std::uint32_t body, std::uint32_t count) override {
    if (body >= bodies_) return;
    tests_.resize(bodies_);
    tests_[body] += count;
  }

  /// Boxes and cells in the order of the calls.
  [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }
  /// Lines in the order of the calls.
  [[nodiscard]] const std::vector<Segment>& lines() const { return lines_; }
  /// The number of boxes and lines beyond the limit, which are not recorded.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }
  /// Test counts by body; empty if not reported.
  [[nodiscard]] const std::vector<std::uint32_t>& tests() const { return tests_; }

 private:
  template <class Item>
  void append(std::vector<Item>& items, Item item) {
    if (items.size() < kMaxItems) {
      items.push_back(item);
    } else {
      ++dropped_;
    }
  }

  std::size_t bodies_;
  std::vector<Box> boxes_;
  std::vector<Segment> lines_;
  std::size_t dropped_ = 0;
  std::vector<std::uint32_t> tests_;
};

}  // namespace broadmark
