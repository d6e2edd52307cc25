// broadmark list: what there is. Everything printed here comes from the registries themselves.

#include <fmt/format.h>

#include <functional>
#include <map>

#include "cases.h"
#include "options.h"
#include "plugins.h"
#include "table.h"
#include "broadmark/compute_devices.h"
#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {
namespace {

/// An object's parameters, one line each.
std::string parameterLines(Parametrised& object) {
  std::vector<std::vector<std::string>> rows;
  object.visitParameters([&](const Parameter& parameter) {
    rows.push_back({"   ", std::string(parameter.name), parameterText(parameter),
                    parameterRange(parameter), std::string(parameter.doc)});
  });
  return alignColumns(rows, {false, false, true, false, false});
}

void listAlgorithms(const std::vector<Algorithm>& algorithms) {
  fmt::print(
      "Algorithms (id, family, principle, optimisations, pairs kept over frames, answer, "
      "time, space)\n");
  std::vector<std::vector<std::string>> rows;
  for (const Algorithm& a : algorithms) {
    rows.push_back({" ", a.id, a.family, a.principle, a.optimisations,
                    a.incremental ? "incremental" : "from scratch", a.exactness, a.time, a.space});
  }
  fmt::print("{}", alignColumns(rows, std::vector<bool>(9, false)));
  fmt::print("\nTheir sources, other names and parameters (default, range)\n");
  for (const Algorithm& a : algorithms) {
    fmt::print("  {}: {}. {}", a.id, a.summary, a.source);
    for (const OriginalId& original : a.original_ids) {
      fmt::print("{}{}", &original == &a.original_ids.front() ? ". In the original: " : ", ",
                 original.name);
    }
    if (!a.plugin.empty()) fmt::print(". From {}", a.plugin);
    fmt::print("\n{}", parameterLines(*a.create()));
  }
}

void listScenes() {
  fmt::print("Scenes, with their parameters (default, range)\n");
  for (const SceneListing& scene : builtinScenes()) {
    fmt::print("  {} ({}): {}\n{}", scene.id, scene.name, scene.summary,
               parameterLines(*makeSimulation(scene.id)));
  }
}

void listEngines() {
  fmt::print("Engines, with the parameters that come with them (default, range)\n");
  for (const EngineListing& engine : builtinEngines()) {
    fmt::print("  {}: {}\n{}", engine.id, engine.summary,
               parameterLines(*engineParameters(engine.id)));
  }
}

void listRecorders() {
  fmt::print("Recorders\n");
  for (const RecorderListing& recorder : builtinRecorders()) {
    fmt::print("  {}: {}\n", recorder.id, recorder.summary);
  }
}

void listDevices() {
  fmt::print("Compute devices (OpenCL); the first is used unless --device names another\n");
  const std::vector<ComputeDevice> devices = computeDevices();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    fmt::print("  {}: {}\n", i, describe(devices[i]));
  }
  if (devices.empty()) fmt::print("  none\n");
}

}  // namespace

int runList(const ListOptions& options) {
  const std::vector<Algorithm> algorithms = availableAlgorithms(options.plugins);
  const std::string& what = options.what;
  const std::pair<std::string, std::function<void()>> kinds[] = {
      {"algorithms", [&] { listAlgorithms(algorithms); }},
      {"scenes", listScenes},
      {"engines", listEngines},
      {"recorders", listRecorders},
      {"devices", listDevices}};
  std::vector<std::string> known = {"all"};
  bool found = false;
  for (const auto& [name, list] : kinds) {
    known.push_back(name);
    if (what != name && what != "all") continue;
    if (found) fmt::print("\n");
    found = true;
    list();
  }
  if (!found) throw InputError("list: " + unknownName("kind", what, known));
  return 0;
}

}  // namespace broadmark
