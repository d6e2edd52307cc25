// Conveyor: belts carry bodies through the world at different speeds and cross each other. A body
// that reaches the end of its belt is put back to the start: broad phases that rely on small moves
// meet teleports in every frame.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scenes/course.h"
#include "scenes/scene.h"

namespace broadmark::scenes::conveyor {
namespace {

class Conveyor final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.01;
    settings.initial_speed = 0.5;
    settings.gravity = 0;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"belts", "number of belts, four on each level, each faster than the one before", &belts_,
           1, 1000});
    visit({"belt_width", "edge of a belt's square cross-section, in sides of the world",
           &belt_width_, 0, 0.5});
    visit({"belt_distance", "distance of parallel belts, in sides of the world", &belt_distance_, 0,
           0.9});
  }

  void prepare(const Settings&, Random&) override { riders_.clear(); }

  BodyDescription body(std::size_t index, const Settings& settings, const ObjectType& type,
                       Random& random) override {
    BodyDescription body{.shape = type.shape(index, settings.scale, random), .mass = settings.mass};
    const float limit = farthestInside(body.shape, settings.side());
    const Course course = courseOn(static_cast<std::int64_t>(index) % belts_, settings, random);
    body.pose = course.poseAt(static_cast<float>(random.between(-limit, limit)));
    body.linear_velocity = course.velocityAt(body.pose.position);
    riders_.push_back({course, limit});
    return body;
  }

  void act(Stage& stage, std::uint32_t) override {
    for (std::size_t i = 0; i < riders_.size(); ++i) carry(*stage.bodies[i], riders_[i]);
  }

 private:
  struct Rider {
    Course course;
    float limit = 0;  ///< where the belt ends, on both sides of the origin
  };

  /// A line somewhere inside belt `belt`.
  [[nodiscard]] Course courseOn(std::int64_t belt, const Settings& settings, Random& random) const {
    const bool along_x = belt % 2 == 0;
    const bool forwards = belt % 4 < 2;
    const std::int64_t levels = (belts_ + 3) / 4;
    const double level = static_cast<double>(belt / 4) + 0.5;
    const double height = level / static_cast<double>(levels) - 0.5;
    const double aside = (forwards ? 0.5 : -0.5) * belt_distance_;
    const double share = static_cast<double>(belt + 1) / static_cast<double>(belts_);
    const double speed = settings.initial_speed * share * (forwards ? 1 : -1);

    const auto somewhereAt = [&](double middle) {
      const double half = belt_width_ / 2;
      return static_cast<float>(settings.side() * (middle + random.between(-half, half)));
    };
    Course course{.axis = along_x ? 0 : 2, .speed = static_cast<float>(speed * settings.side())};
    course.lane[1] = somewhereAt(height);
    course.lane[along_x ? 2 : 0] = somewhereAt(aside);
    return course;
  }

  static void carry(PhysicsBody& body, const Rider& rider) {
    const Course& course = rider.course;
    const float along = body.pose().position[course.axis];
    if (course.speed > 0 ? along > rider.limit : along < -rider.limit) {
      // As far behind the start as it went beyond the end: the stream stays even.
      const float again = along - std::copysign(2 * rider.limit, course.speed);
      body.setPose(course.poseAt(std::clamp(again, -rider.limit, rider.limit)));
    }
    body.setVelocity(course.velocityAt(body.pose().position), body.angularVelocity());
  }

  std::int64_t belts_ = 8;
  double belt_width_ = 0.1;
  double belt_distance_ = 0.44;
  std::vector<Rider> riders_;  ///< by body
};

}  // namespace

SceneEntry entry() {
  return {.listing = {"conveyor", "Conveyor",
                      "crossing streams of bodies that start anew at the end of their belts"},
          .create = []() -> std::unique_ptr<Scene> { return std::make_unique<Conveyor>(); }};
}

}  // namespace broadmark::scenes::conveyor
