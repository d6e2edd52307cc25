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

void Scene::start(Stage& stage) {
  const Settings& settings = stage.settings;
  stage.engine.setGravity({0, -static_cast<float>(settings.gravity * settings.side()), 0});
}

Vec3 launchVelocity(const Settings& settings, Random& random) {
  return random.inBall(settings.initial_speed * settings.side());
}

}  // namespace broadmark::scenes
