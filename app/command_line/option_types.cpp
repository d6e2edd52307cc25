// Options shared by several commands.

#include "command_line/option_types.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "broadmark/algorithms.h"
#include "broadmark/scenes/registry.h"
#include "command_line/usage.h"
#include "request/former_names.h"
#include "request/plugins.h"
#include "request/sweep.h"
#include "support/words.h"

namespace broadmark {
namespace {

constexpr NameTable kGlSources{{NamedValue{GlSource::automatic, "auto"},
                                {GlSource::egl, "egl"},
                                {GlSource::osmesa, "osmesa"}}};

std::vector<std::string> recorderIds() {
  std::vector<std::string> ids;
  for (const RecorderListing& recorder : builtinRecorders()) ids.push_back(recorder.id);
  return ids;
}

std::vector<std::string> objectTypeIds() {
  std::vector<std::string> ids;
  for (const scenes::ObjectType& type : scenes::objectTypes()) ids.push_back(type.listing.id);
  return ids;
}

std::vector<std::string> engineIds() {
  std::vector<std::string> ids;
  for (const EngineListing& engine : availableEngines()) ids.push_back(engine.id);
  return ids;
}

/// Returns the recorders without duplicates, in the given order.
std::vector<std::string> parseRecorders(const std::vector<std::string>& names) {
  const std::vector<std::string> known = recorderIds();
  std::vector<std::string> recorders;
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError("--recorder: " + unknownName("recorder", name, known));
    }
    if (std::ranges::find(recorders, name) == recorders.end()) recorders.push_back(name);
  }
  return recorders;
}

/// Returns the counts in ascending order, without duplicates.
std::vector<std::uint32_t> parseObjectCounts(const std::vector<std::string>& texts) {
  std::vector<std::uint32_t> counts;
  for (const std::string& text : texts) {
    counts.push_back(static_cast<std::uint32_t>(parseInteger(text, "--objects", 0, kMaxBodies)));
  }
  std::ranges::sort(counts);
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  return counts;
}

/// Parses texts of the form [ALGORITHM:]KEY=VALUE; ALGORITHM becomes part of the key.
ParameterValues parseKeyValues(const std::vector<std::string>& texts) {
  ParameterValues values;
  for (const std::string& text : texts) {
    const auto split = text.find('=');
    const std::string key = currentParameterKey(text.substr(0, std::min(split, text.size())));
    if (split == std::string::npos || key.empty() || key.front() == ':' || key.back() == ':') {
      throw InputError(
          fmt::format("--param: '{}' is not of the form KEY=VALUE or ALGORITHM:KEY=VALUE", text));
    }
    if (!values.emplace(key, text.substr(split + 1)).second) {
      throw InputError(fmt::format("--param: '{}' is given twice", key));
    }
  }
  return values;
}

void parseSize(const std::string& text, PictureOptions& options) {
  constexpr int kMaxPixels = 16384;
  const auto x = text.find('x');
  if (x == std::string::npos) {
    throw InputError(fmt::format("--size: '{}' is not of the form WxH, e.g. 1280x720", text));
  }
  options.width = static_cast<int>(parseInteger(text.substr(0, x), "--size", 1, kMaxPixels));
  options.height = static_cast<int>(parseInteger(text.substr(x + 1), "--size", 1, kMaxPixels));
}

/// Returns the thread counts in ascending order.
std::vector<int> parseThreads(const std::vector<std::string>& texts) {
  std::vector<int> threads;
  for (const std::string& text : texts) threads.push_back(parseThreadCount(text));
  std::ranges::sort(threads);
  return threads;
}

std::vector<std::string> isaChoices() {
  std::vector<std::string> choices = {"auto"};
  for (const auto& entry : kIsas.entries) choices.emplace_back(entry.name);
  return choices;
}

std::vector<Isa> parseIsas(const std::vector<std::string>& names) {
  std::vector<Isa> isas;
  for (const std::string& name : names) {
    const auto isa = name == "auto" ? bestIsa() : kIsas.find(name);
    if (!isa) throw InputError("--isa: " + unknownName("value", name, isaChoices()));
    isas.push_back(*isa);
  }
  return isas;
}

std::string isaNames(const std::vector<Isa>& isas) {
  std::vector<std::string_view> names;
  for (const Isa isa : isas) names.push_back(isaName(isa));
  return fmt::format("{}", fmt::join(names, ","));
}

/// Joins values as the text of a list option.
template <class List>
std::string joined(const List& values) {
  return fmt::format("{}", fmt::join(values, ","));
}

/// A scene parameter with its own option.
struct SceneShortcut {
  const char* parameter;
  const char* type;
  const char* doc;
  bool list = true;  ///< several values are allowed: one recording per value
};
constexpr SceneShortcut kSceneShortcuts[] = {
    {"frames", "F[,F...]", "frames to simulate, not counting the initial pose"},
    {"seed", "S[,S...]", "seeds: same seed, same recording"},
    {"density", "D[,D...]", "share of the world's volume filled by bodies"},
    {"engine", "NAME[,NAME...]", "engines that move the bodies (see 'broadmark list engines')"},
    {"input", "PATH", "recording, or folder of recordings, for an engine to replay", false}};

}  // namespace

double parseNumber(const std::string& text, std::string_view option, double min, bool open) {
  // CLI11's own checks let NaN pass.
  const std::optional<double> value = numberIn(text);
  if (!value || !std::isfinite(*value) || *value < min || (open && *value == min)) {
    throw InputError(
        fmt::format("{}: '{}' is not a number {} {}", option, text, open ? ">" : ">=", min));
  }
  return *value;
}

CLI::Option* addValue(CLI::App& app, const std::string& name, const std::string& type,
                      const std::function<void(const std::string&)>& set, const ValueText& get,
                      const std::string& doc) {
  CLI::Option* option = app.add_option_function<std::string>(name, set, doc);
  return option->type_name(type)->default_function(get)->capture_default_str();
}

CLI::Option* addFlag(CLI::App& app, const std::string& name, bool& target, const std::string& doc) {
  return app.add_flag(name, target, doc)->default_function([&] { return target ? "true" : ""; });
}

/// An option with an optional value: --NAME, which means `implied`, or --NAME=VALUE.
CLI::Option* addFlagWithValue(CLI::App& app, const std::string& name, const std::string& implied,
                              std::string& target, const std::string& doc) {
  return app.add_flag(fmt::format("{}{{{}}}", name, implied), target, doc)
      ->type_name("[=BOX]")
      ->default_function([&] { return target; });
}

CLI::Option* addPositive(CLI::App& app, const std::string& name, const std::string& type,
                         double& target, const std::string& doc) {
  const auto set = [&target, name](const std::string& text) {
    target = parseNumber(text, name, 0, true);
  };
  return addValue(app, name, type, set, [&] { return fmt::format("{}", target); }, doc);
}

double parseShare(const std::string& text, std::string_view option, bool open) {
  const bool percent = text.ends_with('%');
  const std::string number = text.substr(0, text.size() - (percent ? 1 : 0));
  const double value = parseNumber(number, option, 0, open);
  if (!percent && value >= 1) {
    throw InputError(
        fmt::format("{0}: '{1}' is ambiguous: write {1}% or {2:g}%", option, number, 100 * value));
  }
  return value / (percent ? 100 : 1);
}

CLI::Option* addShare(CLI::App& app, const std::string& name, double& target, bool open,
                      const std::string& doc) {
  const auto set = [&target, name, open](const std::string& text) {
    target = parseShare(text, name, open);
  };
  return addValue(
      app, name, "SHARE", set, [&] { return fmt::format("{:.12g}%", 100 * target); }, doc);
}

CLI::Option* addText(CLI::App& app, const std::string& name, const std::string& type,
                     std::string& target, const std::string& doc) {
  return addValue(
      app, name, type, [&](const std::string& text) { target = text; }, [&] { return target; },
      doc);
}

CLI::Option* addPath(CLI::App& app, const std::string& name, const std::string& type,
                     std::filesystem::path& target, const std::string& doc) {
  return app.add_option(name, target, doc)->type_name(type)->default_function([&] {
    return target.string();
  });
}

CLI::Option* addList(CLI::App& app, const std::string& name, const std::string& type,
                     std::function<void(const std::vector<std::string>&)> set, const ValueText& get,
                     const std::string& doc) {
  const auto split = [set = std::move(set), name](const std::vector<std::string>& texts) {
    const std::vector<std::string> parts = splitList(texts);
    if (parts.empty()) {
      throw InputError(fmt::format("{}: '{}' is an empty list", name, texts.front()));
    }
    set(parts);
  };
  return app.add_option_function<std::vector<std::string>>(name, split, doc)
      ->type_name(type)
      ->allow_extra_args(false)
      ->default_function(get);
}

CLI::Option* addRepeatable(CLI::App& app, const std::string& name, const std::string& type,
                           std::vector<std::string>& target, const std::string& doc) {
  return app.add_option(name, target, doc)
      ->type_name(type)
      ->allow_extra_args(false)
      ->default_function([&] { return fmt::format("{}", fmt::join(target, "\n")); });
}

void hideWithout(const BuildPart& part, const std::vector<CLI::Option*>& options) {
  if (part.included) return;
  for (CLI::Option* option : options) option->description("");
}

CLI::Option* addPlugins(CLI::App& app, std::vector<std::string>& plugins, const std::string& more) {
  return addRepeatable(app, "--plugin", "FILE", plugins,
                       fmt::format("shared library, or name from 'broadmark list plugins', with "
                                   "more {} (repeatable)",
                                   more));
}

CLI::Option* addExternal(CLI::App& app, std::vector<std::string>& plugins) {
  const auto add = [&](const std::vector<std::string>& commands) {
    for (const std::string& command : commands) {
      const std::string plugin = kExternalPrefix + command;
      // Options are parsed again after those of a run request.
      if (std::ranges::find(plugins, plugin) == plugins.end()) plugins.push_back(plugin);
    }
  };
  return app
      .add_option_function<std::vector<std::string>>(
          "--external", add,
          "shell command that runs a program as an algorithm, which reports its own times (see "
          "docs/external.md; repeatable)")
      ->type_name("COMMAND")
      ->allow_extra_args(false);
}

CLI::Option* addParameters(CLI::App& app, ParameterValues& parameters) {
  const auto set = [&](const std::vector<std::string>& texts) {
    parameters = parseKeyValues(texts);
  };
  return app
      .add_option_function<std::vector<std::string>>(
          "--param", set,
          "set a parameter of a scene or algorithm (see 'broadmark list'; repeatable); "
          "KEY=A,B,C: a recording or case for each value and for every combination; "
          "ALGORITHM:KEY=VALUE: for these algorithms only, named as in --algorithm")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->default_function([&] {
        std::vector<std::string> lines;
        for (const auto& [key, value] : parameters)
          lines.push_back(fmt::format("{}={}", key, value));
        return fmt::format("{}", fmt::join(lines, "\n"));
      });
}

CLI::Option* addOutput(CLI::App& app, std::string_view format, OutputPaths& outputs,
                       std::string_view doc) {
  const HelpGroup group(app, "Results");
  const std::string name(format);
  const auto set = [&outputs, name](const std::string& path) { outputs[name] = path; };
  const auto get = [&outputs, name] {
    const auto given = outputs.find(name);
    return given == outputs.end() ? std::string() : given->second.string();
  };
  return addValue(app, "--" + name, "FILE", set, get,
                  fmt::format("{}; '-': to standard output, instead of the table", doc));
}

std::vector<CLI::Option*> addResultOutputs(CLI::App& app, OutputPaths& outputs) {
  std::vector<CLI::Option*> options;
  for (const ResultWriter& writer : resultWriters()) {
    options.push_back(addOutput(app, writer.name, outputs, writer.doc));
  }
  return options;
}

CLI::Option* addQuiet(CLI::App& app, bool& quiet) {
  return app.add_flag("--quiet", quiet, "suppress progress output");
}

CLI::Option* addRecorders(CLI::App& app, std::vector<std::string>& recorders) {
  const auto set = [&](const std::vector<std::string>& names) {
    recorders = parseRecorders(names);
  };
  CLI::Option* option = addList(
      app, "--recorder", "FORMAT[,FORMAT...]", set, [&] { return joined(recorders); },
      fmt::format("formats of the recordings: {} (default: {} if that can hold the "
                  "scene, else {})",
                  fmt::join(recorderIds(), ", "), kAabbsExtension, kBroadmarkExtension));
  return suggestValues(option, recorderIds());
}

std::vector<CLI::Option*> addPictureOptions(CLI::App& app, PictureOptions& options) {
  const HelpGroup group(app, "Pictures");
  CLI::Option* size = addValue(
      app, "--size", "WxH", [&](const std::string& text) { parseSize(text, options); },
      [&] { return fmt::format("{}x{}", options.width, options.height); }, "size of the pictures");
  CLI::Option* gl =
      addNamed(app, "--gl", "SOURCE", options.gl, kGlSources,
               fmt::format("source of off-screen OpenGL: {}", fmt::join(kGlSources.names(), ", ")));
  hideWithout(parts::kRenderer, {size, gl});
  return {size, gl};
}

std::vector<CLI::Option*> addAnswer(CLI::App& app, Answer& answer) {
  CLI::Option* kind = addValue(
      app, "--answer", "KIND",
      [&answer](const std::string& text) { answer = parseNamed(text, "--answer", kAnswerKinds); },
      [&answer] { return answerName(isQuery(answer) ? Answer() : answer); },
      "what algorithms report for a frame: pairs: all pairs; events: pairs that began or ended "
      "since the previous frame");
  suggestValues(kind, kAnswerKinds.names());
  const auto set = [&answer](const std::string& text) {
    const std::optional<Answer> found = findAnswer(text);
    if (!found || !isQuery(*found)) {
      throw InputError(fmt::format("--queries: '{}': KIND:N is expected; KIND: {}; N: 1 to {}",
                                   text, fmt::join(kQueryKinds.names(), ", "), kMaxQueries));
    }
    answer = *found;
  };
  CLI::Option* queries = addValue(
      app, "--queries", "KIND:N", set,
      [&answer] { return isQuery(answer) ? answerName(answer) : std::string(); },
      "answer N queries per frame instead of reporting pairs, e.g. rays:1000; boxes: bodies that "
      "overlap a box; rays: bodies that a ray crosses; sweeps: bodies that a moving box touches; "
      "nearest: the eight bodies nearest to a point");
  queries->excludes(kind);
  return {kind, queries};
}

std::vector<CLI::Option*> addVariants(CLI::App& app, CaseOptions& cases) {
  using Texts = std::vector<std::string>;
  return {
      suggestValues(
          addList(
              app, "--algorithm", "ID[,ID...]", [&](const Texts& ids) { cases.algorithms = ids; },
              [&] { return joined(cases.algorithms); },
              "algorithms: ids, families, patterns such as 'sap*', or all (default; self-checks "
              "must be named)"),
          algorithmIds(builtinAlgorithms())),
      addList(
          app, "--threads", "T[,T...]",
          [&](const Texts& texts) { cases.threads = parseThreads(texts); },
          [&] { return joined(cases.threads); },
          "threads of parallel variants (default: all cores)"),
      suggestValues(addList(
                        app, "--isa", "ISA[,ISA...]",
                        [&](const Texts& names) { cases.isas = parseIsas(names); },
                        [&] { return isaNames(cases.isas); },
                        fmt::format("instruction sets of vectorised variants: auto (default), {}",
                                    fmt::join(kIsas.names(), ", "))),
                    isaChoices())};
}

CLI::Option* addCount(CLI::App& app, CountOptions& count) {
  CLI::Option* option = addValue(
      app, "--count", fmt::format("{}[:FRAMES]", kInstructions),
      [&](const std::string& text) { count = parseCount(text); }, [&] { return countText(count); },
      fmt::format("count the instructions of the first {} frames, or of FRAMES, on one thread, "
                  "instead of measuring times: by the processor's counters if the system allows "
                  "them, else with valgrind",
                  CountOptions().frames));
  return suggestValues(option, {kInstructions});
}

CLI::Option* addFilter(CLI::App& app, std::string& filter) {
  return addText(app, "--filter", "REGEX", filter, "run only cases with a matching id");
}

CLI::Option* addDevice(CLI::App& app, std::string& device) {
  CLI::Option* option = addText(
      app, "--device", "NAME", device,
      "OpenCL device, by number or part of its name (see 'broadmark list devices'; default: the "
      "first, GPUs before CPUs)");
  hideWithout(parts::kOpenCl, {option});
  return option;
}

std::vector<CLI::Option*> addHosts(CLI::App& app, HostOptions& hosts) {
  const HelpGroup group(app, "How to measure");
  CLI::Option* in_process =
      addFlag(app, "--in-process", hosts.in_process,
              "run all cases in this process, for debuggers and profilers, instead of one worker "
              "process per case: a crash or a hang then ends the whole run, and memory is not "
              "measured");
  CLI::Option* pin =
      addFlag(app, "--pin", hosts.pin,
              "bind each thread of a case to its own core, choosing the least busy cores for every "
              "repetition; no effect with more threads than cores, or on a device");
  CLI::Option* hard_limit = addPositive(
      app, "--hard-limit", "SECONDS", hosts.hard_limit_seconds,
      "limit on a single call into an algorithm, after which its process is killed, and on "
      "a frame of a plug-in's engine");
  CLI::Option* memory_limit = addValue(
      app, "--memory-limit", "GIB",
      [&](const std::string& text) {
        hosts.memory_limit_gib = parseNumber(text, "--memory-limit", 0, true);
      },
      [&] { return hosts.memory_limit_gib ? fmt::format("{}", *hosts.memory_limit_gib) : ""; },
      "maximum memory of a case, in GiB (default: the machine's memory)");
  return {in_process, pin->excludes(in_process), hard_limit->excludes(in_process),
          memory_limit->excludes(in_process)};
}

std::string parameterOption(std::string parameter) {
  std::ranges::replace(parameter, '_', '-');
  return fmt::format("--{}", parameter);
}

std::vector<CLI::Option*> addReadingOptions(CLI::App& app, ReadingOptions& options) {
  const HelpGroup group(app, "Imports");
  std::vector<CLI::Option*> added;
  options.visitParameters([&](const Parameter& parameter) {
    const std::string name = parameterOption(std::string(parameter.name));
    const std::string doc(parameter.doc);
    if (bool* const* flag = std::get_if<bool*>(&parameter.value)) {
      added.push_back(addFlag(app, name, **flag, doc));
      return;
    }
    const auto set = [&options, key = std::string(parameter.name), name](const std::string& text) {
      try {
        setParameters(options, {{key, text}});
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", name, error.what()));
      }
    };
    if (parameter.name == "periodic") {
      added.push_back(
          addFlagWithValue(app, name, std::string(kStatedPeriodicBox), options.periodic, doc));
      return;
    }
    std::string type = "NUMBER";
    if (std::holds_alternative<Choice*>(parameter.value)) type = parameterRange(parameter);
    if (std::holds_alternative<std::string*>(parameter.value)) type = "NAME";
    const auto get = [&options, key = std::string(parameter.name)] {
      return parameterValues(options).at(key);
    };
    added.push_back(addValue(app, name, type, set, get, doc));
    if (Choice* const* choice = std::get_if<Choice*>(&parameter.value)) {
      suggestValues(added.back(), (*choice)->options);
    }
  });
  return added;
}

std::vector<CLI::Option*> addSceneOptions(CLI::App& app, SceneOptions& options) {
  std::vector<CLI::Option*> added = {
      addList(
          app, "--objects", "N[,N...]",
          [&](const std::vector<std::string>& texts) {
            options.objects = parseObjectCounts(texts);
          },
          [&] { return joined(options.objects); }, "number of bodies, e.g. 1000,8000,32000"),
      addList(
          app, "--object-type", "TYPE[,TYPE...]",
          [&](const std::vector<std::string>& names) { options.object_types = names; },
          [&] { return joined(options.object_types); }, "shapes of the bodies")};
  suggestValues(added.back(), objectTypeIds());
  for (const SceneShortcut& shortcut : kSceneShortcuts) {
    const std::string name = fmt::format("--{}", shortcut.parameter);
    const auto set = [&options, &shortcut](const std::string& text) {
      options.parameters[shortcut.parameter] = text;
    };
    const auto set_list = [set](const std::vector<std::string>& texts) { set(joined(texts)); };
    const auto get = [&options, &shortcut] {
      const auto stated = options.parameters.find(shortcut.parameter);
      return stated == options.parameters.end() ? "" : stated->second;
    };
    added.push_back(shortcut.list ? addList(app, name, shortcut.type, set_list, get, shortcut.doc)
                                  : addValue(app, name, shortcut.type, set, get, shortcut.doc));
  }
  const auto engine = std::ranges::find_if(
      added, [](const CLI::Option* option) { return option->get_name() == "--engine"; });
  suggestValues(*engine, engineIds());
  return added;
}

}  // namespace broadmark
