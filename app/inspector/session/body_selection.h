// Which bodies are selected, and which of them the view is to fly to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

/// Ids from text: "17, 40-50", each at most `last`. Throws InputError, naming `what`.
std::vector<std::uint32_t> parseIds(std::string_view text, std::string_view what,
                                    std::uint32_t last);

class BodySelection {
 public:
  using Bodies = std::vector<std::uint32_t>;

  /// Ascending.
  [[nodiscard]] const Bodies& bodies() const { return bodies_; }
  [[nodiscard]] bool contains(std::uint32_t body) const;

  /// Selects these, given in any order; those that do not exist are left out.
  void select(Bodies bodies);
  /// Adds bodies (ascending), or takes them away if all of them are selected.
  void toggle(const Bodies& bodies);
  /// These and all that are selected with them.
  [[nodiscard]] Bodies whole(Bodies bodies) const {
    return companions ? companions(std::move(bodies)) : bodies;
  }
  /// Selects the two bodies of a pair and flies there.
  void visit(Pair pair);
  void flyThere() { fly_to = bodies_; }
  /// Takes over what has been selected elsewhere (ascending), without calling on_select.
  void follow(Bodies bodies) { bodies_ = std::move(bodies); }

  /// What the view is to fly to, until it takes it; an empty list means everything.
  std::optional<Bodies> fly_to;

  // Set by the owner.
  std::function<std::size_t()> body_count;
  std::function<Bodies(Bodies)>
      companions;  ///< adds those that are selected with them; may be null
  std::function<void(const Bodies&)> on_select;

 private:
  Bodies bodies_;
};

}  // namespace broadmark
