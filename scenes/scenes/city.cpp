// City: buildings of very different sizes that never move, and a few bodies that drive and fly
// along the streets between them. It tests broad phases with large size ratios, persistent pairs
// (overlapping buildings) and hardly any motion.
//
// Blocks form a square grid with streets between them. A block is divided into four lots, each of
// these into four, and so on. Some lots are built on at each stage, so that large buildings stand
// among small ones. More bodies give a finer division of the same city.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"
#include "scenes/course.h"

namespace broadmark::scenes::city {
namespace {

/// A square of ground, in world units.
struct Lot {
  double x = 0;  ///< of its centre
  double z = 0;
  double edge = 0;
};

/// The shape scaled to `width`; the height of a box is also multiplied by `stretch`, within limits.
Shape fitted(const Shape& shape, double width, double stretch) {
  const auto* box = std::get_if<BoxShape>(&shape);
  if (box == nullptr) return SphereShape{static_cast<float>(width / 2)};
  const auto& [x, y, z] = box->half_extents;
  const double factor = width / (2 * std::max(x, z));
  const double half_height = std::clamp(factor * stretch * y, 0.02 * width, 2.0 * width);
  return BoxShape{{static_cast<float>(factor * x), static_cast<float>(half_height),
                   static_cast<float>(factor * z)}};
}

class City final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.001;
    settings.initial_speed = 0.15;
    settings.gravity = 0;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"movers", "share of the bodies that drive or fly", &movers_, 0, 1});
    visit({"fliers", "share of the movers that fly", &fliers_, 0, 1});
    visit({"blocks", "number of blocks along each side of the city", &blocks_, 1, 100});
    visit({"street_width", "width of the streets, in blocks", &street_width_, 0, 0.9});
    visit({"large", "share of the lots that are not divided further, at each stage", &large_, 0,
           0.5});
    visit({"crowding", "largest width of a building, in widths of its lot", &crowding_, 0.1, 2});
  }

  void prepare(const Settings& settings, Random& random) override {
    const auto count = static_cast<std::size_t>(settings.objects);
    const auto moving =
        static_cast<std::size_t>(std::ceil(movers_ * static_cast<double>(count) - 1e-9));
    types_.assign(count, BodyType::building);
    std::fill_n(types_.begin(), moving, BodyType::mover);
    random.shuffle(types_);  // ids must be independent of the type
    lots_ = buildingLots(count - moving, settings.side(), random);
    drivers_.clear();
  }

  void place(std::size_t index, BodyDescription& body, const Settings& settings,
             Random& random) override {
    if (types_[index] == BodyType::mover) {
      placeMover(index, body, settings, random);
    } else {
      placeBuilding(body, settings, random);
    }
  }

  void start(Stage& stage) override {
    Scene::start(stage);
    for (std::size_t i = 0; i < types_.size(); ++i) {
      if (types_[i] == BodyType::building) stage.bodies[i]->freeze();
    }
  }

  void act(Stage& stage, std::uint32_t) override {
    for (Driver& driver : drivers_) drive(*stage.bodies[driver.id], driver);
  }

 private:
  enum class BodyType : std::uint8_t { building, mover };

  struct Driver {
    std::size_t id = 0;
    Course course;
    float limit = 0;          ///< end of the street, on both sides of the origin
    float to_other_lane = 0;  ///< across the street
  };

  /// One lot per building, in random order.
  [[nodiscard]] std::vector<Lot> buildingLots(std::size_t count, double side,
                                              Random& random) const {
    std::deque<Lot> open;
    const double pitch = side / static_cast<double>(blocks_);
    for (std::int64_t i = 0; i < blocks_; ++i) {
      for (std::int64_t k = 0; k < blocks_; ++k) {
        open.push_back({(static_cast<double>(i) + 0.5) * pitch - side / 2,
                        (static_cast<double>(k) + 0.5) * pitch - side / 2,
                        pitch * (1 - street_width_)});
      }
    }
    std::vector<Lot> closed;
    while (open.size() + closed.size() < count) {
      const Lot lot = open.front();
      open.pop_front();
      if (!open.empty() && random.uniform() < large_) {
        closed.push_back(lot);
        continue;
      }
      const double quarter = lot.edge / 4;
      for (const double x : {-quarter, quarter}) {
        for (const double z : {-quarter, quarter}) {
          open.push_back({lot.x + x, lot.z + z, lot.edge / 2});
        }
      }
    }
    closed.insert(closed.end(), open.begin(), open.end());
    random.shuffle(closed);
    closed.resize(count);  // the others stay empty
    return closed;
  }

  void placeBuilding(BodyDescription& body, const Settings& settings, Random& random) {
    const Lot lot = lots_.back();
    lots_.pop_back();
    const double width_in_lot = lot.edge * random.between(std::min(0.6, crowding_), crowding_);
    const double width =
        std::min(width_in_lot, lot.edge + 0.2 * street(settings));  // the lanes stay free
    const double stretch = 0.4 + 3 * std::pow(random.uniform(), 2);
    body.shape = fitted(body.shape, width, stretch);
    body.pose.position = {static_cast<float>(lot.x), onGround(body.shape, settings),
                          static_cast<float>(lot.z)};
  }

  void placeMover(std::size_t index, BodyDescription& body, const Settings& settings,
                  Random& random) {
    const double side = settings.side();
    body.shape = fitted(body.shape, 0.25 * street(settings), 1);
    const float limit = farthestInside(body.shape, side);
    const auto random_coordinate = [&] {
      return static_cast<float>(random.between(-limit, limit));
    };

    Driver driver{.id = index, .limit = limit};
    Course& course = driver.course;
    course.axis = random.uniform() < 0.5 ? 0 : 2;
    const double direction = random.uniform() < 0.5 ? 1 : -1;
    const double speed = settings.initial_speed * side * random.between(0.3, 1);
    course.speed = static_cast<float>(direction * speed);
    course.lane[1] = onGround(body.shape, settings);
    if (random.uniform() < fliers_) course.lane[1] = static_cast<float>(random.between(-limit, 0));

    // Movers keep to the right and turn at the end of the street.
    double middle = 1;  // of the street, across the city; around a single block it is the edge
    if (blocks_ > 1) {
      const auto streets = static_cast<double>(blocks_ - 1);
      middle = (1 + std::floor(random.uniform() * streets)) / static_cast<double>(blocks_);
      driver.to_other_lane =
          static_cast<float>((course.axis == 0 ? -0.5 : 0.5) * direction * street(settings));
    }
    course.lane[2 - course.axis] = std::clamp(
        static_cast<float>((middle - 0.5) * side) - driver.to_other_lane / 2, -limit, limit);

    body.pose = course.poseAt(random_coordinate());
    body.linear_velocity = course.velocityAt(body.pose.position);
    drivers_.push_back(driver);
  }

  static void drive(PhysicsBody& body, Driver& driver) {
    Course& course = driver.course;
    const Vec3 position = body.pose().position;
    if (std::copysign(1.0F, course.speed) * position[course.axis] >= driver.limit) {
      course.speed = -course.speed;
      float& lane = course.lane[2 - course.axis];
      lane = std::clamp(lane + driver.to_other_lane, -driver.limit, driver.limit);
      driver.to_other_lane = -driver.to_other_lane;
    }
    body.setVelocity(course.velocityAt(position), body.angularVelocity());
  }

  /// The width of a street, in world units.
  [[nodiscard]] double street(const Settings& settings) const {
    return street_width_ * settings.side() / static_cast<double>(blocks_);
  }

  /// The height of the centre of a body on the ground.
  static float onGround(const Shape& shape, const Settings& settings) {
    return tightBox(shape, {}).max[1] - static_cast<float>(settings.side() / 2);
  }

  double movers_ = 0.02;
  double fliers_ = 0.5;
  std::int64_t blocks_ = 8;
  double street_width_ = 0.2;
  double large_ = 0.12;
  double crowding_ = 1.1;
  std::vector<BodyType> types_;  ///< by body
  std::vector<Lot> lots_;        ///< still without a building
  std::vector<Driver> drivers_;  ///< the movers
};

}  // namespace

SceneEntry entry() {
  return {{"city", "City", "buildings of all sizes that never move, and traffic in the streets"},
          makeEntry<Scene, City>};
}

}  // namespace broadmark::scenes::city
