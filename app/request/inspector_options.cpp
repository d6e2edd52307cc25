#include "request/inspector_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "broadmark/error.h"
#include "broadmark/scenes/simulation.h"
#include "support/words.h"

namespace broadmark {
namespace {

constexpr float kDegrees = 180 / std::numbers::pi_v<float>;

}  // namespace

std::string cameraText(const OrbitCamera& camera) {
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", camera.pivot[0], camera.pivot[1],
                     camera.pivot[2], camera.yaw * kDegrees, camera.pitch * kDegrees,
                     camera.distance);
}

OrbitCamera parseCamera(const std::string& text) {
  constexpr auto kLimit = static_cast<float>(ViewSpace::kLimit);
  constexpr float kFullTurn = 360;
  constexpr float kVertical = 90;
  const std::vector<std::string> parts = splitAt(',', text);
  std::array<float, 6> numbers{};
  if (parts.size() != numbers.size()) {
    throw InputError(
        fmt::format("--camera: '{}' is not of the form X,Y,Z,YAW,PITCH,DISTANCE", text));
  }
  const auto parse = [&](std::size_t i, float min, float max) {
    const auto number = numberIn(parts[i]);
    if (!number || !(*number >= min && *number <= max)) {
      throw InputError(fmt::format("--camera: '{}' in '{}' is not a number from {} to {}", parts[i],
                                   text, min, max));
    }
    return static_cast<float>(*number);
  };
  return {
      .pivot = {parse(0, -kLimit, kLimit), parse(1, -kLimit, kLimit), parse(2, -kLimit, kLimit)},
      .yaw = parse(3, -kFullTurn, kFullTurn) / kDegrees,
      .pitch = std::clamp(parse(4, -kVertical, kVertical) / kDegrees, -OrbitCamera::kSteepest,
                          OrbitCamera::kSteepest),
      .distance = parse(5, OrbitCamera::kNearest, OrbitCamera::kFarthest)};
}

std::vector<std::uint32_t> parseBodies(const std::string& text) {
  std::vector<std::uint32_t> bodies;
  forEachPart(',', text, [&](std::string_view part) {
    const auto body = parseInteger(std::string(part), "--select", 0, kMaxBodies - 1);
    bodies.push_back(static_cast<std::uint32_t>(body));
  });
  return bodies;
}

}  // namespace broadmark
