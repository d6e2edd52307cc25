// Options for reading the files of a source.
#pragma once

#include <functional>
#include <string>

#include "broadmark/error.h"
#include "broadmark/parameters.h"
#include "broadmark/recordings/periodic_frames.h"
#include "broadmark/recordings/widened_frames.h"

namespace broadmark {

/// Each is a command line option; results state those that are not at their defaults.
struct ReadingOptions : Parametrised {
  bool swept = false;
  double widen = 0;
  std::string periodic;
  Choice body_order{"given", {"given", "random", "morton"}};
  Choice format{"auto", {"auto", "csv", "xyz", "lammps", "ply", "obj", "stl", "gltf", "numpy"}};
  bool strict = false;
  Choice elements{"triangles", {"vertices", "edges", "triangles", "all"}};
  Choice keep{"none", {"none", "shared-vertices"}};
  double radius = 0;
  double frame_rate = 30;
  std::string animation;
  /// Called while imported files are read, with the completed fraction; returns false to cancel.
  /// No option.
  std::function<bool(double fraction)> progress = {};

  /// Calls `progress`. Throws Cancelled.
  void report(double fraction) const {
    if (progress && !progress(fraction)) throw Cancelled();
  }

  void visitParameters(const ParameterVisitor& visit) override {
    constexpr double kMaxRadius = 1e30;
    constexpr double kMaxRate = 1e6;
    visit({"swept",
           "extend each box to contain that of the previous frame, too, rounded outward, as for "
           "continuous collision detection",
           &swept});
    visit({"widen",
           "grow each box by half of this distance on every side, rounded outward: bodies no "
           "farther apart than this distance on every axis are pairs",
           &widen, 0, kMaxWidening});
    visit({"periodic",
           "also report pairs across the boundaries of a periodic box: the one that the source "
           "states, or as in =0:10,0:10,- (LOW:HIGH along x, y and z; - where it is not periodic)",
           &periodic});
    visit({"body_order",
           "number the bodies in another order: at random, or along a Morton curve through the "
           "initial pose",
           &body_order});
    visit(
        {"format", "imported files: their format, instead of recognising it by content", &format});
    visit({"strict", "imported files: fail if anything in them would be left out", &strict});
    visit({"elements", "meshes: the elements that become boxes", &elements});
    visit({"keep", "meshes: also report pairs of elements that share a vertex", &keep});
    visit({"radius", "particles: radius; 0: as stated in the file", &radius, 0, kMaxRadius});
    visit({"frame_rate", "animations: frames per second", &frame_rate, 1e-6, kMaxRate});
    visit({"animation", "glTF: name or number of the only animation to play; empty: all at once",
           &animation});
  }

  /// Options that are not at their defaults.
  [[nodiscard]] ParameterValues changed() {
    ReadingOptions defaults;
    return changedValues(parameterValues(*this), defaults);
  }
};

/// Command line option of a parameter: "--frame-rate".
std::string parameterOption(std::string parameter);

}  // namespace broadmark
