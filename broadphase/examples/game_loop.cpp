// A game loop: crates that fly through a level of pillars, come and go, are told when they begin
// and cease to touch something, and are shot at.

#include <broadmark/broadphase.hpp>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

namespace bp = broadmark::broadphase;

int main() {
  constexpr std::uint32_t kPillars = 400, kCrates = 1000, kFrames = 240;
  enum Layer : std::uint32_t { pillars, crates };

  bp::Options options;
  options.answer = bp::Answer::events;
  options.margin = 0.05F;                        // contacts are made a little before boxes touch
  options.setCollides(pillars, pillars, false);  // they stand still
  bp::BroadPhase broad_phase(options);

  std::mt19937 random(1);
  const auto anywhere = [&] { return static_cast<float>(random() % 1000) * 0.1F; };
  std::vector<bp::Box> boxes;
  std::vector<float> speeds(kPillars, 0.0F);
  for (std::uint32_t body = 0; body < kPillars; ++body) {
    const std::uint32_t row = body / 20;
    const float x = static_cast<float>(body % 20) * 5, z = static_cast<float>(row) * 5;
    boxes.push_back({{x, 0, z}, {x + 1, 20, z + 1}});
  }
  const auto crate = [&]() -> bp::Box {
    const float x = anywhere(), y = anywhere() / 5, z = anywhere();
    return {{x, y, z}, {x + 1, y + 1, z + 1}};
  };
  std::vector<std::uint32_t> contacts(kPillars + kCrates);  // of each body
  for (std::uint32_t body = kPillars; body < kPillars + kCrates; ++body) {
    broad_phase.setFilter(body, {.layer = crates});
    boxes.push_back(crate());
    speeds.push_back(body % 3 == 0 ? 0.0F : anywhere() / 100);  // some are at rest
  }

  std::uint64_t begun = 0, over = 0, shot = 0;
  bp::QueryResults<bp::CastHit> hits;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    for (std::uint32_t body = kPillars; body < boxes.size(); ++body) {
      if (boxes[body].min[0] > boxes[body].max[0]) {  // a slot that is free
        if (random() % 8 == 0) boxes[body] = crate();
      } else if (boxes[body].max[0] > 110) {
        boxes[body] = bp::kNoBox;  // has left the level
      } else {
        boxes[body].min[0] += speeds[body];
        boxes[body].max[0] += speeds[body];
      }
    }
    broad_phase.update(boxes);  // finds out by itself what has changed
    for (const auto [a, b] : broad_phase.began()) ++contacts[a], ++contacts[b], ++begun;
    for (const auto [a, b] : broad_phase.ended()) --contacts[a], --contacts[b], ++over;

    // Two shots from the middle of the level: what does each hit first?
    const bp::Box gun = {{52.5F, 10, 52.5F}, {52.5F, 10, 52.5F}};
    const bp::Cast shots[] = {{gun, {60, 0, anywhere() - 50}}, {gun, {-60, 0, anywhere() - 50}}};
    broad_phase.cast(shots, bp::Hits::closest, hits);
    for (const bp::CastHit& hit : hits.items) shot += hit.body >= kPillars ? 1 : 0;
  }
  std::uint64_t touching = 0;
  for (const std::uint32_t count : contacts) touching += count;
  std::printf("%llu contacts began, %llu ended; %llu crates shot\n",
              static_cast<unsigned long long>(begun), static_cast<unsigned long long>(over),
              static_cast<unsigned long long>(shot));
  return touching == 2 * (begun - over) && begun > 0 ? 0 : 1;
}
