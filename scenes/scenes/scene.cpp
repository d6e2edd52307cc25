#include "broadmark/scenes/scene.h"

namespace broadmark::scenes {

BodyDescription Scene::body(std::size_t index, const Settings& settings, const ObjectType& type,
                            Random& random) {
  BodyDescription body;
  body.shape = type.shape(index, settings.scale, random);
  body.mass = settings.mass;
  body.pose.position = random.inBall(settings.initial_radius * settings.side());
  body.linear_velocity = launchVelocity(settings, random);
  return body;
}

void Scene::populate(Stage& stage) {
  for (std::size_t i = 0; i < stage.bodies.size(); ++i) {
    stage.bodies.add(i, body(i, stage.settings, stage.object_type, stage.random));
  }
}

void Scene::start(Stage& stage) {
  const Settings& settings = stage.settings;
  stage.engine.setGravity({0, -static_cast<float>(settings.gravity * settings.side()), 0});
}

Vec3 launchVelocity(const Settings& settings, Random& random) {
  return random.inBall(settings.initial_speed * settings.side());
}

}  // namespace broadmark::scenes
