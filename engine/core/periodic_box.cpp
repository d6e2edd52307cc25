#include "broadmark/periodic_box.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "broadmark/error.h"
#include "broadmark/exact_sum.h"

namespace broadmark {
namespace {

constexpr float kLargestFloat = std::numeric_limits<float>::max();

/// bound - periods · period. The product's rounding error is part of the sum's.
ExactSum moved(double bound, double periods, double period) {
  const double shift = periods * period;
  ExactSum sum(bound, -shift);
  sum.error -= std::fma(periods, period, -shift);
  return sum;
}

bool isBelow(const ExactSum& sum, double bound) {
  return sum.value < bound || (sum.value == bound && sum.error < 0);
}

/// Moves a box down along an axis, rounded outward.
void move(Aabb& box, int axis, double periods, double period) {
  const float min = floatBelow(moved(box.min[axis], periods, period));
  const float max = floatAbove(moved(box.max[axis], periods, period));
  box.min[axis] = std::max(min, -kLargestFloat) + 0.0F;  // never -0
  box.max[axis] = std::min(max, kLargestFloat);
}

/// The distance of two intervals; negative if they overlap.
double gapAlong(const Aabb& a, const Aabb& b, int axis) {
  return std::max(double{a.min[axis]} - b.max[axis], double{b.min[axis]} - a.max[axis]);
}

std::optional<double> numberIn(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !(std::abs(number) <= kLargestFloat)) return {};
  return number;
}

}  // namespace

std::string periodicText(const PeriodicBox& box) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ',';
    text += box.repeats(axis) ? fmt::format("{}:{}", box.min[axis], box.max[axis]) : "-";
  }
  return text;
}

PeriodicBox parsePeriodic(std::string_view text) {
  PeriodicBox box;
  const auto fail = [&] {
    throw InputError(fmt::format(
        "'{}' is not a periodic box: LOW:HIGH for each of three axes is expected, or - for an axis "
        "that is not periodic, as in 0:10,0:10,-",
        text));
  };
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = rest.find(',');
    if ((end == std::string_view::npos) != (axis == 2)) fail();
    const std::string_view bounds = rest.substr(0, end);
    rest.remove_prefix(axis == 2 ? rest.size() : end + 1);
    if (bounds == "-") continue;
    const std::size_t colon = bounds.find(':');
    if (colon == std::string_view::npos) fail();
    const std::optional<double> low = numberIn(bounds.substr(0, colon));
    const std::optional<double> high = numberIn(bounds.substr(colon + 1));
    if (!low || !high || !(*low < *high)) fail();
    box.min[axis] = *low;
    box.max[axis] = *high;
  }
  if (!box.repeats()) fail();
  return box;
}

Aabb wrapped(const Aabb& box, const PeriodicBox& periodic) {
  constexpr double kMaxPeriods = 1e6;
  if (isEmpty(box)) return kEmptyBox;
  Aabb result = box;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis];
    if (!periodic.repeats(axis) || (low >= periodic.min[axis] && low < periodic.max[axis]))
      continue;
    const double period = periodic.period(axis);
    double periods = std::floor((low - periodic.min[axis]) / period);
    if (!(std::abs(periods) <= kMaxPeriods)) {
      throw InputError(fmt::format(
          "its box begins {:.3g} periods from the periodic box along {}: at most {:.0f} "
          "are expected",
          periods, "xyz"[axis], kMaxPeriods));
    }
    // The quotient may be rounded across an integer.
    if (isBelow(moved(low, periods, period), periodic.min[axis])) {
      --periods;
    } else if (!isBelow(moved(low, periods, period), periodic.max[axis])) {
      ++periods;
    }
    move(result, axis, periods, period);
  }
  return result;
}

unsigned protrudingAxes(const Aabb& box, const PeriodicBox& periodic) {
  // An image too many adds no pair. One too few, where rounding decides, could lose one.
  constexpr double kTolerance = 1e-9;
  unsigned axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic.repeats(axis)) continue;
    const double face = periodic.max[axis] - kTolerance * periodic.period(axis);
    axes |= (box.max[axis] >= face ? 1U : 0U) << axis;
  }
  return isEmpty(box) ? 0 : axes;
}

Aabb image(Aabb box, unsigned axes, const PeriodicBox& periodic) {
  for (int axis = 0; axis < 3; ++axis) {
    if ((axes >> axis & 1) != 0) move(box, axis, 1, periodic.period(axis));
  }
  return box;
}

std::array<Aabb, 2> nearestImages(const Aabb& a, const Aabb& b, const PeriodicBox& periodic) {
  if (!periodic.repeats()) return {a, b};
  const unsigned axes_a = protrudingAxes(a, periodic);
  const unsigned axes_b = protrudingAxes(b, periodic);
  const Aabb lower_a = image(a, axes_a, periodic);
  const Aabb lower_b = image(b, axes_b, periodic);
  unsigned lower_axes_a = 0;
  unsigned lower_axes_b = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double gap = gapAlong(a, b, axis);
    if ((axes_a >> axis & 1) != 0 && gapAlong(lower_a, b, axis) < gap) {
      gap = gapAlong(lower_a, b, axis);
      lower_axes_a |= 1U << axis;
    }
    if ((axes_b >> axis & 1) != 0 && gapAlong(a, lower_b, axis) < gap) {
      lower_axes_a &= ~(1U << axis);
      lower_axes_b |= 1U << axis;
    }
  }
  return {image(a, lower_axes_a, periodic), image(b, lower_axes_b, periodic)};
}

}  // namespace broadmark
