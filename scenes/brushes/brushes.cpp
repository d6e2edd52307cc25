// The brushes: the number of bodies they place, and the positions.

#include <array>

#include "broadmark/scenes/brush.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

class SingleBrush final : public Brush {
 public:
  [[nodiscard]] double count(double) const override { return 1; }
  [[nodiscard]] Vec3 place(std::size_t, Random&) const override { return {}; }
};

/// A brush with the number of bodies as a parameter.
template <std::int64_t default_count>
class CountedBrush : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"count", "number of bodies", &count_, 1, kMaxBodies});
  }
  [[nodiscard]] double count(double) const override { return static_cast<double>(count_); }

 private:
  std::int64_t count_ = default_count;
};

class BallBrush final : public CountedBrush<100> {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    CountedBrush::visitParameters(visit);
    visit({"radius", "radius of the ball, in world units", &radius_, 1e-3, 1e6});
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return random.inBall(radius_);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  double radius_ = 5;
};

using Size = std::array<double, 3>;  ///< of a box around the painted point
constexpr Size kDefaultSize = {10, 10, 10};

void visitSize(Size& size, const ParameterVisitor& visit) {
  visit({"size_x", "size of the box along x, in world units", &size[0], 1e-3, 1e6});
  visit({"size_y", "size of the box along y, in world units", &size[1], 1e-3, 1e6});
  visit({"size_z", "size of the box along z, in world units", &size[2], 1e-3, 1e6});
}

/// A uniformly random point.
Vec3 pointInside(const Size& size, Random& random) {
  Vec3 point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = static_cast<float>(random.between(-size[axis] / 2, size[axis] / 2));
  }
  return point;
}

class BoxBrush final : public CountedBrush<100> {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    CountedBrush::visitParameters(visit);
    visitSize(size_, visit);
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return pointInside(size_, random);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  Size size_ = kDefaultSize;
};

/// Random bodies in a box, as many as its density requires.
class RandomBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"density",
           "share of the box's volume that bodies fill, each counted as a cube with edge 'scale'",
           &density_, 1e-6, 1});
    visitSize(size_, visit);
  }
  [[nodiscard]] double count(double body_volume) const override {
    return density_ * size_[0] * size_[1] * size_[2] / body_volume;
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return pointInside(size_, random);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  double density_ = 0.1;
  Size size_ = kDefaultSize;
};

class LineBrush final : public CountedBrush<10> {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    CountedBrush::visitParameters(visit);
    visit({"step_x", "distance from one body to the next along x, in world units", &step_[0], -1e6,
           1e6});
    visit({"step_y", "distance from one body to the next along y, in world units", &step_[1], -1e6,
           1e6});
    visit({"step_z", "distance from one body to the next along z, in world units", &step_[2], -1e6,
           1e6});
  }
  [[nodiscard]] Vec3 place(std::size_t index, Random&) const override {
    Vec3 place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = static_cast<float>(static_cast<double>(index) * step_[axis]);
    }
    return place;
  }

 private:
  std::array<double, 3> step_ = {1, 0, 0};
};

class LatticeBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"count_x", "number of bodies along x", &count_[0], 1, 1'000'000});
    visit({"count_y", "number of bodies along y", &count_[1], 1, 1'000'000});
    visit({"count_z", "number of bodies along z", &count_[2], 1, 1'000'000});
    visit({"spacing", "distance between neighbours, in world units", &spacing_, 0, 1e6});
  }
  [[nodiscard]] double count(double) const override {
    return static_cast<double>(count_[0]) * static_cast<double>(count_[1]) *
           static_cast<double>(count_[2]);
  }
  [[nodiscard]] Vec3 place(std::size_t index, Random&) const override {
    Vec3 place;
    auto rest = static_cast<std::int64_t>(index);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto steps = static_cast<double>(rest % count_[axis]);
      rest /= count_[axis];
      place[axis] =
          static_cast<float>(spacing_ * (steps - static_cast<double>(count_[axis] - 1) / 2));
    }
    return place;
  }

 private:
  std::array<std::int64_t, 3> count_ = {5, 5, 5};
  double spacing_ = 2;
};

}  // namespace

std::vector<BrushEntry> brushEntries() {
  return {
      {{"single", "one body"}, makeEntry<Brush, SingleBrush>},
      {{"ball", "bodies at random in a ball"}, makeEntry<Brush, BallBrush>},
      {{"box", "bodies at random in a box"}, makeEntry<Brush, BoxBrush>},
      {{"line", "bodies in a row, starting at the point"}, makeEntry<Brush, LineBrush>},
      {{"lattice", "bodies in rows, columns and layers around the point"},
       makeEntry<Brush, LatticeBrush>},
      {{"random", "bodies at random in a box, up to a density"}, makeEntry<Brush, RandomBrush>}};
}

}  // namespace broadmark::scenes
