// Collects the families listed in CMakeLists.txt.

#include "broadmark/algorithms.h"

#include <algorithm>
#include <iterator>

namespace broadmark {

#define FAMILY(name)                 \
  namespace name {                   \
  std::vector<Algorithm> variants(); \
  }
#include "algorithm_families.inc"
#undef FAMILY

std::vector<Algorithm> builtinAlgorithms() {
  std::vector<Algorithm> all;
#define FAMILY(name) std::ranges::move(name::variants(), std::back_inserter(all));
#include "algorithm_families.inc"
#undef FAMILY
  return all;
}

}  // namespace broadmark
