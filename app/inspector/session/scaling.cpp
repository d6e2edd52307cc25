#include "inspector/session/scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "broadmark/harness/runner.h"

namespace broadmark {
namespace {

/// As recordingId(), without the size.
std::string sceneOf(const CaseResult& result) {
  std::string id = recordingId(result.recording);
  const std::string size = fmt::format("/N{}/", result.recording.scene.objects);
  if (const std::size_t at = id.find(size); at != id.npos) id.erase(at, size.size() - 1);
  return id;
}

double exponentOf(const std::vector<ScalingPoint>& points) {
  const auto count = static_cast<double>(points.size());
  const auto x = [](const ScalingPoint& point) {
    return std::log(static_cast<double>(point.objects));
  };
  const auto y = [](const ScalingPoint& point) { return std::log(point.seconds); };
  double mean_x = 0;
  double mean_y = 0;
  for (const ScalingPoint& point : points) {
    mean_x += x(point) / count;
    mean_y += y(point) / count;
  }
  double together = 0;
  double spread = 0;
  for (const ScalingPoint& point : points) {
    together += (x(point) - mean_x) * (y(point) - mean_y);
    spread += (x(point) - mean_x) * (x(point) - mean_x);
  }
  return together / spread;
}

/// A curve in the making.
struct Family {
  std::string scene;
  std::string case_name;
  std::string algorithm;
  std::vector<ScalingPoint> points;

  [[nodiscard]] bool hasSeveralSizes() const {
    return points.front().objects != points.back().objects;
  }
};

std::vector<Family> familiesOf(std::span<const SizedCase> cases, Phase phase) {
  std::vector<Family> families;
  for (const SizedCase& sized : cases) {
    const CaseResult& result = *sized.result;
    const double seconds = result.meanSeconds(phase).value_or(0);
    if (result.status != Status::ok || !result.isComplete() || seconds <= 0) continue;
    const std::string scene = sceneOf(result);
    const std::string case_name = caseNameOf(result);
    auto family = std::ranges::find_if(families, [&](const Family& other) {
      return other.scene == scene && other.case_name == case_name;
    });
    if (family == families.end()) {
      family = families.insert(
          families.end(),
          Family{
              .scene = scene, .case_name = case_name, .algorithm = sized.algorithm, .points = {}});
    }
    family->points.push_back(
        {.objects = result.recording.scene.objects, .seconds = seconds, .row = sized.row});
  }
  for (Family& family : families) {
    std::ranges::stable_sort(family.points, {}, &ScalingPoint::objects);
  }
  std::erase_if(families, [](const Family& family) { return !family.hasSeveralSizes(); });
  return families;
}

}  // namespace

std::vector<ScalingCurve> scalingCurves(std::span<const SizedCase> cases, Phase phase) {
  std::vector<Family> families = familiesOf(cases, phase);
  std::set<std::string> scenes;
  std::set<std::string> case_names;
  std::set<std::string> algorithms;
  for (const Family& family : families) {
    scenes.insert(family.scene);
    case_names.insert(family.case_name);
    algorithms.insert(family.algorithm);
  }
  const bool short_names_do = case_names.size() == algorithms.size();
  std::vector<ScalingCurve> curves;
  for (Family& family : families) {
    const double exponent = exponentOf(family.points);
    curves.push_back({.algorithm = short_names_do ? family.algorithm : family.case_name,
                      .scene = scenes.size() > 1 ? family.scene : "",
                      .points = std::move(family.points),
                      .exponent = exponent});
  }
  return curves;
}

}  // namespace broadmark
