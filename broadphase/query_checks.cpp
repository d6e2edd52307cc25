#include "query_checks.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "box_reader.h"

namespace broadmark::broadphase {
namespace {

[[noreturn, gnu::cold]] void refuse(std::size_t query, std::string_view fault) {
  throw std::invalid_argument(
      std::string("query ").append(std::to_string(query)).append(": ").append(fault));
}

void check(std::size_t number, const Box& box) {
  const Aabb checked = BoxReader(box.min, box.max, 0, 0).raw(0);
  if (!isFiniteBox(checked)) refuse(number, faultOf(checked));
}

void check(std::size_t number, const float (&vector)[3], std::string_view fault) {
  for (const float x : vector) {
    if (!std::isfinite(x)) refuse(number, fault);
  }
}

void check(std::size_t number, float limit, std::string_view fault) {
  if (!(limit >= 0)) refuse(number, fault);
}

}  // namespace

void checkQueries(std::span<const BoxQuery> queries) {
  for (std::size_t i = 0; i < queries.size(); ++i) check(i, queries[i].box);
}
void checkQueries(std::span<const Cast> casts) {
  for (std::size_t i = 0; i < casts.size(); ++i) {
    check(i, casts[i].box);
    check(i, casts[i].direction, "direction is not finite");
    check(i, casts[i].max_fraction, "max_fraction is negative or NaN");
  }
}
void checkQueries(std::span<const NearestQuery> queries) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    check(i, queries[i].point, "point is not finite");
    check(i, queries[i].max_distance, "max_distance is negative or NaN");
  }
}

}  // namespace broadmark::broadphase
