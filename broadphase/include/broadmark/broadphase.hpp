// Broad-phase collision detection for engines and games: the pairs of bodies whose boxes overlap,
// or the changes to these pairs, from frame to frame. Example: examples/game_loop.cpp; costs and
// limits: docs/embedding.md.
//
//   broadmark::broadphase::BroadPhase broad_phase({.margin = 0.1F});
//   broad_phase.update(boxes);  // in every frame; body i has boxes[i]
//   for (const auto [a, b] : broad_phase.pairs()) ...
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace broadmark::broadphase {

/// An axis-aligned box. Intervals are closed: boxes that touch overlap. Bounds are finite and in
/// order on every axis, unless it is kNoBox. Any unit of length will do.
struct Box {
  float min[3];
  float max[3];
};

/// The box of a body that is absent: an unused slot. It overlaps nothing.
inline constexpr Box kNoBox = {
    {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
     std::numeric_limits<float>::infinity()},
    {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
     -std::numeric_limits<float>::infinity()}};

/// Two bodies, a < b.
struct [[gnu::may_alias]] Pair {
  std::uint32_t a;
  std::uint32_t b;

  friend bool operator==(const Pair&, const Pair&) = default;
  friend auto operator<=>(const Pair&, const Pair&) = default;
};

/// The caller's boxes, wherever they lie: body i has three floats at `min` and three at `max`, both
/// `stride` bytes further for each body. Borrowed: read during the call alone. Need not be aligned.
struct Boxes {
  const float* min = nullptr;  ///< of body 0; may be null only without bodies
  const float* max = nullptr;
  std::size_t count = 0;             ///< of bodies; at most BroadPhase::kMaxBodies
  std::size_t stride = sizeof(Box);  ///< in bytes; at least three floats

  Boxes() = default;
  Boxes(const float* mins, const float* maxs, std::size_t number, std::size_t bytes_apart)
      : min(mins), max(maxs), count(number), stride(bytes_apart) {}
  // NOLINTNEXTLINE(google-explicit-constructor): arrays and vectors of boxes are boxes
  Boxes(std::span<const Box> boxes) : count(boxes.size()) {
    if (boxes.empty()) return;
    min = boxes.data()->min;
    max = boxes.data()->max;
  }
  // NOLINTNEXTLINE(google-explicit-constructor)
  Boxes(const std::vector<Box>& boxes) : Boxes(std::span<const Box>(boxes)) {}
};

/// Which pairs a body is in, besides its box. By default all that layer 0 allows.
struct Filter {
  /// An unused tag, which no body shares.
  static constexpr std::uint32_t kNoTag = 0xFFFF'FFFF;

  std::uint32_t layer = 0;  ///< 0 to 31: Options::collides tells which layers collide
  /// Bodies that share a tag are no pair: the limbs of a ragdoll, triangles that share a vertex.
  std::array<std::uint32_t, 3> tags = {kNoTag, kNoTag, kNoTag};

  friend bool operator==(const Filter&, const Filter&) = default;
};

/// The algorithm. Both find the same pairs; docs/embedding.md compares their costs.
enum class Method {
  tide,    ///< the cost grows with the number of moving bodies; many: the same as columns
  columns  ///< finds all pairs in every update; half the memory
};
/// What an update finds.
enum class Answer {
  pairs,  ///< pairs(): all pairs of the frame
  events  ///< began() and ended(): their changes since the update before
};
/// The answer is the same set for the same boxes, always.
enum class Order {
  sorted,  ///< ascending by a, then b: independent of threads, processor, method and history
  any      ///< as found; may differ between processors, and after restore()
};
/// The instruction set of the kernels; best: the widest that the processor has. Answers do not
/// depend on it.
enum class InstructionSet { best, scalar, sse2, neon, avx2, avx512, simd128 };
/// What is done with the ids given to update(boxes, changed).
enum class Changes {
  verified,  ///< all boxes are compared; a changed body that is not listed throws
  trusted    ///< only the listed bodies and new ones are read; what is not listed stays as it was
};

/// The caller's job system: calls job(i) exactly once for each i below `jobs`, in any order, at the
/// same time or one after another, and returns when all calls have returned. Jobs do not throw;
/// what it throws itself passes through the update or query. Must not use the object.
using ParallelFor = std::function<void(int jobs, const std::function<void(int)>& job)>;

/// Fixed when an object is created.
struct Options {
  Method method = Method::tide;
  Answer answer = Answer::pairs;
  Order order = Order::sorted;
  Changes changes = Changes::verified;
  /// Threads, the caller's included, 1 to 1024. Worlds that were built with few bodies use one.
  int threads = 1;
  /// Runs the work of `threads` threads, if more than one; empty: own threads.
  ParallelFor parallel_for = {};
  InstructionSet instruction_set = InstructionSet::best;
  /// Each box is enlarged by this on every side, rounded outward: also finds what is closer than
  /// twice the margin on every axis. In the unit of the boxes. Finite, not negative.
  float margin = 0;
  /// Bit b of row a: layers a and b collide. Symmetric: see setCollides(). By default all do.
  std::array<std::uint32_t, 32> collides = [] {
    std::array<std::uint32_t, 32> all{};
    for (std::uint32_t& row : all) row = 0xFFFF'FFFF;
    return all;
  }();

  /// Sets whether two layers collide, or one with itself. Throws std::out_of_range for a layer
  /// above 31.
  void setCollides(std::size_t a, std::size_t b, bool collide = true) {
    std::uint32_t& row_a = collides.at(a);
    std::uint32_t& row_b = collides.at(b);
    const std::uint32_t bit_a = std::uint32_t{1} << a;
    const std::uint32_t bit_b = std::uint32_t{1} << b;
    row_a = collide ? row_a | bit_b : row_a & ~bit_b;
    row_b = collide ? row_b | bit_a : row_b & ~bit_a;
  }
};

/// What queries find: bodies of these layers, bit b for layer b.
inline constexpr std::uint32_t kAllLayers = 0xFFFF'FFFF;

/// Asks for the bodies whose boxes overlap a box.
struct [[gnu::may_alias]] BoxQuery {
  Box box;                            ///< not kNoBox
  std::uint32_t layers = kAllLayers;  ///< of the bodies to find: bit b for layer b
};

/// Asks for the bodies whose boxes are hit by a box that moves along `direction`, up to
/// `max_fraction` times as far; infinity: no limit. A ray is the cast of a point: min = max.
struct [[gnu::may_alias]] Cast {
  Box box;                            ///< at the start; not kNoBox
  float direction[3];                 ///< the way at fraction 1; need not have unit length
  float max_fraction = 1;             ///< not negative
  std::uint32_t layers = kAllLayers;  ///< of the bodies to find: bit b for layer b
};

/// The cast's box and the body's begin to overlap when the former has moved by `fraction` times its
/// direction; 0 if they do at the start.
struct [[gnu::may_alias]] CastHit {
  double fraction;
  std::uint32_t body;

  friend bool operator==(const CastHit&, const CastHit&) = default;
  friend auto operator<=>(const CastHit&, const CastHit&) = default;
};

/// Which hits of a cast are reported.
enum class Hits {
  closest,  ///< the first one; of several at the same fraction, that of the lowest body
  all       ///< ascending by fraction, then body
};

/// Asks for the `count` bodies whose boxes are nearest to a point, up to `max_distance` away;
/// infinity: no limit.
struct [[gnu::may_alias]] NearestQuery {
  float point[3];
  std::uint32_t count = 1;                                      ///< 0: none
  float max_distance = std::numeric_limits<float>::infinity();  ///< not negative
  std::uint32_t layers = kAllLayers;  ///< of the bodies to find: bit b for layer b
};

/// A body that a NearestQuery has found.
struct [[gnu::may_alias]] Neighbour {
  double distance;  ///< from the point to the body's box; 0 inside of it
  std::uint32_t body;

  friend bool operator==(const Neighbour&, const Neighbour&) = default;
};

/// The answers to a batch of queries. Keeps its memory if it is used again.
template <class T>
struct QueryResults {
  std::vector<std::size_t> starts;  ///< of each query's answer in `items`, and their end
  std::vector<T> items;             ///< the answers, one after another

  /// The number of queries.
  [[nodiscard]] std::size_t size() const { return starts.empty() ? 0 : starts.size() - 1; }
  /// The answer to a query, by its index in the batch; valid until the results are used again.
  [[nodiscard]] std::span<const T> operator[](std::size_t query) const {
    return std::span(items).subspan(starts[query], starts[query + 1] - starts[query]);
  }
};

/// Finds the pairs of a world of bodies. A body's id is the index of its box, the same in every
/// update; ids of absent bodies may be reused. Copies the boxes.
///
/// Errors, in release builds, too:
/// - std::invalid_argument: the call is at fault, and has changed nothing.
/// - std::logic_error: the call is not allowed now, and has changed nothing.
/// - Anything else: std::bad_alloc, std::system_error if threads cannot be started, an exception
///   from the job system, or std::logic_error because it has not run each job exactly once. After
///   such a failure of update() or restore(), only restore() and destruction are allowed, and
///   earlier answers are invalid.
///
/// One thread at a time: a call during another one throws std::logic_error. In a steady state
/// update(), save() and queries allocate nothing. docs/embedding.md says what each call costs, and
/// how much memory an object takes.
class BroadPhase {
 public:
  /// The largest number of bodies; ids are below it.
  static constexpr std::size_t kMaxBodies = (std::size_t{1} << 29) - 1;

  /// A world without bodies. Throws std::invalid_argument for options out of their range, an
  /// instruction set that this processor lacks, or layers whose matrix is not symmetric. Starts no
  /// threads: the first update with bodies does.
  explicit BroadPhase(const Options& options = {});
  /// Waits for own threads to end. Not during another call.
  ~BroadPhase();
  /// Of an object moved from, all calls but destruction and assignment throw std::logic_error.
  /// Answers remain valid.
  BroadPhase(BroadPhase&&) noexcept;
  BroadPhase& operator=(BroadPhase&&) noexcept;

  /// Takes the boxes of all bodies, copies those that changed, and finds the answer. Bodies may
  /// appear and vanish (kNoBox), and their number may change: those beyond the end are gone. Throws
  /// std::invalid_argument for NaN, infinite bounds, min > max, too many bodies, a null pointer, or
  /// a stride of less than three floats.
  ///
  /// Costs O(n) for the comparison of all boxes, and the search: with tide in proportion to the
  /// bodies that move, otherwise to all. The first update builds everything; so does one after
  /// setFilter(), one with more bodies than there is room for, and the first one in which a body is
  /// absent or their number is another.
  void update(const Boxes& boxes);
  /// The same if the caller knows which bodies changed: moved, appeared or vanished. In any order,
  /// but ascending ones need no sorting; listing others, or one twice, does no harm. New bodies at
  /// the end, and those beyond a new end, need not be listed. What Options::changes says is done
  /// with them. Throws std::invalid_argument as above, for an id that does not exist, and, if
  /// changes are verified, for a changed body that is not listed. Trusted changes save the
  /// comparison of all boxes; those of other bodies are not read.
  void update(const Boxes& boxes, std::span<const std::uint32_t> changed);

  /// Sets a body's filter, from the next update on, which then costs at least as much as the first;
  /// setting the same filter again costs nothing. The body need not exist yet; the filter stays
  /// when it vanishes. Takes 16 bytes for each id up to the highest with a filter. Throws
  /// std::invalid_argument for an id from kMaxBodies on, or a layer above 31.
  void setFilter(std::uint32_t body, const Filter& filter);

  /// The answer of the last update (none before the first); valid until the next one or restore().
  /// In the order of Options::order. Throws std::logic_error if Options::answer is the other. O(1).
  [[nodiscard]] std::span<const Pair> pairs() const;
  /// The pairs that the last update has, and the one before had not: in the first update, all.
  /// Valid as long as pairs() are, with the same order and exceptions.
  [[nodiscard]] std::span<const Pair> began() const;
  /// The pairs that the update before had, and the last one has not. In all else as began().
  [[nodiscard]] std::span<const Pair> ended() const;

  /// Queries about the boxes and layers of the last update or restore(), with the margin. Each call
  /// answers a batch, in parallel if there are threads. The answers depend on these boxes alone.
  /// The first query builds a tree, which later ones refit to what has changed; updates cost
  /// nothing more without queries. Throws std::invalid_argument for NaN, min > max, negative
  /// limits, and infinite numbers other than limits. If a query fails, only `results` changes.
  /// docs/embedding.md, Queries, says what they cost.

  /// Ascending by body.
  void overlapping(std::span<const BoxQuery> queries, QueryResults<std::uint32_t>& results);
  /// No hit is missed, and what misses within rounding, by a 2^-49th of the fraction, is a hit.
  void cast(std::span<const Cast> casts, Hits hits, QueryResults<CastHit>& results);
  /// Ascending by squared distance, as computed in doubles, then body. Fewer than wanted if the
  /// world has no more.
  void nearest(std::span<const NearestQuery> queries, QueryResults<Neighbour>& results);

  /// The number of boxes in the last update or restore(), of absent bodies, too. Not during another
  /// call, which this one does not notice.
  [[nodiscard]] std::size_t size() const;

  /// The state after the last update, as bytes: equal states give equal bytes, if the answer is
  /// sorted. Reuses the memory of `state`. Takes 24 bytes a body, 16 for each id up to the highest
  /// with a filter, 8 for each event, and a header. Throws std::logic_error between setFilter() and
  /// update().
  void save(std::vector<std::byte>& state) const;
  /// Back to a saved state, of this or another object with the same answer, margin and layers: the
  /// answer is the saved one, the next update's events are relative to it. Filters become the saved
  /// ones. Costs as much as an update from the present boxes to the saved ones, with other filters
  /// as much as the first one, and is a valid update of a failed object. Throws
  /// std::invalid_argument for anything else than such bytes, which changes nothing.
  void restore(std::span<const std::byte> state);

 private:
  class Implementation;
  [[nodiscard]] Implementation& implementation() const;

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace broadmark::broadphase
