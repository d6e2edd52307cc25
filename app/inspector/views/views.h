// The views of the scene, side by side.
#pragma once

#include <algorithm>
#include <array>

#include "inspector/views/view.h"

namespace broadmark {

class Views {
 public:
  explicit Views(const Gl& gl) : list_{View(gl), View(gl)} {}

  /// Draws those that are wanted into a rectangle.
  void draw(Ui& ui, Session& session, const RunProgress& progress, ImVec2 position, ImVec2 size);
  /// Whether one moves by itself.
  [[nodiscard]] bool lively() const { return std::ranges::any_of(list_, &View::lively); }
  /// Of what is played.
  [[nodiscard]] View& first() { return list_.front(); }
  [[nodiscard]] const std::array<View, 2>& list() const { return list_; }

 private:
  std::array<View, 2> list_;
};

}  // namespace broadmark
