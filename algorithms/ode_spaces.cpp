// ODE's spaces. The hash space: grids of several resolutions in one hash table; a box is stored in
// the grid with cells just larger than it, and queries that and all coarser ones. The
// sweep-and-prune space: a sweep along one axis over radix-sorted boxes. Both repeat all of it
// every frame; they only cache the boxes, and query those that moved. Hash: O(n + k) time in
// theory, but pairs are marked in a table of n² bits, cleared every frame, and the hash of a cell
// is so simple (100 x + 10 y + z) that large worlds crowd the table. Sweep: O(n^5/3 + k) time for
// bodies spread evenly, O(n + k) space.
//
// Each body is a geom of a custom class, with the body's box as bounding box (manual, "User defined
// classes"). Setting the position marks a geom as moved. The levels of the hash space, its smallest
// and largest cells, are set for the boxes of each frame (dHashSpaceSetLevels): the smallest so
// that most boxes are in one grid, but not so small that cell indices overflow, which would end the
// program. The sweep uses the axis order recommended in the header, X, Z, Y.
//
// Debian's ODE works in double precision and only compares bounds; the sweep sorts them as the
// original floats. So the answers are exact.
//
// No drawing: the library exposes neither grids nor axes.
//
// Library: the Open Dynamics Engine, manual, "Collision Detection"; its sweep follows P. Terdiman's
// OPCODE.

#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/c_deleter.h"
#include "moved_boxes.h"
#include "variants.h"

namespace broadmark::ode_spaces {
namespace {

/// The hash space indexes the bits of its table of pairs, a row of whole bytes for each body, by
/// int.
constexpr std::uint64_t kMaxHashedObjects = 131'071;

/// The data of a geom of this class.
struct GeomData {
  const std::vector<Aabb>* boxes;
  std::uint32_t body;
};

const GeomData& dataOf(dGeomID geom) { return *static_cast<GeomData*>(dGeomGetClassData(geom)); }

void giveBounds(dGeomID geom, dReal bounds[6]) {
  const GeomData& data = dataOf(geom);
  const Aabb& box = (*data.boxes)[data.body];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bounds[2 * axis] = box.min[axis];
    bounds[2 * axis + 1] = box.max[axis];
  }
}

/// The class of the bodies' geoms. Initialises the library and registers the class, once per
/// process.
int geomClass() {
  static const int number = [] {
    dInitODE2(0);
    const dGeomClass with_bounds = {.bytes = sizeof(GeomData),
                                    .collider = [](int) -> dColliderFn* { return nullptr; },
                                    .aabb = giveBounds,
                                    .aabb_test = nullptr,
                                    .dtor = nullptr};
    return dCreateGeomClass(&with_bounds);
  }();
  return number;
}

class OdeSpace : public MovedBoxes {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    MovedBoxes::initialize(scene, first, execution);
    geomClass();  // before any other call of the library
    space_.reset(makeSpace());
    for (std::uint32_t body = 0; body < boxes().size(); ++body) add();
    prepare(*space_);
    dSpaceClean(space_.get());
  }

  void updateStructures() override {
    for (; geoms_.size() > boxes().size(); geoms_.pop_back()) dGeomDestroy(geoms_.back());
    for (const std::uint32_t body : moved()) {
      if (body < geoms_.size()) {
        dGeomSetPosition(geoms_[body], boxes()[body].min[0], boxes()[body].min[1],
                         boxes()[body].min[2]);
      } else {
        add();
      }
    }
    if (!moved().empty()) prepare(*space_);
    dSpaceClean(space_.get());
  }

 private:
  virtual dxSpace* makeSpace() = 0;
  /// Called when boxes have changed.
  virtual void prepare(dxSpace& /*space*/) {}

  void add() {
    dxGeom* const geom = dCreateGeom(geomClass());
    *static_cast<GeomData*>(dGeomGetClassData(geom)) = {&boxes(),
                                                        static_cast<std::uint32_t>(geoms_.size())};
    geoms_.push_back(geom);
    dSpaceAdd(space_.get(), geom);
  }

  void findPairs() override { dSpaceCollide(space_.get(), this, report); }
  static void report(void* self, dGeomID a, dGeomID b) {
    static_cast<OdeSpace*>(self)->pairs().add(dataOf(a).body, dataOf(b).body);
  }

  std::unique_ptr<dxSpace, CDeleter<dSpaceDestroy>> space_;  ///< and its geoms
  std::vector<dxGeom*> geoms_;                               ///< by body
};

class Hash final : public OdeSpace {
  dxSpace* makeSpace() override { return dHashSpaceCreate(nullptr); }

  void prepare(dxSpace& space) override {
    if (boxes().empty()) return;
    double edges = 0;
    double longest = 0;
    double farthest = 0;
    for (const Aabb& box : boxes()) {
      const double edge = longestEdge(box);
      for (int axis = 0; axis < 3; ++axis) {
        farthest = std::max<double>({farthest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
      }
      edges += edge;
      longest = std::max(longest, edge);
    }
    constexpr double kMeanEdges = 2;  // faster than 1 or 4, as measured
    constexpr int kBitsOfCell = 30;
    const int smallest = std::max(levelOf(kMeanEdges * edges / static_cast<double>(boxes().size())),
                                  levelOf(farthest) - kBitsOfCell);
    dHashSpaceSetLevels(&space, smallest, std::max(smallest, levelOf(longest)));
  }

  /// Cells of 2 to this power are just larger than a box of this size.
  static int levelOf(double edge) {
    int level = 0;
    std::frexp(edge, &level);
    return level;
  }
};

class Sap final : public OdeSpace {
  dxSpace* makeSpace() override { return dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY); }
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {.family = "ODE",
                            .traits = {.library_allocates = true,
                                       .library_aborts = true,
                                       .changing_worlds = ChangingWorlds::compacted,
                                       .instance_per_world = true}};
  Algorithm hash =
      variantOf<Hash>(family, "ode-hash", "ODE's hash space, grids of several resolutions");
  hash.traits.max_objects = kMaxHashedObjects;
  hash.description = {.principle = "grid",
                      .optimisations = "several resolutions in a hash table",
                      .time = "O(n² + k), n² for clearing bits",
                      .space = "O(n² + k)",
                      .source = "ODE, dHashSpace"};
  Algorithm sap =
      variantOf<Sap>(family, "ode-sap", "ODE's sweep-and-prune space, radix-sorted every frame");
  sap.description = {.principle = "sorting",
                     .optimisations = "radix sort",
                     .time = "O(n² + k), O(n^5/3 + k) if spread evenly",
                     .space = "O(n + k)",
                     .source = "ODE, dSweepAndPruneSpace; Terdiman, OPCODE"};
  return {hash, sap};
}

}  // namespace broadmark::ode_spaces
