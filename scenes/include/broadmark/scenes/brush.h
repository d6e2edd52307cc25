// Brushes: ways to place many bodies at once. One implementation per file, listed in
// CMakeLists.txt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadmark/parameters.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/random.h"

namespace broadmark::scenes {

/// Says where bodies go, around the point that is painted at. Its parameters are those that only it
/// has; lengths are in world units.
class Brush : public Parametrised {
 public:
  /// How many bodies it places, if one is this large: the volume of a cube around it.
  [[nodiscard]] virtual double count(double body_volume) const = 0;
  /// Where body `index` goes, seen from the point that is painted at.
  [[nodiscard]] virtual Vec3 place(std::size_t index, Random&) const = 0;
  /// Whether asking again gives another place.
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

/// What all brushes paint with.
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

/// What one touch of a brush gives.
struct Stroke {
  std::vector<AuthoredBody> bodies;
  std::size_t left_out = 0;  ///< bodies for which there was no room
};

/// Bodies painted at a point. Unless the paint allows overlaps, none is placed where its tight box
/// would overlap that of another or of one of `present`, by more than a touch: a brush that
/// scatters then tries elsewhere, the others leave the body out. The same arguments give the same
/// bodies. O(present + placed). Throws InputError when the brush asks for more bodies than a scene
/// may hold.
Stroke paint(const Brush&, const Paint&, const Vec3& at, std::span<const AuthoredBody> present);

}  // namespace broadmark::scenes
