// Traversals, depth first. The loops over the slots of a node compile to vector instructions: all
// numbers are finite, and the file is compiled accordingly.

using broadphase::BoxTest;
using broadphase::BoxVisitor;
using broadphase::CastAxis;
using broadphase::CastTest;
using broadphase::NearestTest;
using broadphase::OrderedVisitor;
using broadphase::QueryKernels;
using broadphase::QueryNode;

inline constexpr std::uint32_t kWidth = QueryNode::kWidth;
inline constexpr std::size_t kStackSize = (kWidth - 1) * (QueryKernels::kMaxDepth + 1) + 1;

/// Bit i for each slot i with hits[i] != 0.
inline unsigned slotBits(const std::uint32_t (&hits)[kWidth]) {
  unsigned bits = 0;
  for (std::uint32_t i = 0; i < kWidth; ++i) bits |= hits[i] & 1U << i;
  return bits;
}

inline unsigned testSlots(const QueryNode& node, const BoxTest& test) {
  std::uint32_t hits[kWidth];
  for (std::uint32_t i = 0; i < kWidth; ++i) {
    const bool hit = (node.bounds[0][i] <= test.bounds[3]) & (test.bounds[0] <= node.bounds[3][i]) &
                     (node.bounds[1][i] <= test.bounds[4]) & (test.bounds[1] <= node.bounds[4][i]) &
                     (node.bounds[2][i] <= test.bounds[5]) & (test.bounds[2] <= node.bounds[5][i]) &
                     ((node.layers[i] & test.layers) != 0);
    hits[i] = hit ? ~0U : 0;
  }
  return slotBits(hits);
}

inline unsigned testSlots(const QueryNode& node, const CastTest& test, double limit,
                          double (&values)[kWidth]) {
  const float* nears[3];
  const float* fars[3];
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = test.axes[axis].backwards;
    nears[axis] = node.bounds[backwards ? axis + 3 : axis];
    fars[axis] = node.bounds[backwards ? axis : axis + 3];
  }
  std::uint32_t hits[kWidth];
  for (std::uint32_t i = 0; i < kWidth; ++i) {
    double enters = 0;
    double leaves = limit;
    for (int axis = 0; axis < 3; ++axis) {
      enters = broadphase::largerOf(enters, test.axes[axis].timeOfNear(nears[axis][i]));
      leaves = broadphase::smallerOf(leaves, test.axes[axis].timeOfFar(fars[axis][i]));
    }
    values[i] = enters;
    hits[i] = (enters <= leaves) & ((node.layers[i] & test.layers) != 0) ? ~0U : 0;
  }
  return slotBits(hits);
}

inline unsigned testSlots(const QueryNode& node, const NearestTest& test, double limit,
                          double (&values)[kWidth]) {
  std::uint32_t hits[kWidth];
  for (std::uint32_t i = 0; i < kWidth; ++i) {
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double distance = broadphase::axisDistance(
          test.point[axis], node.bounds[axis][i], node.bounds[axis + 3][i]);
      squares += distance * distance;
    }
    values[i] = squares;
    hits[i] = (squares <= limit) & ((node.layers[i] & test.layers) != 0) ? ~0U : 0;
  }
  return slotBits(hits);
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
