// Brushes place many bodies at once. One implementation per file, listed in CMakeLists.txt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadmark/parameters.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/random.h"

namespace broadmark::scenes {

class Occupied;  // private to the sources

/// Says how many bodies go where, relative to a point. Visits the parameters that only this brush
/// has. Lengths are in world units.
class Brush : public Parametrised {
 public:
  /// The number of bodies, for bodies of this volume (scale³).
  [[nodiscard]] virtual double count(double body_volume) const = 0;
  /// The place of body `index`, relative to the point.
  [[nodiscard]] virtual Vec3 place(std::size_t index, Random&) const = 0;
  /// Whether place() is random, so that calling it again gives another place.
  [[nodiscard]] virtual bool scatters() const { return false; }
};

struct BrushEntry {
  struct {
    std::string id;       ///< "ball"
    std::string summary;  ///< half a sentence
  } listing;
  std::unique_ptr<Brush> (*create)();
};

/// All of them, in the order of the list in CMakeLists.txt.
std::vector<BrushEntry> brushEntries();

/// What the bodies are like: the same for all brushes.
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

/// The bodies of one use of a brush.
struct Stroke {
  std::vector<AuthoredBody> bodies;
  std::size_t left_out = 0;  ///< bodies without room
};

/// The room that bodies take: their tight boxes, but for a touch.
class TakenRoom {
 public:
  explicit TakenRoom(std::span<const AuthoredBody> bodies = {});
  ~TakenRoom();
  TakenRoom(TakenRoom&&) noexcept;
  TakenRoom& operator=(TakenRoom&&) noexcept;

  void add(const AuthoredBody&);
  [[nodiscard]] bool overlaps(const AuthoredBody&) const;

 private:
  std::unique_ptr<Occupied> boxes_;
};

/// Bodies placed around the point `at`, `most` of them or fewer. Unless the paint allows overlaps,
/// no tight box overlaps that of another placed body or `taken` by more than a touch: a brush that
/// scatters tries other places, and a body without room is left out. The same arguments give the
/// same bodies. O(placed). Throws InputError when the brush would place more than kMostBodies.
Stroke paint(const Brush&, const Paint&, const Vec3& at, const TakenRoom& taken,
             std::size_t most = std::numeric_limits<std::size_t>::max());
/// The same among the bodies that are `present`. O(present + placed).
Stroke paint(const Brush&, const Paint&, const Vec3& at, std::span<const AuthoredBody> present);

}  // namespace broadmark::scenes
