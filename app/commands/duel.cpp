// broadmark duel: determines which of several variants is fastest, and by how much.

#include "broadmark/analysis/duel.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "broadmark/error.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "compare/duel_report.h"
#include "request/cases.h"
#include "request/hosts.h"
#include "request/plugins.h"
#include "run/plan.h"
#include "run/recordings.h"
#include "run/warnings.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::duel {
namespace {

struct Options : RunRequest {
  std::vector<std::string> variants;
  std::filesystem::path program;  ///< another build of this program; "": none
  DuelOptions duel;
  std::filesystem::path json;  ///< "": none
  bool quiet = false;
};

/// Opens the source of the duel. Throws InputError unless the options name exactly one.
Source open(const Options& options) {
  Plan plan = makePlan(options, PlanUse::open, {});
  if (plan.entries.size() != 1) {
    throw InputError(fmt::format("duel: {} expands to {}; pass exactly one",
                                 options.sources.front(),
                                 counted(plan.entries.size(), "recording")));
  }
  return std::move(plan.entries.front().source);
}

std::vector<DuelSide> sidesOf(const Options& options) {
  std::vector<DuelSide> sides;
  const auto add = [&](const HostOptions& hosts, const std::string& where) {
    for (const std::string& variant : options.variants) {
      sides.push_back({variant + where,
                       caseNamed(variant, options.cases.device, options.cases.answer),
                       executorFactory(hosts)});
    }
  };
  add(options.hosts, "");
  if (!options.program.empty()) {
    HostOptions hosts = options.hosts;
    hosts.program = options.program;
    add(hosts, fmt::format(" ({})", options.program.string()));
  }
  if (sides.size() < 2) {
    throw InputError(
        "duel: needs at least two variants, or one and another build of this program "
        "(--baseline-program)");
  }
  return sides;
}

int exitStatusOf(const DuelResult& result) {
  std::vector<Status> statuses;
  for (const DuelResult::Side& side : result.sides) statuses.push_back(side.status);
  const int status = exitStatusOf(statuses);
  // A side that cannot run here leaves nothing to compare.
  return status == exit_status::success && !result.ok() ? exit_status::bad_input : status;
}

/// Prints warnings about disturbances of any side's times.
void printWarnings(const std::vector<DuelSide>& sides) {
  const Environment environment = thisEnvironment();
  RunWarnings warnings(environment);
  for (const DuelSide& side : sides) warnings.warningsFor(side.test_case);
}

int run(Options options) {
  addEnginesOf(options.plugins, options.hosts.hard_limit_seconds);
  if (!options.json.empty()) requireOutput(options.json);
  const InterruptGuard guard;
  const std::vector<DuelSide> sides = sidesOf(options);
  Source source = open(options);
  const std::unique_ptr<IndexedFrames> recording = openForCommand(source, options.quiet);
  if (recording->scene().frames == 0) {
    throw InputError(fmt::format("duel: {} has no frame to run", options.sources.front()));
  }
  printWarnings(sides);
  constexpr double kTicks = 1000;
  Progress progress("duel", static_cast<std::uint64_t>(kTicks), options.quiet);
  options.duel.cancelled = InterruptGuard::requested;
  options.duel.progress = [&](const DuelResult& now) {
    const double left = std::max(options.duel.max_seconds - now.seconds, 0.0);
    progress.detail(counted(now.rounds(), "round"));
    progress.update(
        static_cast<std::uint64_t>(kTicks * std::min(1.0, now.seconds / options.duel.max_seconds)),
        left);
  };
  const DuelResult result = [&] {
    try {
      return runDuel(sides, *recording, options.duel);
    } catch (const Cancelled&) {
      throw Interrupted();
    }
  }();
  progress.update(static_cast<std::uint64_t>(kTicks));
  if (!isStandardOutput(options.json)) progress.print(formatDuel(result, recording->scene()));
  if (!options.json.empty()) writeOutput(options.json, duelJson(result, source.reference));
  return exitStatusOf(result);
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  addText(app, "source", "SOURCE", options->sources.emplace_back(),
          fmt::format("what to run on, one recording: {}", sourceKindsText()))
      ->required();
  app.add_option("variants", options->variants,
                 "variants to compare, written like case names: ID[/ISA][/tTHREADS]"
                 "[/events][/KEY=VALUE...], e.g. kd-mt/avx2/t2/margin=0.1; from a plug-in: "
                 "PLUGIN.so:ID… or NAME:ID…")
      ->type_name("VARIANT")
      ->required();
  addPath(app, "--baseline-program", "PROGRAM", options->program,
          "also run every variant with this build of broadmark");
  addShare(app, "--precision", options->duel.precision, true,
           "width of the ratios' 95 % intervals at which the duel ends; variants within twice this "
           "are the same");
  addPositive(app, "--max-seconds", "S", options->duel.max_seconds, "stop after this many seconds");
  addNamed(app, "--check", "MODE", options->duel.check, kCheckModes,
           "checks of the first pass: full: exact pair sets; hash: counts and hashes; off");
  addDevice(app, options->cases.device);
  addAnswer(app, options->cases.answer);
  addSceneOptions(app, options->scene);
  addPlugins(app, options->plugins, "physics engines");
  addParameters(app, options->parameters);
  addReadingOptions(app, options->reading);
  addHosts(app, options->hosts);
  addPath(app, "--json", "FILE", options->json,
          "write all times and the verdict as JSON; '-': to standard output, instead of the table");
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "duel",
          .summary = "Finds the fastest of several variants, run in turns on the same frames.",
          .examples = {"duel brownian kd/t2 tide/t2 --objects 8000",
                       "duel recording.aabbs sap-simd/avx2 sap-simd/sse2 --precision 2%"},
          .add = add};
}

}  // namespace broadmark::commands::duel
