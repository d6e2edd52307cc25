// broadmark list: lists everything that can be named on the command line.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "broadmark/algorithms.h"
#include "broadmark/compute_devices.h"
#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/scenes/simulation.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "original/ids.h"
#include "request/cases.h"
#include "request/plugins.h"
#include "support/table.h"

namespace broadmark::commands::list {
namespace {

struct Options {
  std::string what = "all";
  std::vector<std::string> names;  ///< of algorithms; empty: all
  std::vector<std::string> plugins;
};

/// Formats an object's parameters, one per line.
std::string parameterLines(Parametrised& object) {
  std::vector<std::vector<std::string>> rows;
  object.visitParameters([&](const Parameter& parameter) {
    rows.push_back({"   ", std::string(parameter.name), parameterText(parameter),
                    parameterRange(parameter), std::string(parameter.doc)});
  });
  return alignColumns(rows, {false, false, true, false, false}, LastColumn::wrapped);
}

std::string optimisationsOf(const Algorithm& algorithm) {
  std::vector<std::string> all;
  const auto add = [&](bool has, const std::string& what) {
    if (has) all.push_back(what);
  };
  const AlgorithmTraits& traits = algorithm.traits;
  add(!algorithm.description.optimisations.empty(), algorithm.description.optimisations);
  add(traits.vectorised, "SIMD");
  add(traits.parallel && !traits.on_device, "threads");
  add(traits.on_device, "OpenCL");
  return all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", "));
}

std::string exactnessOf(const Algorithm& algorithm) {
  if (!algorithm.traits.finds_pairs) return "finds nothing";
  const float margin = algorithm.create()->margin();
  return margin == 0 ? "exact" : fmt::format("margin {}", margin);
}

/// Prints a paragraph of a list.
void printParagraph(const std::string& text) {
  constexpr std::size_t kIndent = 2;
  constexpr std::size_t kHanging = 6;
  fmt::print("{:{}}{}\n", "", kIndent, wrapped(text, kIndent, kHanging));
}

const char* changingWorldsText(const Algorithm& algorithm) {
  switch (algorithm.traits.changing_worlds) {
    case ChangingWorlds::native:
      return "natively";
    case ChangingWorlds::compacted:
      return "absent bodies and filtered pairs are hidden from it";
    case ChangingWorlds::unknown:
      break;
  }
  return "not supported";
}

const char* severalWorldsText(const Algorithm& algorithm) {
  const AlgorithmTraits& traits = algorithm.traits;
  if (traits.changing_worlds == ChangingWorlds::unknown) return "not supported";
  if (traits.instance_per_world) return "one instance per world";
  if (traits.changing_worlds == ChangingWorlds::native) return "natively";
  return traits.on_device ? "side by side" : "side by side if small, else one instance per world";
}

const char* eventsText(const Algorithm& algorithm) {
  return algorithm.traits.events ? "natively" : "from the pairs of two frames";
}

/// Details for which the columns have no room, in sentences.
std::string detailsOf(const Algorithm& algorithm) {
  const AlgorithmDescription& description = algorithm.description;
  std::string text = fmt::format(
      "{}: {}. Optimisations: {}. Time {}. Space {}. Changing worlds: {}. Several worlds at the "
      "same position: {}. Events: {}. {}",
      algorithm.id, algorithm.summary, optimisationsOf(algorithm), description.time,
      description.space, changingWorldsText(algorithm), severalWorldsText(algorithm),
      eventsText(algorithm), description.source);
  std::vector<std::string_view> original;
  for (const OriginalId& id : originalIds()) {
    if (id.algorithm == algorithm.id) original.push_back(id.name);
  }
  if (!original.empty()) text += fmt::format(". In the original: {}", fmt::join(original, ", "));
  if (algorithm.traits.max_objects < AlgorithmTraits().max_objects) {
    text += fmt::format(". At most {} bodies", algorithm.traits.max_objects);
  }
  if (!algorithm.plugin.empty()) text += fmt::format(". From {}", algorithm.plugin);
  return text;
}

void listAlgorithms(const Options& options) {
  std::vector<Algorithm> algorithms = availableAlgorithms(options.plugins);
  if (!options.names.empty()) algorithms = selectAlgorithms(options.names, algorithms, "list");
  fmt::print("Algorithms (id, family, principle, update of pairs, answer)\n");
  std::vector<std::vector<std::string>> rows;
  for (const Algorithm& a : algorithms) {
    rows.push_back({" ", a.id, a.family, a.description.principle,
                    a.traits.incremental ? "incremental" : "from scratch", exactnessOf(a)});
  }
  fmt::print("{}", alignColumns(rows, std::vector<bool>(rows.front().size(), false)));
  fmt::print("\nDetails of each, with parameters (default, range)\n");
  for (const Algorithm& a : algorithms) {
    printParagraph(detailsOf(a));
    fmt::print("{}", parameterLines(*a.create()));
  }
}

void listScenes(const Options& /*options*/) {
  fmt::print("Scenes, with their parameters (default, range)\n");
  for (const SceneListing& scene : builtinScenes()) {
    printParagraph(fmt::format("{} ({}): {}", scene.id, scene.name, scene.summary));
    fmt::print("{}", parameterLines(*makeSimulation(scene.id)));
  }
}

void listEngines(const Options& /*options*/) {
  fmt::print("Engines, with the parameters that come with them (default, range)\n");
  for (const EngineListing& engine : availableEngines()) {
    std::string text = fmt::format("{}: {}", engine.id, engine.summary);
    if (!engine.plugin.empty()) text += fmt::format(". From {}", engine.plugin);
    printParagraph(text);
    fmt::print("{}", parameterLines(*engineParameters(engine.id)));
  }
}

void listRecorders(const Options& /*options*/) {
  fmt::print("Recorders\n");
  for (const RecorderListing& recorder : builtinRecorders()) {
    printParagraph(fmt::format("{}: {}", recorder.id, recorder.summary));
  }
}

void listPlugins(const Options& /*options*/) {
  fmt::print("Plug-ins that come with the program: --plugin NAME\n");
  for (const SdkPlugin& plugin : sdkPlugins()) {
    printParagraph(plugin.built ? fmt::format("{}: {}", plugin.name, plugin.releases)
                                : fmt::format("{}: not built: {} was not found (find_package({}))",
                                              plugin.name, plugin.releases, plugin.package));
  }
}

void listDevices(const Options& /*options*/) {
  fmt::print("Compute devices (OpenCL); the first is used unless --device names another\n");
  const std::vector<ComputeDevice> devices = computeDevices();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    printParagraph(fmt::format("{}: {}", i, describe(devices[i])));
  }
  if (devices.empty()) fmt::print("  none\n");
}

using Section = std::pair<std::string, std::function<void(const Options&)>>;

std::vector<Section> sections() {
  std::vector<Section> all = {{"algorithms", listAlgorithms},
                              {"scenes", listScenes},
                              {"engines", listEngines},
                              {"recorders", listRecorders},
                              {"plugins", listPlugins}};
  if (parts::kOpenCl.included) all.emplace_back("devices", listDevices);
  return all;
}

std::vector<std::string> sectionNames() {
  std::vector<std::string> names;
  for (const auto& [name, print] : sections()) names.push_back(name);
  return names;
}

std::vector<std::string> choices() {
  std::vector<std::string> names = sectionNames();
  names.emplace_back("all");
  return names;
}

int run(const Options& options) {
  const std::vector<std::string> known = choices();
  if (std::ranges::find(known, options.what) == known.end()) {
    throw InputError("list: " + unknownName("kind", options.what, known));
  }
  if (!options.names.empty() && options.what != "algorithms") {
    throw InputError(fmt::format("list: '{}': only algorithms can be named: list algorithms {}",
                                 options.names.front(), options.names.front()));
  }
  addEnginesOf(options.plugins);
  bool first = true;
  for (const auto& [name, print] : sections()) {
    if (options.what != name && options.what != "all") continue;
    if (!std::exchange(first, false)) fmt::print("\n");
    print(options);
  }
  return 0;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::Option* what =
      addText(app, "what", "WHAT", options->what, fmt::format("{}", fmt::join(choices(), ", ")));
  suggestValues(what, choices());
  CLI::Option* names = app.add_option(
      "names", options->names, "only these algorithms: ids, families, patterns such as 'sap*'");
  suggestValues(names->type_name("NAME"), algorithmIds(builtinAlgorithms()));
  addPlugins(app, options->plugins);
  addExternal(app, options->plugins);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "list",
          .summary = fmt::format("Lists {}, with parameters.", fmt::join(sectionNames(), ", ")),
          .examples = {"list algorithms 'sap*'", "list scenes"},
          .add = add};
}

}  // namespace broadmark::commands::list
