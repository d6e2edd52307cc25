#include "torture/random_world.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "torture/changing.h"
#include "torture/given_frames.h"

namespace broadmark {
namespace {

using inputs::Random;

constexpr const char* kGiven = "given";
/// Each frame has a random generator.
constexpr const char* kUnrelated = "unrelated frames";

/// Log-uniform: every scale as often, since most faults with many bodies also occur with few.
std::size_t randomCount(Random& random, bool all_overlap) {
  const int max = random.onceIn(20) ? 1000 : 300;
  const double share = static_cast<double>(random.uniform(0, 1));
  return static_cast<std::size_t>(
      std::expm1(share * std::log1p(all_overlap ? std::min(max, 100) : max)));
}

std::uint32_t randomFrameCount(Random& random) {
  return static_cast<std::uint32_t>(random.integer(1, random.onceIn(10) ? 30 : 8));
}

/// Removes absent bodies from the frames.
void removeAbsent(std::vector<std::vector<Aabb>>& frames, Random& random) {
  const inputs::NamedPresence& presence = random.anyOf(inputs::kPresences);
  // Each world starts at a random frame of the presence pattern.
  const auto phase = static_cast<std::uint32_t>(random.integer(0, 20));
  for (std::uint32_t frame = 0; frame < frames.size(); ++frame) {
    for (std::uint32_t body = 0; body < frames[frame].size(); ++body) {
      if (!presence.present(body, frame + phase)) frames[frame][body] = kEmptyBox;
    }
  }
}

/// The number of bodies and frames are drawn unless given.
RandomWorld generatedWorld(Random& random, std::optional<std::size_t> bodies = {},
                           std::optional<std::uint32_t> last_frame = {}) {
  const bool is_unrelated = random.onceIn(20);
  const inputs::Input kind = random.anyOf(inputs::kAll);
  const std::size_t n = bodies ? *bodies : randomCount(random, kind.all_overlap || is_unrelated);
  const std::uint32_t count = last_frame ? *last_frame : randomFrameCount(random);
  const auto seed = static_cast<std::uint64_t>(random.integer(0, 1'000'000'000));
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame <= count; ++frame) {
    const inputs::Input& input = is_unrelated ? random.anyOf(inputs::kAll) : kind;
    frames.push_back(input.boxes(n, frame, seed));
  }
  SceneInfo scene = inputs::sceneOf(frames);
  if (random.onceIn(8)) scene.world = {{0, 0, 0, 0}, {1, 1, 1, 0}};  // bodies may protrude
  if (random.onceIn(3)) {
    scene.all_present = false;
    removeAbsent(frames, random);
  }
  if (random.onceIn(3)) scene.filter = random.anyOf(inputs::filters(n, seed)).filter;
  std::vector<CollisionFilter> filters;
  if (random.onceIn(6)) {
    filters = inputs::changingFilters(scene.filter, n, count,
                                      random.anyOf(inputs::kFilterChanges).changes, seed);
  }
  return {is_unrelated ? kUnrelated : std::string(kind.name),
          std::make_unique<inputs::GivenFrames>(std::move(scene), std::move(frames),
                                                std::move(filters))};
}

/// Up to `max` consecutive integers below `count`, from a random start.
std::vector<std::uint32_t> randomRange(Random& random, std::uint32_t count, std::uint32_t max) {
  std::vector<std::uint32_t> range(std::min(count, max));
  const auto first = random.integer(0, static_cast<int>(count - range.size()));
  std::iota(range.begin(), range.end(), static_cast<std::uint32_t>(first));
  return range;
}

/// The given bodies, in this order, and frames.
template <class FrameOf>
std::unique_ptr<IndexedFrames> subset(SceneInfo scene, FrameOf frame_of,
                                      const std::vector<std::uint32_t>& bodies,
                                      const std::vector<std::uint32_t>& frames) {
  std::vector<std::vector<Aabb>> all;
  std::vector<CollisionFilter> filters;
  for (const std::uint32_t index : frames) {
    const Frame frame = frame_of(index);
    all.emplace_back();
    for (const std::uint32_t body : bodies) all.back().push_back(frame.boxes[body]);
    if (scene.filter_changes) filters.push_back(frame.filterIn(scene).of(bodies));
  }
  scene.filter = scene.filter.of(bodies);
  return std::make_unique<inputs::GivenFrames>(std::move(scene), std::move(all),
                                               std::move(filters));
}

/// All of a small recording; else some consecutive bodies, in some frames.
RandomWorld excerptOf(const TortureRecording& given, Random& random) {
  constexpr std::uint32_t kMaxBodies = 1000;
  constexpr std::uint32_t kMaxFrames = 31;
  const std::vector<std::uint32_t> bodies = randomRange(random, given.scene.objects, kMaxBodies);
  const std::vector<std::uint32_t> frames = randomRange(random, given.scene.frames + 1, kMaxFrames);
  const auto frame_of = [&](std::uint32_t index) {
    Frame frame{index, given.frames[index]};
    if (given.scene.filter_changes) frame.filter = &given.filters[index];
    return frame;
  };
  return {kGiven, subset(given.scene, frame_of, bodies, frames)};
}

}  // namespace

std::vector<std::string> tortureWorlds() {
  std::vector<std::string> names;
  for (const inputs::Input& kind : inputs::kAll) names.emplace_back(kind.name);
  names.emplace_back(kUnrelated);
  return names;
}

RandomWorld randomWorld(Random& random, const TortureOptions& options) {
  const bool is_given = options.only_given || (!options.given.empty() && random.onceIn(10));
  return is_given ? excerptOf(random.anyOf(options.given), random) : generatedWorld(random);
}

RandomWorld largeWorld(Random& random) {
  constexpr std::size_t kBodies = 70'000;
  constexpr std::uint32_t kFrames = 2;
  // Neither dense nor teleporting: that would take minutes.
  const inputs::Input& kind = *std::ranges::find(inputs::kAll, "drifting", &inputs::Input::name);
  const auto seed = static_cast<std::uint64_t>(random.integer(0, 1'000'000'000));
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame <= kFrames; ++frame) {
    frames.push_back(kind.boxes(kBodies, frame, seed));
  }
  SceneInfo scene = inputs::sceneOf(frames);
  return {std::string(kind.name),
          std::make_unique<inputs::GivenFrames>(std::move(scene), std::move(frames))};
}

RandomWorld longWorld(Random& random, std::uint32_t frames) {
  constexpr int kMaxBodies = 40;
  const auto bodies = static_cast<std::size_t>(random.integer(2, kMaxBodies));
  return generatedWorld(random, bodies, frames);
}

std::unique_ptr<IndexedFrames> shuffled(Random& random, IndexedFrames& frames) {
  const SceneInfo& scene = frames.scene();
  std::vector<std::uint32_t> order(scene.objects);
  std::iota(order.begin(), order.end(), 0U);
  for (int left = static_cast<int>(order.size()); left > 1; --left) {
    const auto last = static_cast<std::size_t>(left - 1);
    std::swap(order[last], order[static_cast<std::size_t>(random.integer(0, left - 1))]);
  }
  std::vector<std::uint32_t> all(scene.frames + 1);
  std::iota(all.begin(), all.end(), 0U);
  return subset(scene, [&](std::uint32_t frame) { return frames.at(frame); }, order, all);
}

}  // namespace broadmark
