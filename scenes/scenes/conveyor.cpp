// Conveyor: belts carry bodies through the world at different speeds and cross each other. A body
// at the end of its belt returns to the start, so broad phases that rely on small moves face large
// ones in every frame.
//
// The belts lie along the edges of a cube within the world and extend from wall to wall: four along
// each axis, three of which cross at each of the cube's corners.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"
#include "scenes/course.h"

namespace broadmark::scenes::conveyor {
namespace {

class Conveyor final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.004;
    settings.initial_speed = 0.5;
    settings.gravity = 0;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"belts", "number of belts, each faster than the one before", &belts_, 1, 12});
    visit({"belt_width", "edge of a belt's square cross-section, in sides of the world",
           &belt_width_, 0, 0.5});
    visit({"belt_distance", "distance between parallel belts, in sides of the world",
           &belt_distance_, 0, 0.9});
  }

  void prepare(const Settings&, Random&) override { riders_.clear(); }

  void place(std::size_t index, BodyDescription& body, const Settings& settings,
             Random& random) override {
    const Course course = courseOn(static_cast<std::int64_t>(index) % belts_, settings, random);
    // A body must not touch the wall in the frame in which it passes the end.
    const auto step = std::abs(course.speed) * static_cast<float>(settings.physics.time_step);
    const float limit = std::max(0.0F, farthestInside(body.shape, settings.side()) - step);
    body.pose = course.poseAt(static_cast<float>(random.between(-limit, limit)));
    body.linear_velocity = course.velocityAt(body.pose.position);
    riders_.push_back({course, limit});
  }

  void act(Stage& stage, std::uint32_t) override {
    for (std::size_t i = 0; i < riders_.size(); ++i) carry(*stage.bodies[i], riders_[i]);
  }

 private:
  struct Rider {
    Course course;
    float limit = 0;  ///< end of the belt, on both sides of the origin
  };

  /// A random line within belt `belt`.
  [[nodiscard]] Course courseOn(std::int64_t belt, const Settings& settings, Random& random) const {
    const auto axis = static_cast<int>(belt % 3);
    const std::int64_t corner = belt / 3;
    const double share = static_cast<double>(belt + 1) / static_cast<double>(belts_);
    const double speed = settings.initial_speed * settings.side() * share;
    Course course{.axis = axis, .speed = static_cast<float>(corner % 2 == 0 ? speed : -speed)};
    const auto across = [&](std::int64_t side) {
      const double middle = belt_distance_ * (static_cast<double>(side) - 0.5);
      const double half = belt_width_ / 2;
      return static_cast<float>(settings.side() * (middle + random.between(-half, half)));
    };
    course.lane[(axis + 1) % 3] = across(corner % 2);
    course.lane[(axis + 2) % 3] = across(corner / 2);
    return course;
  }

  static void carry(PhysicsBody& body, const Rider& rider) {
    const Course& course = rider.course;
    const float along = body.pose().position[course.axis];
    if (course.speed > 0 ? along > rider.limit : along < -rider.limit) {
      // Carries over the distance beyond the end, to keep the stream even.
      const float restart = along - std::copysign(2 * rider.limit, course.speed);
      body.setPose(course.poseAt(std::clamp(restart, -rider.limit, rider.limit)));
    }
    body.setVelocity(course.velocityAt(body.pose().position), body.angularVelocity());
  }

  std::int64_t belts_ = 12;
  double belt_width_ = 0.06;
  double belt_distance_ = 0.44;
  std::vector<Rider> riders_;  ///< by body
};

}  // namespace

SceneEntry entry() {
  return {{"conveyor", "Conveyor",
           "crossing streams of bodies that return to the start at the end of their belts"},
          makeEntry<Scene, Conveyor>};
}

}  // namespace broadmark::scenes::conveyor
