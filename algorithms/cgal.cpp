// CGAL's box intersection: streams a segment tree and a range tree, level by level, over the boxes
// in place, and scans small subproblems. O(n log³ n + k) time, O(n) space. Besides streaming, the
// library's only option is the cutoff for scans.
//
// No drawing: the trees exist only as recursion within the library's call.
//
// Paper: A. Zomorodian, H. Edelsbrunner, "Fast Software for Box Intersections", SCG 2000. Library:
// L. Kettner, A. Meyer, A. Zomorodian, "Intersecting Sequences of dD Iso-oriented Boxes", CGAL User
// and Reference Manual. That header is under the GPL, version 3 or later.

#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/error.h"

namespace broadmark::cgal {
namespace {

class Cgal final : public BoxBroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"cutoff", "size of a subproblem, in boxes, below which it is scanned", &cutoff_, 1,
           1'000'000'000});
  }

  void updateStructures() override {
    boxes_.clear();
    for (const Aabb& box : boxes()) {
      // The library uses this as the end of each axis, and no segment contains it.
      if (*std::max_element(box.min.begin(), box.min.begin() + 3) == kEnd) {
        throw UnsupportedError("CGAL loses boxes whose lower bound is the largest float");
      }
      float min[] = {box.min[0], box.min[1], box.min[2]};
      float max[] = {box.max[0], box.max[1], box.max[2]};
      boxes_.emplace_back(min, max, &box);
    }
  }

 private:
  /// The library identifies boxes by the address of their handle.
  using Box = CGAL::Box_intersection_d::Box_with_handle_d<float, 3, const Aabb*>;
  static constexpr float kEnd = std::numeric_limits<float>::max();

  void findPairs() override {
    const auto report = [this](const Box& a, const Box& b) { pairs().add(body(a), body(b)); };
    CGAL::box_self_intersection_d(boxes_.begin(), boxes_.end(), report,
                                  static_cast<std::ptrdiff_t>(cutoff_),
                                  CGAL::Box_intersection_d::CLOSED);
  }

  [[nodiscard]] std::uint32_t body(const Box& box) const {
    return static_cast<std::uint32_t>(box.handle() - boxes().data());
  }

  std::vector<Box> boxes_;
  std::int64_t cutoff_ = 10;  ///< the library's default
};

}  // namespace

std::vector<Algorithm> variants() {
  return {{.id = "cgal",
           .family = "CGAL",
           .summary = "CGAL's box_self_intersection_d, from scratch every frame",
           .traits = {.library_allocates = true,
                      .changing_worlds = ChangingWorlds::compacted,
                      .instance_per_world = true},
           .description = {.principle = "tree",
                           .optimisations = "streamed in place, small subproblems scanned",
                           .time = "O(n log³ n + k)",
                           .space = "O(n + k)",
                           .source = "CGAL, Box_intersection_d; Zomorodian and Edelsbrunner 2000"},
           .create = [] { return std::make_unique<Cgal>(); }}};
}

}  // namespace broadmark::cgal
