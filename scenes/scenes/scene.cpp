#include "broadmark/scenes/scene.h"

#include "scenes/course.h"

namespace broadmark::scenes {

BodyDescription Stage::describeBody(std::size_t id, double size) const {
  return {.shape = object_type.shape(id, size * settings.scale, random), .mass = settings.mass};
}

BodyDescription Stage::describeAnywhere(std::size_t id, double size) const {
  BodyDescription body = describeBody(id, size);
  const double reach = farthestInside(body.shape, settings.side());
  for (float& coordinate : body.pose.position) {
    coordinate = static_cast<float>(random.between(-reach, reach));
  }
  return body;
}

void Scene::place(std::size_t, BodyDescription& body, const Settings& settings, Random& random) {
  body.pose.position = random.inBall(settings.initial_radius * settings.side());
  body.linear_velocity = launchVelocity(settings, random);
}

void Scene::populate(Stage& stage) {
  for (std::size_t i = 0; i < stage.bodies.size(); ++i) {
    BodyDescription body = stage.describeBody(i);
    place(i, body, stage.settings, stage.random);
    stage.bodies.add(i, body);
  }
}

void Scene::start(Stage& stage) {
  const Settings& settings = stage.settings;
  stage.engine.setGravity({0, -static_cast<float>(settings.gravity * settings.side()), 0});
}

void setFreeFlight(Settings& settings) {
  settings.engine.value = "kinematic";
  settings.gravity = 0;
  settings.physics.friction = 0;
  settings.physics.restitution = 1;
}

Vec3 launchVelocity(const Settings& settings, Random& random) {
  return random.inBall(settings.initial_speed * settings.side());
}

}  // namespace broadmark::scenes
