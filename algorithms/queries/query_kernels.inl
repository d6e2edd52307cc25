// Traversals, depth first. The loops over the slots of a node compile to vector instructions: all
// numbers are finite, and the file is compiled accordingly.

using broadphase::BoxTest;
using broadphase::BoxVisitor;
using broadphase::CastAxis;
using broadphase::CastTest;
using broadphase::largerOf;
using broadphase::NearestTest;
using broadphase::OrderedVisitor;
using broadphase::QueryKernels;
using broadphase::QueryNode;
using broadphase::smallerOf;

inline constexpr std::uint32_t kWidth = QueryNode::kWidth;
inline constexpr std::size_t kStackSize = (kWidth - 1) * (QueryKernels::kMaxDepth + 1) + 1;

// These may read arrays of their elements.
using Floats = float __attribute__((vector_size(32), may_alias));
using SlotMask = std::int32_t __attribute__((vector_size(32), may_alias));

/// Bit i for each slot i of which the mask is set.
inline unsigned slotBits(SlotMask mask) {
#if defined(__SSE2__)
  const auto low = __builtin_shufflevector(mask, mask, 0, 1, 2, 3);
  const auto high = __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(low)) |
                               _mm_movemask_ps(reinterpret_cast<__m128>(high)) << 4);
#else
  unsigned bits = 0;
  for (std::uint32_t i = 0; i < kWidth; ++i) bits |= static_cast<unsigned>(mask[i]) & 1U << i;
  return bits;
#endif
}

inline Floats boundsIn(const float (&row)[kWidth]) { return reinterpret_cast<const Floats&>(row); }
inline SlotMask slotsWith(std::uint32_t layers, const QueryNode& node) {
  return (reinterpret_cast<const SlotMask&>(node.layers) & static_cast<std::int32_t>(layers)) != 0;
}

inline unsigned testSlots(const QueryNode& node, const BoxTest& test) {
  return slotBits(
      (boundsIn(node.bounds[0]) <= test.bounds[3]) & (boundsIn(node.bounds[3]) >= test.bounds[0]) &
      (boundsIn(node.bounds[1]) <= test.bounds[4]) & (boundsIn(node.bounds[4]) >= test.bounds[1]) &
      (boundsIn(node.bounds[2]) <= test.bounds[5]) & (boundsIn(node.bounds[5]) >= test.bounds[2]) &
      slotsWith(test.layers, node));
}

inline unsigned testSlots(const QueryNode& node, const CastTest& test, double limit,
                          double (&values)[kWidth]) {
  alignas(32) std::int32_t hits[kWidth];
  for (std::uint32_t i = 0; i < kWidth; ++i) {
    const auto near_time = [&](int axis) __attribute__((always_inline)) {
      return test.axes[axis].timeOfNear(node.bounds[test.near_rows[axis]][i]);
    };
    const auto far_time = [&](int axis) __attribute__((always_inline)) {
      return test.axes[axis].timeOfFar(node.bounds[test.far_rows[axis]][i]);
    };
    const double enter = largerOf(largerOf(near_time(0), near_time(1)), largerOf(near_time(2), 0));
    const double leave = smallerOf(smallerOf(far_time(0), far_time(1)), far_time(2));
    values[i] = enter;
    hits[i] = enter <= smallerOf(limit, leave * (1 + broadphase::kCastTolerance)) ? -1 : 0;
  }
  return slotBits(reinterpret_cast<const SlotMask&>(hits) & slotsWith(test.layers, node));
}

inline unsigned testSlots(const QueryNode& node, const NearestTest& test, double limit,
                          double (&values)[kWidth]) {
  alignas(32) std::int32_t hits[kWidth];
  for (std::uint32_t i = 0; i < kWidth; ++i) {
    const auto distance = [&](int axis) __attribute__((always_inline)) {
      return broadphase::axisDistance(test.point[axis], node.bounds[axis][i],
                                      node.bounds[axis + 3][i]);
    };
    const double x = distance(0);
    const double y = distance(1);
    const double z = distance(2);
    values[i] = x * x + y * y + z * z;
    hits[i] = values[i] <= limit ? -1 : 0;
  }
  return slotBits(reinterpret_cast<const SlotMask&>(hits) & slotsWith(test.layers, node));
}

void findOverlapping(const QueryNode* nodes, const BoxTest& test, BoxVisitor visitor) {
  std::uint32_t stack[kStackSize];
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const QueryNode& node = nodes[stack[--top]];
    unsigned bodies = 0;
    for (unsigned bits = testSlots(node, test); bits != 0; bits &= bits - 1) {
      const int slot = __builtin_ctz(bits);
      const std::uint32_t child = node.children[slot];
      if ((child & QueryNode::kBody) != 0) {
        bodies |= 1U << slot;
      } else {
        stack[top++] = child;
      }
    }
    if (bodies != 0) visitor.visit(visitor.context, node, bodies);
  }
}

/// The nearest child first, so that the limit falls soon.
template <class Test>
inline void findOrdered(const QueryNode* nodes, const Test& test, OrderedVisitor visitor) {
  struct Entry {
    double value;
    std::uint32_t node;
  };
  Entry stack[kStackSize];
  std::size_t top = 0;
  stack[top++] = {0, 0};
  double limit = test.limit;
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.value > limit) continue;
    const QueryNode& node = nodes[entry.node];
    alignas(64) double values[kWidth];
    unsigned bodies = 0;
    const std::size_t first = top;
    for (unsigned bits = testSlots(node, test, limit, values); bits != 0; bits &= bits - 1) {
      const int slot = __builtin_ctz(bits);
      const std::uint32_t child = node.children[slot];
      if ((child & QueryNode::kBody) != 0) {
        bodies |= 1U << slot;
        continue;
      }
      std::size_t at = top++;
      for (; at > first && stack[at - 1].value < values[slot]; --at) stack[at] = stack[at - 1];
      stack[at] = {values[slot], child};
    }
    if (bodies != 0) limit = visitor.visit(visitor.context, node, bodies, values);
  }
}

void findCast(const QueryNode* nodes, const CastTest& test, OrderedVisitor visitor) {
  findOrdered(nodes, test, visitor);
}

void findNearest(const QueryNode* nodes, const NearestTest& test, OrderedVisitor visitor) {
  findOrdered(nodes, test, visitor);
}

inline constexpr QueryKernels kKernels = {findOverlapping, findCast, findNearest};
