// A recorded drawing of a structure, for later display.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "broadmark/debug_draw.h"

namespace broadmark {

/// Records what an algorithm draws, up to `kMost` boxes and as many lines, and its test counts by
/// body.
class RecordedDrawing final : public DebugDraw {
 public:
  static constexpr std::size_t kMost = 500'000;

  struct Box {
    Aabb box;
    StructureRole role = StructureRole::cell;
    int level = 0;
    std::uint32_t population = 0;  ///< 0: not reported
  };
  struct Line {
    std::array<float, 3> from{};
    std::array<float, 3> to{};
    StructureRole role = StructureRole::split;
  };

  /// For a scene of up to `bodies` bodies; counts of others are dropped.
  explicit RecordedDrawing(std::size_t bodies = 0) : bodies_(bodies) {}
  /// From recorded parts.
  RecordedDrawing(std::vector<Box> boxes, std::vector<Line> lines, std::size_t left_out,
                  std::vector<std::uint32_t> tests)
      : bodies_(tests.size()),
        boxes_(std::move(boxes)),
        lines_(std::move(lines)),
        left_out_(left_out),
        tests_(std::move(tests)) {}

  void box(const Aabb& box, StructureRole role, int level) override {
    keep(boxes_, {box, role, level});
  }
  void cell(const Aabb& box, int level, std::uint32_t population) override {
    keep(boxes_, {box, StructureRole::cell, level, population});
  }
  void line(const std::array<float, 3>& from, const std::array<float, 3>& to,
            StructureRole role) override {
    keep(lines_, {from, to, role});
  }
  void tests(std::uint32_t body, std::uint32_t count) override {
    if (body >= bodies_) return;
    tests_.resize(bodies_);
    tests_[body] += count;
  }

  [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }
  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }
  /// The number of boxes and lines beyond the limit.
  [[nodiscard]] std::size_t leftOut() const { return left_out_; }
  /// By body; empty: not reported.
  [[nodiscard]] const std::vector<std::uint32_t>& tests() const { return tests_; }

 private:
  template <class Item>
  void keep(std::vector<Item>& items, Item item) {
    if (items.size() < kMost) {
      items.push_back(item);
    } else {
      ++left_out_;
    }
  }

  std::size_t bodies_;
  std::vector<Box> boxes_;
  std::vector<Line> lines_;
  std::size_t left_out_ = 0;
  std::vector<std::uint32_t> tests_;
};

}  // namespace broadmark
