// The command line: what is accepted, and how it is explained.

#include "options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <thread>

#include "recordings.h"
#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {
namespace {

constexpr const char* kFooter =
    "\nWithout --headless and a command the inspector's window opens, on SOURCE if one is given.\n"
    "Exit status: 0 all cases ok; 1 a case mismatched, timed out or regressed; 2 bad usage or "
    "bad input.\n'broadmark COMMAND --help' shows a command's options, --help-all everything.\n"
    "Start with:  broadmark --headless freefall --objects 2000 --frames 60";

/// Text split at commas, empty parts dropped.
std::vector<std::string> splitList(const std::vector<std::string>& texts) {
  std::vector<std::string> parts;
  for (const std::string& text : texts) {
    for (std::size_t start = 0; start <= text.size();) {
      const std::size_t end = std::min(text.find(',', start), text.size());
      if (end > start) parts.push_back(text.substr(start, end - start));
      start = end + 1;
    }
  }
  return parts;
}

/// The value among `values` that is called `text`.
template <class Value>
Value named(std::string_view option, const std::string& text,
            const std::vector<std::pair<std::string, Value>>& values) {
  std::vector<std::string> known;
  for (const auto& [name, value] : values) {
    if (name == text) return value;
    known.push_back(name);
  }
  throw InputError(fmt::format("{}: {}", option, unknownName("value", text, known)));
}

/// A finite number from `min` up, or above it when `open`. (CLI11's own checks let NaN pass.)
double parseNumber(const std::string& text, std::string_view option, double min, bool open) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number =
      error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  if (!number || value < min || (open && value == min)) {
    throw InputError(
        fmt::format("{}: '{}' is not a number {} {}", option, text, open ? ">" : ">=", min));
  }
  return value;
}

/// Which object counts are accepted: those that an .aabbs header can state.
constexpr long long kMaxObjects = 100'000'000;

/// Most passes over a recording, of either kind.
constexpr long long kMaxPasses = 1'000'000;

/// Adds an option that takes a comma-separated list, and may be repeated.
void addList(CLI::App& app, const std::string& name, std::vector<std::string>& target,
             const std::string& doc, const std::string& type) {
  app.add_option(name, target, doc)->type_name(type)->allow_extra_args(false);
}

void addPlugins(CLI::App& app, std::vector<std::string>& plugins) {
  app.add_option("--plugin", plugins,
                 "shared library with more algorithms, which runs as part of the program "
                 "(repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

/// KEY=VALUE texts as parameter values.
ParameterValues keyValues(const std::vector<std::string>& texts) {
  ParameterValues values;
  for (const std::string& text : texts) {
    const auto split = text.find('=');
    if (split == std::string::npos || split == 0) {
      throw InputError(fmt::format("--param: '{}' is not of the form KEY=VALUE", text));
    }
    values[text.substr(0, split)] = text.substr(split + 1);
  }
  return values;
}

std::vector<std::string> recorderIds() {
  std::vector<std::string> ids;
  for (const RecorderListing& recorder : builtinRecorders()) ids.push_back(recorder.id);
  return ids;
}

std::string recorderDoc() {
  return fmt::format("kinds of recordings to keep: {} (default: {})",
                     fmt::join(recorderIds(), ", "), recorderIds().front());
}

/// Each once, in the order given.
std::vector<std::string> parseRecorders(const std::vector<std::string>& texts) {
  const std::vector<std::string> known = recorderIds();
  std::vector<std::string> recorders;
  for (const std::string& text : splitList(texts)) {
    if (std::ranges::find(known, text) == known.end()) {
      throw InputError("--recorder: " + unknownName("recorder", text, known));
    }
    if (std::ranges::find(recorders, text) == recorders.end()) recorders.push_back(text);
  }
  if (recorders.empty()) recorders.push_back(known.front());
  return recorders;
}

/// Scene options as typed, before they are understood; the same for --headless and bake.
struct SceneTexts {
  std::vector<std::string> objects;
  std::vector<std::string> object_types;
  std::vector<std::string> recorders;
  std::vector<std::string> parameters;
  /// Options that are nothing but a shorter way to set a scene parameter.
  struct Shortcut {
    const char* option;
    const char* parameter;
    const char* type;
    const char* doc;
    std::string value;
  };
  std::array<Shortcut, 5> shortcuts = {{
      {"--frames", "frames", "F", "frames to simulate, the initial pose not counted", ""},
      {"--seed", "seed", "S", "seed: same seed, same recording", ""},
      {"--density", "density", "D", "share of the world's volume that bodies fill", ""},
      {"--engine", "engine", "NAME", "what moves the bodies (see 'broadmark list engines')", ""},
      {"--input", "input", "PATH", "recording, or directory of those, that an engine replays", ""},
  }};

  void addTo(CLI::App& app) {
    addList(app, "--objects", objects, "numbers of bodies, e.g. 1000,8000,32000", "N[,N...]");
    addList(app, "--object-type", object_types, "shapes of the bodies", "TYPE[,TYPE...]");
    for (Shortcut& shortcut : shortcuts) {
      app.add_option(shortcut.option, shortcut.value, shortcut.doc)->type_name(shortcut.type);
    }
    addList(app, "--recorder", recorders, recorderDoc(), "KIND[,KIND...]");
    app.add_option("--param", parameters,
                   "sets a parameter of scene or algorithm (repeatable; see 'broadmark list')")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
  }

  [[nodiscard]] SceneOptions parse() const {
    SceneOptions options;
    for (const std::string& text : splitList(objects)) {
      options.objects.push_back(
          static_cast<std::uint32_t>(parseInteger(text, "--objects", 0, kMaxObjects)));
    }
    std::ranges::sort(options.objects);
    options.objects.erase(std::unique(options.objects.begin(), options.objects.end()),
                          options.objects.end());
    options.object_types = splitList(object_types);
    options.recorders = parseRecorders(recorders);
    for (const Shortcut& shortcut : shortcuts) {
      if (!shortcut.value.empty()) options.parameters[shortcut.parameter] = shortcut.value;
    }
    return options;
  }
};

/// --headless options as typed.
struct HeadlessTexts {
  std::vector<std::string> algorithms;
  std::vector<std::string> threads;
  std::vector<std::string> isas;
  std::string repetitions = "1";
  std::string warmup = "0";
  std::string frame_limit = "0.5";
  std::string check = "full";
  std::string frame;
  std::string gl = "auto";
  std::string size = "1280x720";
  std::string shard = "0/1";
  std::map<std::string, std::string> outputs;
};

Shard parseShard(const std::string& text) {
  const auto slash = text.find('/');
  if (slash == std::string::npos) {
    throw InputError(fmt::format("--shard: '{}' is not of the form I/N, e.g. 0/4", text));
  }
  Shard shard;
  shard.count = static_cast<int>(parseInteger(text.substr(slash + 1), "--shard", 1, 1'000'000));
  shard.index =
      static_cast<int>(parseInteger(text.substr(0, slash), "--shard", 0, shard.count - 1));
  return shard;
}

/// The size of a picture, where it is given as "WxH".
void parseSize(const std::string& text, int& width, int& height) {
  const auto x = text.find('x');
  if (x == std::string::npos) {
    throw InputError(fmt::format("--size: '{}' is not of the form WxH, e.g. 1280x720", text));
  }
  width = static_cast<int>(parseInteger(text.substr(0, x), "--size", 1, 16384));
  height = static_cast<int>(parseInteger(text.substr(x + 1), "--size", 1, 16384));
}

GlSource parseGl(const std::string& text) {
  return named<GlSource>(
      "--gl", text,
      {{"auto", GlSource::automatic}, {"egl", GlSource::egl}, {"osmesa", GlSource::osmesa}});
}

std::vector<Isa> parseIsas(const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, Isa>> known = {{"auto", bestIsa()}};
  for (const Isa isa : kAllIsas) known.emplace_back(isaName(isa), isa);
  std::vector<Isa> isas;
  for (const std::string& text : splitList(texts)) isas.push_back(named("--isa", text, known));
  if (isas.empty()) isas.push_back(bestIsa());
  return isas;
}

int allCores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

int parseThreadCount(const std::string& text) {
  return static_cast<int>(parseInteger(text, "--threads", 1, 1024));
}

std::vector<int> parseThreads(const std::vector<std::string>& texts) {
  std::vector<int> threads;
  for (const std::string& text : splitList(texts)) threads.push_back(parseThreadCount(text));
  if (threads.empty()) threads.push_back(allCores());
  return threads;
}

void addHeadlessOptions(CLI::App& app, HeadlessOptions& options, HeadlessTexts& texts) {
  app.add_option("source", options.sources,
                 "built-in scenes (freefall, brownian, …), recordings (.aabbs, .posrot), authored "
                 "scenes (.json), scene parameters (.json, also the one beside a baked recording), "
                 "settings files of the original Broadmark (.json) or a results file (.json) with "
                 "--case")
      ->type_name("SOURCE");
  addList(app, "--algorithm", texts.algorithms,
          "algorithms: ids, families, patterns such as 'sap*', or all (default; the self-checks "
          "only by name)",
          "ID[,ID...]");
  addPlugins(app, options.plugins);
  addList(app, "--threads", texts.threads, "threads of parallel variants (default: all cores)",
          "T[,T...]");
  addList(app, "--isa", texts.isas,
          "instruction sets of vectorised variants: auto (default), scalar, sse2, avx2, avx512",
          "ISA[,ISA...]");

  app.add_option("--device", options.device,
                 "OpenCL device, by number or part of its name (see 'broadmark list devices'; "
                 "default: the first, GPUs before CPUs)")
      ->type_name("NAME");
  app.add_option("--repetitions", texts.repetitions, "measured passes over each recording")
      ->capture_default_str()
      ->type_name("R");
  app.add_option("--warmup", texts.warmup, "unmeasured passes before them")
      ->capture_default_str()
      ->type_name("W");
  app.add_option("--time-limit", texts.frame_limit,
                 "limit on the mean seconds per frame (the paper's cap)")
      ->capture_default_str()
      ->type_name("SECONDS");
  app.add_option("--check", texts.check,
                 "full: compare exact pair sets on every frame; hash: counts and hashes; off")
      ->capture_default_str()
      ->type_name("MODE");
  app.add_flag("--memory", options.memory,
               "measure each case's memory in a separate untimed process (not on OpenCL devices)");
  for (const ResultWriter& writer : resultWriters()) {
    app.add_option(fmt::format("--{}", writer.name), texts.outputs[std::string(writer.name)],
                   std::string(writer.doc))
        ->type_name("FILE");
  }
  app.add_option("--record", options.record, "keep the simulated recordings in this directory")
      ->type_name("DIR");
  app.add_option("--screenshot", options.screenshot,
                 "draw a frame of each recording off-screen; with several recordings their names "
                 "are added to the file's")
      ->type_name("FILE");
  app.add_option("--frame", texts.frame,
                 "frame of the screenshot, 0 being the initial pose (default: the last)")
      ->type_name("K");
  app.add_option("--size", texts.size, "size of the screenshot")
      ->capture_default_str()
      ->type_name("WxH");
  app.add_option("--gl", texts.gl, "where off-screen OpenGL comes from: auto, egl, osmesa")
      ->capture_default_str()
      ->type_name("SOURCE");
  app.add_option("--shard", texts.shard, "run only every N-th case, from the I-th (from 0)")
      ->capture_default_str()
      ->type_name("I/N");
  app.add_option("--filter", options.filter, "run only cases whose id matches")->type_name("REGEX");
  app.add_flag("--list", options.list_only, "print the cases, run nothing");
  app.add_flag("--quiet", options.quiet, "no progress");
}

void addCaseOptions(CLI::App& app, HeadlessOptions& options) {
  CLI::Option* id = app.add_option("--case", options.case_id,
                                   "run this case of the results file that is the source, and "
                                   "nothing else");
  id->type_name("ID");
  app.add_option("--export-case", options.export_case,
                 "instead of running it, find the smallest recording on which that case still "
                 "gives a wrong answer, write it, and print the command that shows it")
      ->type_name("FILE")
      ->needs(id);
}

/// Refuses options that say what `option` says already, or that would be lost on it.
void requireNoneBeside(const CLI::App& app, const std::string& option,
                       const std::vector<std::string>& others) {
  if (app.get_option(option)->count() == 0) return;
  for (const std::string& other : others) {
    if (app.get_option(other)->count() == 0) continue;
    throw InputError(fmt::format("{}: must not stand beside {}", other, option));
  }
}

void requireCaseAlone(const CLI::App& app) {
  requireNoneBeside(
      app, "--case",
      {"--algorithm", "--threads", "--isa", "--device", "--objects", "--object-type", "--frames",
       "--seed", "--density", "--engine", "--input", "--param", "--filter", "--shard"});
  std::vector<std::string> outputs = {"--record", "--screenshot", "--list", "--memory"};
  for (const ResultWriter& writer : resultWriters()) {
    outputs.push_back(fmt::format("--{}", writer.name));
  }
  requireNoneBeside(app, "--export-case", outputs);
}

void addInspectorOptions(CLI::App& app, HeadlessOptions& options) {
  app.add_flag("--ui", options.ui,
               "with --headless: the inspector drawn off-screen (--screenshot)");
  app.add_option("--script", options.script,
                 "what a user does in the inspector, line by line (see docs/inspector.md)")
      ->type_name("FILE");
}

/// What only a run without the inspector heeds would be lost on it.
void requireForInspector(const CLI::App& app, const HeadlessOptions& options) {
  std::vector<std::string> lost = {"--repetitions", "--warmup", "--check",    "--time-limit",
                                   "--memory",      "--record", "--shard",    "--filter",
                                   "--list",        "--frame",  "--recorder", "--export-case"};
  for (const ResultWriter& writer : resultWriters()) {
    lost.push_back(fmt::format("--{}", writer.name));
  }
  if (!options.headless) lost.insert(lost.end(), {"--screenshot", "--size", "--gl"});
  for (const std::string& option : lost) {
    if (app.get_option(option)->count() == 0) continue;
    throw InputError(fmt::format("{}: only for runs without the inspector: {}", option,
                                 options.headless ? "leave out --ui" : "add --headless"));
  }
}

HeadlessOptions understand(HeadlessOptions options, const HeadlessTexts& texts,
                           const SceneTexts& scene) {
  options.scene = scene.parse();
  options.parameters = keyValues(scene.parameters);
  options.algorithms = splitList(texts.algorithms);
  options.threads = parseThreads(texts.threads);
  options.isas = parseIsas(texts.isas);
  options.repetitions =
      static_cast<int>(parseInteger(texts.repetitions, "--repetitions", 1, kMaxPasses));
  options.warmup = static_cast<int>(parseInteger(texts.warmup, "--warmup", 0, kMaxPasses));
  options.frame_limit_seconds = parseNumber(texts.frame_limit, "--time-limit", 0, true);
  if (!texts.frame.empty()) {
    options.screenshot_frame = static_cast<std::uint32_t>(
        parseInteger(texts.frame, "--frame", 0, std::numeric_limits<std::int32_t>::max()));
  }
  options.check = named<CheckMode>(
      "--check", texts.check,
      {{"full", CheckMode::full}, {"hash", CheckMode::hash}, {"off", CheckMode::off}});
  options.gl = parseGl(texts.gl);
  parseSize(texts.size, options.screenshot_width, options.screenshot_height);
  options.shard = parseShard(texts.shard);
  for (const auto& [name, path] : texts.outputs) {
    if (!path.empty()) options.outputs[name] = path;
  }
  if (!options.case_id.empty() && options.sources.size() != 1) {
    throw InputError("--case: the source must be one results file");
  }
  if (options.sources.empty() && options.headless && !options.ui) {
    throw InputError(
        "no source: name a built-in scene (freefall, brownian, gravity) or a recording");
  }
  return options;
}

/// bake options as typed.
struct BakeTexts {
  BakeOptions options;  ///< those that need no understanding
  SceneTexts scene;
  std::vector<std::string> scenes;
  std::string threads;
  MovieOptions movie;
  std::string movie_every = "1";
  std::string size = "1280x720";
  std::string gl = "auto";
};

void addBakeOptions(CLI::App& app, BakeTexts& texts) {
  addList(app, "--scenes", texts.scenes, "built-in scenes (default: all)", "A[,B...]");
  app.add_option("--parameters", texts.options.parameter_files,
                 "bake the scene that this file of scene parameters, the .json beside a recording, "
                 "or an authored scene (.json) describes; other options override it (repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  texts.scene.addTo(app);
  app.add_option("--output", texts.options.output,
                 "directory for the recordings; they go into folders of their kind in it, such as "
                 "Recordings_AABBs/")
      ->type_name("DIR")
      ->required();
  app.add_option("--threads", texts.threads,
                 "recordings baked at the same time (default: all cores); they do not depend on it")
      ->type_name("T");
  CLI::Option* movie =
      app.add_option("--movie", texts.movie.directory,
                     "draw each recording into numbered pictures, in a folder of its name in this "
                     "directory")
          ->type_name("DIR");
  const auto add_movie_option = [&](const char* name, std::string& text, const char* doc,
                                    const char* type) {
    app.add_option(name, text, doc)->capture_default_str()->type_name(type)->needs(movie);
  };
  add_movie_option("--movie-every", texts.movie_every, "frames from one picture to the next", "K");
  add_movie_option("--size", texts.size, "size of the pictures", "WxH");
  add_movie_option("--gl", texts.gl, "where off-screen OpenGL comes from: auto, egl, osmesa",
                   "SOURCE");
  app.add_flag("--list", texts.options.list_only,
               "print what would be baked or kept, with sizes; bake nothing");
  app.add_flag("--force", texts.options.force,
               "bake anew what is already there (default: complete recordings are kept)");
  app.add_flag("--quiet", texts.options.quiet, "no progress");
}

BakeOptions understand(const BakeTexts& texts) {
  BakeOptions options = texts.options;
  options.scenes = splitList(texts.scenes);
  options.scene = texts.scene.parse();
  options.parameters = keyValues(texts.scene.parameters);
  options.threads = texts.threads.empty() ? allCores() : parseThreadCount(texts.threads);
  if (!texts.movie.directory.empty()) {
    options.movie = texts.movie;
    options.movie->every =
        static_cast<std::uint32_t>(parseInteger(texts.movie_every, "--movie-every", 1, 1'000'000));
    parseSize(texts.size, options.movie->width, options.movie->height);
    options.movie->gl = parseGl(texts.gl);
  }
  return options;
}

void addVerifyOptions(CLI::App& app, VerifyOptions& options) {
  app.add_option("files", options.files, "recordings (.aabbs, .posrot)")
      ->type_name("FILE")
      ->required();
  CLI::Option* describe =
      app.add_flag("--describe", options.describe,
                   "also print what each is like, over time: density, pairs per body, share of "
                   "moving bodies, sizes (longest edge of a box), most bodies outside the world");
  app.add_option("--json", options.json, "write that as JSON, too")
      ->type_name("FILE")
      ->needs(describe);
  app.add_flag("--quiet", options.quiet, "no progress");
}

/// Complains about an argument that `app` does not know, with the nearest of what it does.
std::string unexpected(const CLI::App& app, const std::string& argument) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) known.push_back(option->get_name());
  if (!argument.starts_with('-')) return fmt::format("unexpected argument '{}'", argument);
  const std::string name = argument.substr(0, argument.find('='));
  const std::string nearest = nearestName(name, known);
  return fmt::format("unknown option '{}'{}", name,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
}

/// CLI11's own complaint as one line, with the nearest option for a misspelt one.
InputError usageError(const CLI::App& main, const CLI::ParseError& error) {
  const auto chosen = main.get_subcommands();
  const CLI::App& app = chosen.empty() ? main : *chosen.front();
  std::string message = error.what();
  std::ranges::replace(message, '\n', ' ');
  if (!app.remaining().empty()) {
    message = unexpected(app, app.remaining().front());
  }
  const std::string command = chosen.empty() ? "" : app.get_name() + " ";
  return InputError(fmt::format("{}{} (see 'broadmark {}--help')",
                                chosen.empty() ? "" : app.get_name() + ": ", message, command));
}

/// A source that is nothing may be a misspelt command.
void requireNoMisspeltCommand(const CLI::App& app, const std::vector<std::string>& sources) {
  if (sources.empty() || isSource(sources.front())) return;
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const std::string nearest = nearestName(sources.front(), commands);
  if (nearest.empty()) return;
  throw InputError(fmt::format("'{}': did you mean the command '{}'?", sources.front(), nearest));
}

/// Options before a command would be lost on it.
void requireNothingBefore(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) return;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    const std::string command = chosen.front()->get_name();
    throw InputError(fmt::format("{}: must not stand before '{}' (see 'broadmark {} --help')",
                                 option->get_name(), command, command));
  }
}

}  // namespace

int runCommandLine(int argc, char** argv) {
  CLI::App app("Broadmark tests, compares and validates broad-phase collision detection.",
               "broadmark");
  app.footer(kFooter);
  app.set_help_all_flag("--help-all", "Print the help of all commands and exit");
  app.set_version_flag("--version", thisEnvironment().version);
  app.get_formatter()->column_width(34);

  HeadlessOptions options;
  HeadlessTexts texts;
  SceneTexts scene;
  app.add_flag("--headless", options.headless, "run without a window");
  addInspectorOptions(app, options);
  addHeadlessOptions(app, options, texts);
  scene.addTo(app);
  addCaseOptions(app, options);

  BakeTexts bake_texts;
  CLI::App* bake = app.add_subcommand("bake", "Simulates scenes into recordings, in batches.");
  addBakeOptions(*bake, bake_texts);

  ListOptions list_options;
  CLI::App* list = app.add_subcommand("list", "Lists what there is, with its parameters.");
  list->add_option("what", list_options.what,
                   "algorithms, scenes, engines, recorders, devices or all")
      ->capture_default_str();
  addPlugins(*list, list_options.plugins);

  VerifyOptions verify_options;
  CLI::App* verify = app.add_subcommand(
      "verify",
      "Checks recordings, also against what their sidecars say, and tells what is wrong.");
  addVerifyOptions(*verify, verify_options);

  CompareOptions compare_options;
  std::string fail_above = "0.05";
  CLI::App* compare =
      app.add_subcommand("compare", "Compares two result files (JSON) case by case.");
  compare->add_option("before", compare_options.before, "results to compare with")
      ->type_name("A.json")
      ->required();
  compare->add_option("after", compare_options.after, "results to judge")
      ->type_name("B.json")
      ->required();
  compare
      ->add_option("--fail-above", fail_above,
                   "slow-down that counts as a regression, as a share: 0.05 is 5 %")
      ->capture_default_str()
      ->type_name("SHARE");
  app.require_subcommand(0, 1);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw usageError(app, error);
  }
  requireNothingBefore(app);

  if (bake->parsed()) return runBake(understand(bake_texts));
  if (list->parsed()) return runList(list_options);
  if (verify->parsed()) return runVerify(verify_options);
  if (compare->parsed()) {
    compare_options.fail_above = parseNumber(fail_above, "--fail-above", 0, false);
    return runCompare(compare_options);
  }
  requireNoMisspeltCommand(app, options.sources);
  requireCaseAlone(app);
  if (!options.headless || options.ui) {
    requireForInspector(app, options);
    return runInspector(understand(std::move(options), texts, scene));
  }
  options.command_line.assign(argv + 1, argv + argc);
  options = understand(std::move(options), texts, scene);
  return options.export_case.empty() ? runHeadless(options) : runExportCase(options);
}

}  // namespace broadmark
