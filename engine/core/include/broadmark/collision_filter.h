// Collision filters: the wanted pairs of bodies, independent of positions.
//
// Example:
//
//   std::vector<BodyGroups> bodies(3);
//   bodies[2].layer = 1;  // a sensor, say: bodies collide with it, sensors do not with each other
//   const LayerMatrix collide = LayerMatrix().set(0, 0).set(0, 1);
//   const CollisionFilter filter(bodies, collide);
//   const bool wanted = filter.wanted(0, 2);
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

/// The symmetric matrix of colliding layers: bit b of row a.
class LayerMatrix {
 public:
  static constexpr std::size_t kLayers = 32;  ///< layers are numbered from 0

  /// No layers collide.
  constexpr LayerMatrix() = default;
  /// All layers collide, with themselves, too.
  static LayerMatrix all();

  /// Sets whether two layers, both below kLayers, collide, or one with itself. Returns the matrix.
  LayerMatrix& set(std::size_t a, std::size_t b, bool collide = true);
  /// Whether two layers, both below kLayers, collide.
  [[nodiscard]] bool collide(std::size_t a, std::size_t b) const {
    return (rows_[a] >> b & 1) != 0;
  }
  /// Bit b of row a is set if layers a and b collide.
  [[nodiscard]] const std::array<std::uint32_t, kLayers>& rows() const { return rows_; }

  friend bool operator==(const LayerMatrix&, const LayerMatrix&) = default;

 private:
  std::array<std::uint32_t, kLayers> rows_{};
};

/// A body's layer, world and tags. The world does not change during a run.
struct BodyGroups {
  /// An unused tag, which is shared with no body.
  static constexpr std::uint32_t kNoTag = std::numeric_limits<std::uint32_t>::max();
  using Tags = std::array<std::uint32_t, 3>;
  static constexpr Tags kNoTags = {kNoTag, kNoTag, kNoTag};

  std::uint8_t layer = 0;   ///< below LayerMatrix::kLayers
  std::uint32_t world = 0;  ///< only bodies of the same world collide
  Tags tags = kNoTags;      ///< bodies that share a tag do not collide: a mesh's vertex, a ragdoll

  friend bool operator==(const BodyGroups&, const BodyGroups&) = default;
};

/// The predicate wanted(a, b) over all bodies of a scene, by id. By default all pairs are wanted,
/// of any number of bodies. Cheap to copy: copies share their data, which are immutable except for
/// a LiveFilter's. Ids are not checked.
class CollisionFilter {
 public:
  /// All pairs are wanted.
  CollisionFilter() = default;
  /// `bodies`: the groups of each body, by id. `changes`: layers may change, so all of the matrix
  /// counts, also if all bodies are in layer 0 now. Throws std::invalid_argument for a nonexistent
  /// layer. O(bodies).
  CollisionFilter(std::span<const BodyGroups> bodies, const LayerMatrix& matrix,
                  bool changes = false);

  /// Whether an overlap of these two bodies counts; symmetric, a != b. O(1).
  [[nodiscard]] bool wanted(std::uint32_t a, std::uint32_t b) const {
    return data_ == nullptr || data_->wanted(a, b);
  }
  /// Keeps the wanted pairs and the invalid ones (a >= b, or without such a body), in order, at the
  /// front, and returns their number. Half the time of wanted() for each pair.
  std::size_t retainWanted(std::span<Pair> pairs) const;
  /// Sufficient condition for all pairs to be wanted, at any time: false for every LiveFilter.
  /// O(1).
  [[nodiscard]] bool wantsAll() const { return data_ == nullptr; }

  /// The layer of a body of the scene.
  [[nodiscard]] std::size_t layerOf(std::uint32_t body) const {
    return data_ == nullptr || data_->layers.empty() ? 0 : data_->layers[body];
  }
  /// The groups of a body of the scene.
  [[nodiscard]] BodyGroups groupsOf(std::uint32_t body) const;
  /// The layers that collide; by default only layer 0 with itself, as all bodies are in it.
  [[nodiscard]] LayerMatrix matrix() const;
  /// One entry per body; empty if all bodies have the default value. Valid as long as the filter or
  /// a copy of it.
  [[nodiscard]] std::span<const std::uint8_t> layers() const;
  [[nodiscard]] std::span<const std::uint32_t> worlds() const;
  [[nodiscard]] std::span<const BodyGroups::Tags> tags() const;

  /// The filter of a subset of the bodies, which are renumbered in this order; a body may occur
  /// several times. O(bodies).
  [[nodiscard]] CollisionFilter of(std::span<const std::uint32_t> bodies) const;
  /// This filter of `count` bodies, with new layers and tags for some of them: `groups`, in the
  /// order of `changed`. Worlds and matrix remain. `count` is the number of bodies of this filter.
  /// Throws std::invalid_argument for a nonexistent layer. O(count).
  [[nodiscard]] CollisionFilter with(std::span<const std::uint32_t> changed,
                                     std::span<const BodyGroups> groups, std::size_t count) const;
  /// The same, with the layers and tags that these bodies have in `source`.
  [[nodiscard]] CollisionFilter with(std::span<const std::uint32_t> changed,
                                     const CollisionFilter& source, std::size_t count) const;

  /// Whether groups and matrix are equal; false if only one of the two wantsAll(). O(bodies),
  /// unless both share their data.
  friend bool operator==(const CollisionFilter& a, const CollisionFilter& b);

 private:
  friend class LiveFilter;

  /// A body's tags, padded with kNoTag.
  using TagVector [[gnu::vector_size(16)]] = std::uint32_t;
  static TagVector toVector(const BodyGroups::Tags& tags) {
    const TagVector vector = {tags[0], tags[1], tags[2], BodyGroups::kNoTag};
    return vector;
  }

  struct Data {
    std::size_t bodies = 0;
    bool changes = false;
    LayerMatrix matrix;
    std::vector<std::uint8_t> layers;
    std::vector<std::uint32_t> worlds;
    std::vector<BodyGroups::Tags> tags;
    std::vector<TagVector> tag_vectors;  ///< the same, for comparisons

    [[nodiscard]] bool wanted(std::uint32_t a, std::uint32_t b) const {
      const std::size_t layer_a = layers.empty() ? 0 : layers[a];
      const std::size_t layer_b = layers.empty() ? 0 : layers[b];
      if (!matrix.collide(layer_a, layer_b)) return false;
      if (!worlds.empty() && worlds[a] != worlds[b]) return false;
      return tag_vectors.empty() || !shareTag(tag_vectors[a], tag_vectors[b]);
    }
  };

  /// Compares each tag with each, without branches.
  static bool shareTag(TagVector a, TagVector b) {
    const TagVector b1 = __builtin_shufflevector(b, b, 1, 2, 0, 3);
    const TagVector b2 = __builtin_shufflevector(b, b, 2, 0, 1, 3);
    const auto equal = ((a == b) | (a == b1) | (a == b2)) & (a != BodyGroups::kNoTag);
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(equal);
    return (halves[0] | halves[1]) != 0;
  }

  std::shared_ptr<const Data> data_;  ///< null: every pair is wanted
};

/// A filter with layers and tags that change: all copies of filter() follow, and may outlive it.
/// Not synchronised: no other thread may use a copy during update().
class LiveFilter {
 public:
  /// Of `bodies` bodies, with their groups in `first`, and its matrix. O(bodies).
  LiveFilter(const CollisionFilter& first, std::size_t bodies);

  /// A copy that follows. Never CollisionFilter::wantsAll().
  [[nodiscard]] CollisionFilter filter() const;
  /// Gives a body the layer and the tags that it has in `source`. O(1); allocates nothing.
  void update(std::uint32_t body, const CollisionFilter& source);

 private:
  std::shared_ptr<CollisionFilter::Data> data_;
};

}  // namespace broadmark
