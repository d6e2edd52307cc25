// broadmark torture: fuzzes algorithms with random settings on random worlds.

#include "broadmark/fuzz/torture.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/memory_limit.h"
#include "broadmark/recordings/recording.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "commands/torture_log.h"
#include "commands/torture_process.h"
#include "request/cases.h"
#include "request/hosts.h"
#include "request/plugins.h"
#include "run/export_case.h"
#include "run/plan.h"
#include "run/recordings.h"
#include "run/wrong_pairs.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::torture {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Maximum reproducers written per algorithm and kind of fault.
constexpr std::uint64_t kMaxReproducers = 3;

struct Options : RunRequest {
  Options() {
    cases.algorithms = {"all"};
    hosts.hard_limit_seconds = 10;
  }

  bool only_sources = false;
  std::string case_name;  ///< "": all cases
  double minutes = 1;
  std::optional<std::uint64_t> rounds;       ///< limit that replaces `minutes`
  std::optional<std::uint64_t> seed;         ///< nothing: that of the log, or 1
  int jobs = allCores() + 1;                 ///< the threads of a round often wait for each other
  std::optional<std::uint64_t> served_seed;  ///< seed of the rounds that this process serves
  fs::path output = "torture";
  bool quiet = false;
};

class Torture {
 public:
  explicit Torture(Options options)
      : options_(std::move(options)), log_file_(options_.output / "torture.json") {
    selectSubjects();
    if (options_.served_seed) {
      log_.seed = *options_.served_seed;
      options_.quiet = true;
    } else {
      readLog();
    }
    readSources();
    if (!options_.served_seed) makeDirectory(options_.output);
    disableThreadCaches();
    torture_.seed = log_.seed;
    torture_.make_executor = executorFactory(options_.hosts);
    torture_.cancelled = InterruptGuard::requested;
    torture_.is_news = [this](const std::string& algorithm, FaultKind kind) {
      const std::lock_guard lock(mutex_);
      const auto times = log_.times.find({algorithm, std::string(kFaultKinds.nameOf(kind))});
      return times == log_.times.end() || times->second < kMaxReproducers;
    };
  }

  int run() {
    Progress progress("torture", kTicks, options_.quiet);
    replayFound(progress);
    runJobs(progress);
    writeTextFile(log_file_, tortureLogText(log_));
    progress.print(formatTortureLog(log_));
    if (InterruptGuard::requested()) {
      throw Interrupted(fmt::format("the same command resumes from {}", log_file_.string()));
    }
    progress.update(kTicks);
    return log_.times.empty() ? exit_status::success : exit_status::wrong_answer;
  }

  void serve(TortureChannel& channel) {
    limitMemory(memoryLimitBytes(options_.hosts), /*permanent=*/true);
    // Of the parent's limit, as it covers several calls.
    channel.serve(torture_, std::chrono::duration<double>(2 * options_.hosts.hard_limit_seconds));
  }

 private:
  static constexpr std::uint64_t kTicks = 1000;

  static double seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  }

  /// Disables malloc's per-thread caches in worker processes. Malloc counts cached memory as in
  /// use, so with varying sizes the growing caches would be reported as a leak.
  static void disableThreadCaches() {
    const char* const present = std::getenv("GLIBC_TUNABLES");
    const std::string added = "glibc.malloc.tcache_count=0";
    ::setenv("GLIBC_TUNABLES", (present == nullptr ? added : present + (":" + added)).c_str(), 1);
  }

  void selectSubjects() {
    if (!options_.case_name.empty()) {
      torture_.only_case = caseNamed(options_.case_name, "");
      log_.subjects = {options_.case_name};
      addBuild(torture_.only_case->algorithm);
      return;
    }
    const std::vector<Algorithm> known = availableAlgorithms(options_.plugins);
    for (Algorithm& algorithm : selectAlgorithms(options_.cases.algorithms, known, "--algorithm")) {
      if (!algorithm.traits.finds_pairs) continue;
      addBuild(algorithm);
      torture_.algorithms.push_back(std::move(algorithm));
    }
    log_.subjects = algorithmIds(torture_.algorithms);
    if (log_.subjects.empty()) throw InputError("torture: none of these algorithms finds pairs");
  }

  void addBuild(const Algorithm& algorithm) {
    const std::string& hash = algorithm.plugin_build.hash;
    if (!hash.empty() && std::ranges::find(log_.builds, hash) == log_.builds.end()) {
      log_.builds.push_back(hash);
    }
  }

  /// Resumes from an earlier run's log. Starts over, with the faults found, if a plug-in has been
  /// rebuilt since.
  void readLog() {
    log_.seed = options_.seed.value_or(log_.seed);
    if (!fs::exists(log_file_)) return;
    TortureLog log = parseTortureLog(readTextFile(log_file_), log_file_.string());
    const bool is_same =
        log.subjects == log_.subjects && log.seed == options_.seed.value_or(log.seed);
    if (!is_same) {
      throw InputError(
          fmt::format("{}: has other algorithms or another seed ({}): choose another --output",
                      log_file_.string(), log.seed));
    }
    if (log.builds != log_.builds) {
      if (!options_.quiet) fmt::print(stderr, "torture: a plug-in was rebuilt; starting over\n");
      log_.seed = log.seed;
      log_.found = std::move(log.found);
      return;
    }
    log_ = std::move(log);
    repeated_.assign(log_.unfinished.begin(), log_.unfinished.end());
  }

  /// Reruns what was found earlier. Drops what no longer fails.
  void replayFound(Progress& progress) {
    std::map<FaultName, std::uint64_t> left;
    for (FoundFault& fault : std::exchange(log_.found, {})) {
      const FaultName name{fault.algorithm, fault.kind};
      if (InterruptGuard::requested() || stillFails(fault, progress)) {
        ++left[name];
        log_.found.push_back(std::move(fault));
      } else {
        log_.times.erase(name);
      }
    }
    for (const auto& [name, count] : left) log_.times.try_emplace(name, count);
  }

  bool stillFails(const FoundFault& fault, Progress& progress) const {
    const fs::path file = options_.output / fs::path(fault.file).filename();
    std::string outcome = "no longer fails";
    bool fails = false;
    try {
      const std::optional<Fault> found =
          findFault(foundCase(fault), *openRecordingFile(file), torture_,
                    fault.kind == kFaultKinds.nameOf(FaultKind::leak));
      fails = found.has_value();
      if (fails) outcome = "still fails: " + found->text;
      // It need not recur, unless with another build.
      if (!fails && fault.kind == kFaultKinds.nameOf(FaultKind::nondeterministic)) {
        outcome = "does not fail this time";
        fails = log_.next > 0;
      }
    } catch (const Cancelled&) {
      return true;
    } catch (const InputError& error) {
      outcome = fmt::format("cannot be rerun: {}", error.what());
      fails = true;
    }
    progress.print(fmt::format("{}: {}: {}", file.string(), fault.test_case, outcome));
    return fails;
  }

  [[nodiscard]] Case foundCase(const FoundFault& fault) const {
    const Algorithm& algorithm = torture_.only_case
                                     ? torture_.only_case->algorithm
                                     : requireAlgorithm(fault.algorithm, torture_.algorithms);
    return caseNamed(
        algorithm.plugin.empty() ? fault.test_case : algorithm.plugin + ":" + fault.test_case, "");
  }

  void readSources() {
    torture_.only_given = options_.only_sources;
    RunRequest given;
    given.sources = options_.sources;
    for (PlanEntry& entry : makePlan(given, PlanUse::open, {}).entries) {
      torture_.given.push_back(inMemory(*openForCommand(entry.source, options_.quiet)));
    }
  }

  static TortureRecording inMemory(IndexedFrames& recording) {
    TortureRecording copy{.scene = recording.scene(), .frames = {}};
    for (std::uint32_t index = 0; index <= copy.scene.frames; ++index) {
      const Frame frame = recording.at(index);
      copy.frames.emplace_back(frame.boxes.begin(), frame.boxes.end());
      if (copy.scene.filter_changes) copy.filters.push_back(frame.filterIn(copy.scene));
    }
    return copy;
  }

  void runJobs(Progress& progress) {
    const Clock::time_point start = Clock::now();
    const double before = log_.seconds;
    Clock::time_point written = start;
    std::vector<std::future<void>> jobs;
    try {
      for (int i = 0; i < options_.jobs; ++i) {
        jobs.push_back(std::async(std::launch::async, [&] { runRounds(start, progress); }));
      }
      for (std::future<void>& job : jobs) {
        constexpr std::chrono::milliseconds kPollInterval{200};
        for (bool is_ready = false; !is_ready;) {
          is_ready = job.wait_for(kPollInterval) == std::future_status::ready;
          const std::lock_guard lock(mutex_);
          const Clock::time_point now = Clock::now();
          log_.seconds = before + seconds(now - start);
          showProgress(progress, seconds(now - start));
          if (now - written < std::chrono::seconds(10)) continue;
          writeTextFile(log_file_, tortureLogText(log_));
          written = now;
        }
        job.get();
      }
    } catch (...) {
      stopStarting();  // the futures wait for the jobs
      throw;
    }
  }

  void stopStarting() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }

  /// Runs successive rounds. An exception also stops the other threads.
  void runRounds(Clock::time_point start, Progress& progress) {
    try {
      TortureProcess process(log_.seed);
      while (const std::optional<std::uint64_t> number = nextRound(start)) {
        if (options_.hosts.in_process || !options_.hosts.program.empty()) {
          add(runTortureRound(torture_, *number), *number, progress);
        } else {
          runRound(process, *number, progress);
        }
      }
    } catch (const Cancelled&) {
      return;
    } catch (...) {
      stopStarting();
      throw;
    }
  }

  /// Runs a round in the process for many; again, with workers, if it goes wrong.
  void runRound(TortureProcess& process, std::uint64_t number, Progress& progress) {
    TortureProcess::Outcome outcome = process.run(number, torture_.cancelled);
    if (!outcome.suspected) {
      add({.coverage = std::move(outcome.coverage), .finding = {}}, number, progress);
      return;
    }
    // The memory that libraries retain varies.
    if (outcome.suspected->fault.kind == FaultKind::leak) outcome.suspected.reset();
    TortureRound round = runTortureRound(torture_, number, outcome.suspected);
    const bool is_reproduced =
        !round.finding || round.finding->fault.kind != FaultKind::nondeterministic;
    // Else the cause may be what an earlier round has done to the process.
    std::uint64_t found_in = number;
    for (std::size_t i = 0; i < outcome.earlier.size() && !is_reproduced && found_in == number;
         ++i) {
      TortureRound earlier = runTortureRound(torture_, outcome.earlier[i]);
      if (!earlier.finding) continue;
      round.finding = std::move(earlier.finding);
      found_in = outcome.earlier[i];
    }
    add(round, number, progress, found_in);
  }

  std::optional<std::uint64_t> nextRound(Clock::time_point start) {
    const std::lock_guard lock(mutex_);
    stopped_ |= options_.rounds ? started_ >= *options_.rounds
                                : seconds(Clock::now() - start) >= 60 * options_.minutes;
    if (stopped_ || InterruptGuard::requested()) return std::nullopt;
    ++started_;
    if (repeated_.empty()) {
      log_.unfinished.push_back(log_.next);
      return log_.next++;
    }
    const std::uint64_t number = repeated_.front();
    repeated_.pop_front();
    return number;
  }

  /// `found_in`: the round of the finding, if another one.
  void add(const TortureRound& round, std::uint64_t number, Progress& progress,
           std::optional<std::uint64_t> found_in = {}) {
    const std::lock_guard lock(mutex_);
    std::erase(log_.unfinished, number);
    for (const auto& [key, count] : round.coverage) log_.coverage[key] += count;
    if (!round.finding) return;
    const TortureFinding& finding = *round.finding;
    const std::string kind(kFaultKinds.nameOf(finding.fault.kind));
    if (log_.times[{finding.test_case.algorithm.id, kind}]++ >= kMaxReproducers) return;
    log_.found.push_back(write(finding, kind, found_in.value_or(number)));
    progress.print(formatFoundFault(log_.found.back()));
  }

  FoundFault write(const TortureFinding& finding, const std::string& kind, std::uint64_t round) {
    const fs::path file = unusedName(finding.test_case.algorithm.id, kind);
    writeSelection(file, *finding.frames, finding.part);
    FoundFault found{.algorithm = finding.test_case.algorithm.id,
                     .kind = kind,
                     .test_case = caseName(finding.test_case),
                     .world = finding.world,
                     .text = finding.fault.text,
                     .round = round,
                     .file = file.string(),
                     .bodies = finding.part.bodies.size(),
                     .frames = finding.part.frames.size() - 1,
                     .minimal = finding.minimal,
                     .boxes = smallPartText(*finding.frames, finding.part)};
    if (const auto& pair = finding.fault.suspects; pair.size() == 2 && !found.boxes.empty()) {
      found.boxes += fmt::format("  wrong pair: {}-{}\n", pair[0], pair[1]);
    }
    found.command = finding.fault.kind == FaultKind::wrong_answer ||
                            finding.fault.kind == FaultKind::failure ||
                            finding.fault.kind == FaultKind::hang
                        ? reproducingCommand(finding.test_case, file)
                        : tortureCommand(finding.test_case, file);
    return found;
  }

  [[nodiscard]] fs::path unusedName(const std::string& id, std::string kind) const {
    std::ranges::replace(kind, ' ', '-');
    for (int i = 1;; ++i) {
      fs::path file = options_.output / fmt::format("{}-{}-{}.broadmark", id, kind, i);
      if (!fs::exists(file)) return file;
    }
  }

  void showProgress(Progress& progress, double passed) const {
    progress.detail(counted(log_.frames(), "frame"));
    const double share = options_.rounds
                             ? static_cast<double>(started_) / static_cast<double>(*options_.rounds)
                             : passed / (60 * options_.minutes);
    const auto ticks = static_cast<std::uint64_t>(kTicks * std::min(share, 1.0));
    progress.update(ticks);
  }

  Options options_;
  fs::path log_file_;
  TortureLog log_;
  TortureOptions torture_;
  std::mutex mutex_;  ///< guards log_, the progress and the following members
  std::uint64_t started_ = 0;
  bool stopped_ = false;                ///< no more rounds start
  std::deque<std::uint64_t> repeated_;  ///< unfinished rounds of the log that have not restarted
};

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  addRepeatable(app, "source", "SOURCE", options->sources,
                "also fuzz with excerpts of these recordings, meshes or scenes");
  app.add_flag("--only-sources", options->only_sources, "use no other worlds")->needs("source");
  const auto set_algorithms = [options = options.get()](const std::vector<std::string>& parts) {
    options->cases.algorithms = parts;
  };
  CLI::Option* const algorithm =
      addList(app, "--algorithm", "ID[,ID...]", set_algorithms, {},
              "algorithms: ids, families, patterns such as 'sap*', or all (default)");
  suggestValues(algorithm, algorithmIds(builtinAlgorithms()));
  app.add_option("--case", options->case_name,
                 "only this case, written like case names: kd-mt/avx2/t2/margin=0.1")
      ->type_name("CASE")
      ->excludes(algorithm);
  addPlugins(app, options->plugins, "algorithms");
  addExternal(app, options->plugins);
  addPositive(app, "--minutes", "M", options->minutes, "duration; rounds in progress are finished");
  const auto set_rounds = [options = options.get()](const std::string& text) {
    options->rounds = parseInteger(text, "--rounds", 1, 1'000'000'000);
  };
  addValue(app, "--rounds", "N", set_rounds, {},
           "number of rounds, instead of a duration: one case each, on about forty worlds");
  const auto set_seed = [options = options.get()](const std::string& text) {
    options->seed = parseInteger(text, "--seed", 0, std::numeric_limits<std::uint32_t>::max());
  };
  addValue(app, "--seed", "S", set_seed, [] { return "1"; }, "same seed, same rounds");
  addInteger(app, "--jobs", "J", options->jobs, 1, 1024, "rounds run at the same time");
  addPath(app, "--output", "DIR", options->output,
          "folder for recordings of faults, which are rerun first, and for the log "
          "(torture.json), from which the same command resumes (default: torture)");
  addHosts(app, options->hosts);
  addQuiet(app, options->quiet);
  app.add_option("--serve-rounds", options->served_seed)->group("");
  return [options] {
    if (options->served_seed) {
      TortureChannel channel;
      Torture(std::move(*options)).serve(channel);
      return 0;
    }
    const InterruptGuard guard;
    return Torture(std::move(*options)).run();
  };
}

}  // namespace

Command command() {
  return {.name = "torture",
          .summary = "Fuzzes algorithms on random worlds, and shrinks failing cases.",
          .examples = {"torture --minutes 10",
                       "torture --plugin ./libmine.so --algorithm my-sweep --rounds 100"},
          .add = add};
}

}  // namespace broadmark::commands::torture
