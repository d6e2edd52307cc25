// How a source's file is read, where there is more than one way.
#pragma once

#include <string>

#include "broadmark/parameters.h"

namespace broadmark {

/// Each is an option of the command line and, unless it has its default, stands in results.
struct ReadingOptions : Parametrised {
  bool swept = false;
  Choice elements{"triangles", {"vertices", "edges", "triangles", "all"}};
  Choice keep{"none", {"none", "shared-vertices"}};
  double radius = 0;
  double frame_rate = 30;

  void visitParameters(const ParameterVisitor& visit) override {
    constexpr double kMaxRadius = 1e30;
    constexpr double kMaxRate = 1e6;
    visit({"swept",
           "boxes that also hold those of the frame before, rounded outward, as continuous "
           "collision detection takes them",
           &swept});
    visit({"elements", "of meshes: what gets a box", &elements});
    visit(
        {"keep", "of meshes: pairs that are wanted, too: of elements that share a vertex", &keep});
    visit({"radius", "of particles; 0: as the file says", &radius, 0, kMaxRadius});
    visit({"frame_rate", "of animations: frames a second", &frame_rate, 1e-6, kMaxRate});
  }

  /// Those that do not have their defaults.
  [[nodiscard]] ParameterValues stated() {
    ReadingOptions fresh;
    return changedValues(parameterValues(*this), fresh);
  }
};

/// "--frame-rate"
std::string parameterOption(std::string parameter);

}  // namespace broadmark
