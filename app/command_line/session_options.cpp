// The main command's options, each added together with its conflicts.

#include "command_line/session_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>

#include "broadmark/algorithms.h"
#include "broadmark/results/results.h"
#include "command_line/option_types.h"
#include "command_line/usage.h"
#include "sources/make_source.h"
#include "sources/source.h"

namespace broadmark {
namespace {

/// What an option cannot be combined with.
enum Conflict : unsigned {
  kNone = 0,
  kCase = 1,         ///< --case: the results file already states the option's value
  kExport = 2,       ///< --export-case: writes one recording and nothing else
  kInspector = 4,    ///< the inspector: the option affects only runs without it
  kWindow = 8,       ///< a window: the option affects only off-screen pictures
  kRequest = 16,     ///< a run request file: the option applies to a single invocation
  kFixedCount = 32,  ///< --repetitions N: the option affects only --repetitions auto
  kHeadless = 64,    ///< no inspector: the option affects only the inspector
  kNoPicture = 128,  ///< no --screenshot: the option affects only pictures, or the inspector
  kUnchecked = 256,  ///< --check off: there are no wrong pairs to print
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

}  // namespace

SessionParser::SessionParser(CLI::App& app) : app_(app) {
  addSources();
  addCases();
  addRun();
  addOutput();
  addPictures();
  for (const CLI::Option* option : addReadingOptions(app_, options_.reading)) tag(option, kCase);
  addInvocation();
}

void SessionParser::tag(const CLI::Option* option, unsigned conflicts) {
  tagged_.emplace_back(option, conflicts);
}

void SessionParser::addSources() {
  const HelpGroup group(app_, "What to open");
  CLI::Option* source = app_.add_option("source", options_.sources,
                                        fmt::format("what to open: {}", sourceKindsText()))
                            ->type_name("SOURCE")
                            ->default_function([this] {
                              return fmt::format("{}", fmt::join(options_.sources, "\n"));
                            });
  tag(suggestValues(source, sceneIds()), kNone);
  for (CLI::Option* option : addSceneOptions(app_, options_.scene)) tag(option, kCase);
  tag(addParameters(app_, options_.parameters), kCase);
  tag(addPlugins(app_, options_.plugins,
                 "algorithms or physics engines; or pairs:LOG: the pairs that a program logged, "
                 "as an algorithm (see 'broadmark audit')"),
      kNone);
  tag(addExternal(app_, options_.plugins), kRequest);
  addCaseOfResults();
}

void SessionParser::addInvocation() {
  tag(app_.add_flag("--headless", options_.headless, "run without a window"), kRequest);
  tag(addQuiet(app_, options_.quiet), kRequest);
  tag(addPath(app_, "--request", "FILE", options_.request_file,
              "also use the options of this run request (JSON, see docs/run-requests.md; '-': "
              "standard input); command line options override them"),
      kRequest);
  tag(addPath(app_, "--write-request", "FILE", options_.written_request,
              "write the run request ('-': to standard output) and run nothing"),
      kRequest | kExport | kInspector);
}

void SessionParser::addCases() {
  const HelpGroup group(app_, "Algorithms");
  CaseOptions& cases = options_.cases;
  for (const CLI::Option* option : addVariants(app_, cases)) tag(option, kCase);
  const std::vector<CLI::Option*> answer = addAnswer(app_, cases.answer);
  tag(answer.front(), kCase);
  tag(answer.back(), kCase | kInspector);
  tag(addDevice(app_, cases.device), kCase);
  tag(addFilter(app_, options_.filter), kCase | kInspector);
  tag(addValue(
          app_, "--shard", "I/N",
          [&](const std::string& text) { options_.shard = parseShard(text); },
          [&] { return fmt::format("{}/{}", options_.shard.index, options_.shard.count); },
          "run only every N-th case, starting with case I (counted from 0)"),
      kCase | kInspector);
  tag(app_.add_flag("--list", options_.list_only, "print the cases and run nothing"),
      kExport | kInspector | kRequest);
}

void SessionParser::addRun() {
  const HelpGroup group(app_, "How to measure");
  constexpr long long kMaxPasses = 1'000'000;
  RunPolicy& policy = options_.policy;
  RepetitionOptions& repetitions = options_.repetitions;
  const auto set_repetitions = [&](const std::string& text) {
    repetitions.until_precise = text == "auto";
    repetitions.max_count =
        repetitions.until_precise
            ? RepetitionOptions::kMaxUntilPrecise
            : static_cast<int>(parseInteger(text, "--repetitions", 1, kMaxPasses));
  };
  tag(addValue(
          app_, "--repetitions", "R|auto", set_repetitions,
          [&] {
            return repetitions.until_precise ? "auto" : fmt::format("{}", repetitions.max_count);
          },
          fmt::format("measured repetitions of each case; auto: from {} to {}, until its mean "
                      "is precise (see --precision)",
                      RepetitionOptions::kMinUntilPrecise, RepetitionOptions::kMaxUntilPrecise)),
      kInspector);
  tag(addShare(app_, "--precision", repetitions.precision, true,
               "for --repetitions auto: relative width of the mean's 95 % interval"),
      kInspector | kFixedCount);
  tag(addPositive(
          app_, "--max-seconds", "S", repetitions.max_seconds,
          fmt::format("for --repetitions auto: time per recording, after which no case is repeated "
                      "more than {} times",
                      RepetitionOptions::kMinUntilPrecise)),
      kInspector | kFixedCount);
  tag(addInteger(app_, "--order-seed", "S", repetitions.order_seed, 0,
                 std::numeric_limits<long long>::max(),
                 "seed of the interleaving order of cases, which differs in each repetition"),
      kInspector);
  tag(addInteger(app_, "--warmup", "W", repetitions.warmup, 0, kMaxPasses,
                 "unmeasured passes at the start of each repetition, in its process"),
      kInspector);
  tag(addCount(app_, options_.count), kInspector | kExport);
  tag(addPositive(app_, "--time-limit", "SECONDS", policy.frame_limit_seconds,
                  "limit on the mean seconds per frame (the paper's cap)"),
      kInspector);
  tag(addFlag(app_, "--allow-timeout", options_.allow_timeout,
              "do not fail if cases exceed a time limit"),
      kInspector);
  tag(addNamed(app_, "--check", "MODE", policy.check, kCheckModes,
               "full: compare exact pair sets on every frame; hash: counts and hashes; off"),
      kNone);
  for (const CLI::Option* option : addHosts(app_, options_.hosts)) tag(option, kNone);
}

void SessionParser::addOutput() {
  const HelpGroup group(app_, "Results");
  for (const CLI::Option* option : addResultOutputs(app_, options_.outputs)) {
    tag(option, kExport | kInspector);
  }
  tag(addFlag(app_, "--print-pairs", options_.print_pairs,
              "print the wrong pairs of each mismatch, with their frames"),
      kExport | kInspector | kUnchecked);
  CLI::Option* record = addPath(app_, "--record", "DIR", options_.record,
                                "write the simulated recordings to this folder");
  tag(record, kExport | kInspector);
  tag(addRecorders(app_, options_.scene.recorders)->needs(record), kInspector);
}

void SessionParser::addPictures() {
  const HelpGroup group(app_, "Pictures");
  constexpr long long kMaxFrame = std::numeric_limits<std::int32_t>::max();
  CLI::Option* screenshot =
      addPath(app_, "--screenshot", "FILE", options_.screenshot,
              "draw a frame of each recording off-screen; with several recordings, their names "
              "are appended to the file name");
  tag(screenshot, kExport | kWindow);
  const auto set_frame = [this](const std::string& text) {
    options_.frame = static_cast<std::uint32_t>(parseInteger(text, "--frame", 0, kMaxFrame));
  };
  std::string frame_help = "frame of the screenshot, 0 being the initial pose (default: the last)";
  if (parts::kInspector.included) frame_help += "; in the inspector: the first frame shown";
  const auto get_frame = [this] {
    return options_.frame ? fmt::format("{}", *options_.frame) : std::string();
  };
  CLI::Option* frame = addValue(app_, "--frame", "K", set_frame, get_frame, frame_help);
  tag(frame, kNoPicture);
  hideWithout(parts::kRenderer, {screenshot, frame});
  for (const CLI::Option* option : addPictureOptions(app_, options_.picture)) {
    tag(option, kWindow | kNoPicture);
  }
  InspectorOptions& inspector = options_.inspector_options;
  const auto set_camera = [&inspector](const std::string& text) {
    inspector.camera = parseCamera(text);
  };
  const auto get_camera = [&inspector] {
    return inspector.camera ? cameraText(*inspector.camera) : std::string();
  };
  CLI::Option* camera =
      addValue(app_, "--camera", "X,Y,Z,YAW,PITCH,DISTANCE", set_camera, get_camera,
               "the inspector's initial camera: the point it looks at, in a world of size 1 around "
               "0, its angles in degrees, and its distance from that point");
  const auto set_selection = [&inspector](const std::string& text) {
    inspector.selection = parseBodies(text);
  };
  const auto get_selection = [&inspector] {
    return fmt::format("{}", fmt::join(inspector.selection, ","));
  };
  CLI::Option* selection =
      addValue(app_, "--select", "BODY[,BODY...]", set_selection, get_selection,
               "bodies that are selected when the inspector opens");
  CLI::Option* ui =
      app_.add_flag("--ui", options_.ui, "with --headless: draw the inspector off-screen");
  CLI::Option* script = addPath(app_, "--script", "FILE", inspector.script,
                                "script of user actions in the inspector (see docs/inspector.md)");
  tag(ui, kRequest | kWindow);
  for (const CLI::Option* option : {camera, selection, script}) tag(option, kRequest | kHeadless);
  hideWithout(parts::kInspector, {camera, selection, ui, script});
}

void SessionParser::addCaseOfResults() {
  CLI::Option* id = addText(app_, "--case", "ID", options_.case_id,
                            "run only this case of the results file that is the source");
  tag(addPath(app_, "--export-case", "FILE", options_.export_case,
              "instead of running the case, write the smallest recording on which it still gives "
              "a wrong answer, and print a command that reproduces it")
          ->needs(id),
      kInspector | kRequest);
}

void SessionParser::requireNoConflict() const {
  struct Rule {
    bool applies;
    Conflict conflict;
    const char* why;
  };
  const Rule rules[] = {
      {!options_.case_id.empty(), kCase, "cannot be combined with --case, which already sets it"},
      {!options_.export_case.empty(), kExport, "cannot be combined with --export-case"},
      {options_.ui, kInspector, "only for runs without the inspector: omit --ui"},
      {!options_.inspector(), kHeadless, "only for the inspector: add --ui, or omit --headless"},
      {!options_.inspector() && options_.screenshot.empty(), kNoPicture,
       "only for pictures: add --screenshot"},
      {options_.policy.check == CheckMode::off, kUnchecked, "cannot be combined with --check off"},
      {!options_.headless, kInspector, "only for runs without the inspector: add --headless"},
      {!options_.headless, kWindow, "only for pictures drawn off-screen: add --headless"},
      {!options_.repetitions.until_precise, kFixedCount, "only with --repetitions auto"}};
  for (const Rule& rule : rules) {
    if (!rule.applies) continue;
    for (const auto& [option, conflicts] : tagged_) {
      if (option->count() == 0 || (conflicts & rule.conflict) == 0) continue;
      throw InputError(fmt::format("{}: {}", option->get_name(), rule.why));
    }
  }
}

bool SessionParser::isRequestOption(const CLI::Option& option) const {
  return std::ranges::any_of(tagged_, [&](const auto& tagged) {
    return tagged.first == &option && (tagged.second & kRequest) == 0;
  });
}

SessionOptions SessionParser::options() const {
  requireNoConflict();
  SessionOptions options = options_;
  if (!options.screenshot.empty() && options.screenshot.extension() != ".png") {
    throw InputError(fmt::format("--screenshot: '{}': pictures are PNG files: end the name in .png",
                                 options.screenshot.string()));
  }
  if (!options.case_id.empty() && options.sources.size() != 1) {
    throw InputError("--case: the source must be one results file");
  }
  if (parts::kInspector.included && options.headless && options.ui &&
      options.inspector_options.script.empty() && options.screenshot.empty()) {
    throw InputError("--ui: has no effect without --screenshot or --script");
  }
  if (options.inspector() && options.sources.size() > 1) {
    throw InputError(
        fmt::format("'{}': the inspector opens one source; to run several, add --headless",
                    options.sources[1]));
  }
  if (options.sources.empty() && !options.inspector()) {
    throw InputError("no source; expected: " + sourceKindsText());
  }
  return options;
}

}  // namespace broadmark
