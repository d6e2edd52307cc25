// A panel of two parts: beside each other, or, where there is no room for that, one of them.
#pragma once

#include <functional>

namespace broadmark {

struct TwoParts {
  float share = 0.5F;         ///< of the width: the first one's
  float narrowest = 0;        ///< pixels that both need
  bool second_alone = false;  ///< which of them, where there is room for one only

  [[nodiscard]] bool both() const;
  void draw(const std::function<void()>& first, const std::function<void()>& second) const;
};

}  // namespace broadmark
