// Which bodies are selected, and which of them the view is to fly to.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "inspector/session/document.h"

namespace broadmark {

class BodySelection {
 public:
  using Bodies = std::vector<std::uint32_t>;

  /// The parts outlive it.
  BodySelection(const Playback& playback, Document& document)
      : playback_(playback), document_(document) {}

  /// Ascending. While the document is shown, those that its editor works on.
  [[nodiscard]] const Bodies& bodies() const {
    return document_.shown() ? document_.editor.selection() : bodies_;
  }

  /// Selects these, given in any order; those that do not exist are left out.
  void select(Bodies bodies) {
    scenes::SceneEditor& editor = document_.editor;
    const bool of_document = document_.shown();
    const std::size_t count =
        of_document ? editor.scene().bodies.size() : playback_.scene().objects;
    std::ranges::sort(bodies);
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    std::erase_if(bodies, [&](std::uint32_t body) { return body >= count; });
    if (of_document) {
      editor.select(std::move(bodies));
    } else {
      bodies_ = std::move(bodies);
    }
  }

  /// Adds bodies (ascending), or takes them away if all of them are selected.
  void toggle(const Bodies& bodies) {
    Bodies toggled;
    if (std::ranges::includes(this->bodies(), bodies)) {
      std::ranges::set_difference(this->bodies(), bodies, std::back_inserter(toggled));
    } else {
      std::ranges::set_union(this->bodies(), bodies, std::back_inserter(toggled));
    }
    select(std::move(toggled));
  }

  /// These and all that are selected with them.
  [[nodiscard]] Bodies whole(Bodies bodies) const {
    return document_.shown() ? document_.editor.withGroups(std::move(bodies)) : bodies;
  }

  /// Selects the two bodies of a pair and flies there.
  void visit(Pair pair) {
    select({pair.a, pair.b});
    flyThere();
  }
  void flyThere() { fly_to = bodies(); }
  /// To be called when other source is shown.
  void reset() { bodies_.clear(); }

  /// What the view is to fly to, until it takes it; an empty list means everything.
  std::optional<Bodies> fly_to;

 private:
  const Playback& playback_;
  Document& document_;
  Bodies bodies_;  ///< of source that is not the document
};

}  // namespace broadmark
