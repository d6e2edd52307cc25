// Brushes place many bodies at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "broadmark/parameters.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/random.h"

namespace broadmark::scenes {

/// Determines the number of bodies, and their positions relative to a point. Visits only the
/// parameters of this brush. Lengths are in world units.
class Brush : public Parametrised {
 public:
  /// The number of bodies, for bodies of this volume (scale³).
  [[nodiscard]] virtual double count(double body_volume) const = 0;
  /// The position of body `index`, relative to the point.
  [[nodiscard]] virtual Vec3 place(std::size_t index, Random&) const = 0;
  /// Whether place() is random, so that another call yields another position.
  [[nodiscard]] virtual bool scatters() const { return false; }
};

struct BrushEntry {
  struct {
    std::string id;       ///< "ball"
    std::string summary;  ///< half a sentence
  } listing;
  std::unique_ptr<Brush> (*create)();
};

std::vector<BrushEntry> brushEntries();

/// The properties of the bodies: the same for all brushes.
class Paint final : public Parametrised {
 public:
  Paint();
  void visitParameters(const ParameterVisitor&) override;

  Choice object_type;  ///< "cubes", "spheres", "assorted", …
  double scale = 1;
  double mass = 1;
  bool frozen = false;
  bool overlap = false;
  std::int64_t seed = 1;
};

/// The result of one use of a brush.
struct Stroke {
  std::vector<AuthoredBody> bodies;
  std::size_t left_out = 0;  ///< bodies without room
};

/// The space occupied by bodies: their tight boxes. Uses a hash grid for
/// each power of two of box sizes, so that neither a floor under thousands of small bodies nor dust
/// among large bodies crowds a cell: O(1) per body unless sizes differ by orders of magnitude, and
/// never more than a comparison with every box.
class OccupiedSpace {
 public:
  explicit OccupiedSpace(std::span<const AuthoredBody> bodies = {});

  void add(const AuthoredBody&);
  /// Whether its tight box, shrunk on every side by `tolerance` times its size, overlaps any.
  [[nodiscard]] bool overlaps(const AuthoredBody&, float tolerance) const;

 private:
  /// Boxes by a hash of their lower corner's cell; hashes may collide.
  using Grid = std::unordered_map<std::uint64_t, std::vector<Aabb>>;

  static bool overlapsIn(const Grid& grid, int exponent, const Aabb& box);

  /// By the exponent of the smallest power of two above all edges of the boxes; cells are twice as
  /// large.
  std::map<int, Grid> grids_;
};

/// Places up to `max_bodies` bodies around the point `at`. Unless the paint allows overlaps, no
/// tight box overlaps another placed body's, or `occupied`, but for rounding where a brush places
/// bodies side by side: a scattering brush tries other positions, and omits a body without room.
/// Deterministic. O(placed). Throws InputError if the brush would place more than kMaxBodies.
Stroke paint(const Brush&, const Paint&, const Vec3& at, const OccupiedSpace& occupied,
             std::size_t max_bodies = std::numeric_limits<std::size_t>::max());
/// Places bodies among the `present` bodies. O(present + placed).
Stroke paint(const Brush&, const Paint&, const Vec3& at, std::span<const AuthoredBody> present);

}  // namespace broadmark::scenes
