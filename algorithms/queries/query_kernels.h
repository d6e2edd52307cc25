// The inner loops of queries, with one table of them for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "broadmark/execution.h"
#include "queries/query_math.h"

namespace broadmark::broadphase {

/// Eight children: bodies, other nodes or unused slots.
struct alignas(64) QueryNode {
  static constexpr std::uint32_t kWidth = 8;
  static constexpr std::uint32_t kBody = 0x8000'0000;  ///< flag: the rest is a body, not a node
  static constexpr std::uint32_t kUnused = 0xFFFF'FFFF;
  /// Bounds of unused slots, reversed: finite, unlike kEmptyBox.
  static constexpr float kMax = std::numeric_limits<float>::max();

  float bounds[6][kWidth];       ///< min x, y, z, max x, y, z
  std::uint32_t layers[kWidth];  ///< those of all bodies below; 0: none
  std::uint32_t children[kWidth];
};
static_assert(sizeof(QueryNode) == 256);

struct BoxTest {
  float bounds[6];
  std::uint32_t layers;
};

struct CastTest {
  CastAxis axes[3];
  std::size_t near_rows[3];  ///< of the bounds
  std::size_t far_rows[3];
  double limit;
  std::uint32_t layers;
};

struct NearestTest {
  double point[3];
  double limit;  ///< of the squared distance
  std::uint32_t layers;
};

/// Receives the bodies that are found.
struct BoxVisitor {
  void (*visit)(void* context, const QueryNode& node, unsigned slots);
  void* context;
};
/// Also receives times or squared distances by slot. Returns the new limit.
struct OrderedVisitor {
  double (*visit)(void* context, const QueryNode& node, unsigned slots, const double* values);
  void* context;
};

struct QueryKernels {
  /// A node of a tree is at most this deep; the root is 0.
  static constexpr std::uint32_t kMaxDepth = 40;

  void (*overlapping)(const QueryNode* nodes, const BoxTest& test, BoxVisitor visitor);
  void (*cast)(const QueryNode* nodes, const CastTest& test, OrderedVisitor visitor);
  void (*nearest)(const QueryNode* nodes, const NearestTest& test, OrderedVisitor visitor);
};

/// The kernels for an instruction set, which this processor must support.
const QueryKernels& queryKernels(Isa isa);

}  // namespace broadmark::broadphase
