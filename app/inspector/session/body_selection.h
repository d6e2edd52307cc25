// The selected bodies, and those in focus: the camera flew to them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "inspector/session/document.h"

namespace broadmark {

class BodySelection {
 public:
  using Bodies = std::vector<std::uint32_t>;

  /// The arguments must outlive this object.
  BodySelection(const Playback& playback, Document& document)
      : playback_(playback), document_(document) {}

  /// Ascending. While the document is shown: the selection of its editor.
  [[nodiscard]] const Bodies& bodies() const {
    return document_.shown() ? document_.editor.selection() : bodies_;
  }

  /// Selects bodies, given in any order; ignores those that do not exist.
  void select(Bodies bodies) {
    scenes::SceneEditor& editor = document_.editor;
    const bool in_document = document_.shown();
    const std::size_t count =
        in_document ? editor.scene().bodies.size() : playback_.scene().objects;
    std::ranges::sort(bodies);
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    std::erase_if(bodies, [&](std::uint32_t body) { return body >= count; });
    if (in_document) {
      editor.select(std::move(bodies));
    } else {
      bodies_ = std::move(bodies);
    }
  }

  /// Adds bodies (ascending), or removes them if all of them are selected.
  void toggle(const Bodies& bodies) {
    Bodies toggled;
    if (std::ranges::includes(this->bodies(), bodies)) {
      std::ranges::set_difference(this->bodies(), bodies, std::back_inserter(toggled));
    } else {
      std::ranges::set_union(this->bodies(), bodies, std::back_inserter(toggled));
    }
    select(std::move(toggled));
  }

  /// Returns the bodies and the other members of their groups.
  [[nodiscard]] Bodies withGroups(Bodies bodies) const {
    return document_.shown() ? document_.editor.withGroups(std::move(bodies)) : bodies;
  }

  /// Selects the two bodies of a pair, and flies to them.
  void flyToPair(Pair pair) {
    select({pair.a, pair.b});
    flyToSelection();
  }
  void flyToSelection() { flyTo(bodies()); }
  void flyTo(Bodies bodies) {
    focus_ = bodies;
    fly_to = std::move(bodies);
  }
  /// Bodies that the views show in front of all others: those of the last flight, while they are
  /// selected.
  [[nodiscard]] std::span<const std::uint32_t> focus() const {
    return std::ranges::includes(bodies(), focus_) ? std::span(focus_)
                                                   : std::span<const std::uint32_t>();
  }
  /// Call when another source is shown.
  void reset() {
    bodies_.clear();
    focus_.clear();
  }

  /// Bodies to fly to, reset by the view; an empty list means all bodies.
  std::optional<Bodies> fly_to;

 private:
  const Playback& playback_;
  Document& document_;
  Bodies bodies_;  ///< selection in sources other than the document
  Bodies focus_;   ///< ascending
};

}  // namespace broadmark
