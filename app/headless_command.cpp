// broadmark --headless: simulate or open recordings, run every case on them, check, measure,
// report.
//
// Recordings are taken one after the other. On each, repetitions of different cases are
// interleaved, so that a disturbance of the machine hits all of them alike. Result files are
// rewritten (each time atomically) after every recording: whatever ends the run, finished cases are
// kept.

#include <fmt/format.h>

#include <iostream>
#include <map>
#include <regex>

#include "case_reference.h"
#include "cases.h"
#include "interrupt.h"
#include "options.h"
#include "plugins.h"
#include "progress.h"
#include "recordings.h"
#include "screenshot.h"
#include "table.h"
#include "broadmark/compute_devices.h"
#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// A recording with the cases to run on it.
struct Job {
  Source source;
  std::vector<Case> cases;
  fs::path screenshot;  ///< "": none
};

std::regex compiledFilter(const std::string& filter) {
  try {
    return std::regex(filter);
  } catch (const std::regex_error&) {
    throw InputError(fmt::format("--filter: '{}' is not a regular expression", filter));
  }
}

/// A --param that nobody has is an error.
void requireKnownParameters(const HeadlessOptions& options, const std::vector<Job>& jobs) {
  std::vector<std::string> known;
  const auto collect = [&](Parametrised& object) {
    std::ranges::move(parameterNames(object), std::back_inserter(known));
  };
  for (const Job& job : jobs) {
    if (job.source.simulation) collect(*job.source.simulation);
    for (const Case& run : job.cases) collect(*run.algorithm.create());
  }
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const auto& [name, value] : options.parameters) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError("--param: " + unknownName("parameter", name, known));
    }
  }
}

void nameScreenshots(const HeadlessOptions& options, std::vector<Job>& jobs) {
  if (options.screenshot.empty() || jobs.empty()) return;
  std::vector<const SceneInfo*> scenes;
  for (const Job& job : jobs) scenes.push_back(&job.source.reference.scene);
  const std::vector<fs::path> paths = screenshotPaths(options.screenshot, scenes);
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i].screenshot = paths[i];
}

/// Every source with the cases asked for.
std::vector<Job> allJobs(const HeadlessOptions& options) {
  const std::vector<Algorithm> algorithms = availableAlgorithms(options.plugins);
  std::vector<Job> jobs;
  if (!options.case_id.empty()) {
    CaseReference one = openCase(options.sources.front(), options.case_id, algorithms);
    jobs.push_back({std::move(one.source), {one.run}, {}});
    return jobs;
  }
  for (Source& source : resolveSources(options)) {
    Job job{std::move(source), {}, {}};
    if (!job.source.settings) {
      job.cases = selectCases(options, algorithms);
    } else if (options.algorithms.empty()) {
      job.cases = {originalCase(*job.source.settings, algorithms)};
    } else {
      throw InputError("--algorithm: a settings file of the original names its own algorithm");
    }
    for (Case& run : job.cases) run.device = options.device;
    jobs.push_back(std::move(job));
  }
  return jobs;
}

/// All jobs, already divided among shards and filtered; jobs without cases are left out.
std::vector<Job> makeJobs(const HeadlessOptions& options) {
  const std::regex filter = compiledFilter(options.filter);
  std::vector<Job> jobs = allJobs(options);
  requireKnownParameters(options, jobs);
  int number = 0;
  for (Job& job : jobs) {
    for (const Case& run : job.cases) beginCase(run, job.source.reference);  // checks parameters
    std::erase_if(job.cases, [&](const Case& run) {
      if (!std::regex_search(caseId(job.source.reference, run), filter)) return true;
      return number++ % options.shard.count != options.shard.index;
    });
  }
  std::erase_if(jobs, [](const Job& job) { return job.cases.empty(); });
  nameScreenshots(options, jobs);
  return jobs;
}

/// Whether an algorithm crossed the time limit on a smaller scene of the same kind: then it is not
/// run on larger ones (the paper's rule).
class Exhausted {
 public:
  void note(const CaseResult& result, const Case& run) {
    if (result.status != Status::timeout) return;
    const std::uint32_t objects = result.recording.scene.objects;
    std::uint32_t& smallest = smallest_.try_emplace(key(result, run), objects).first->second;
    smallest = std::min(smallest, objects);
  }
  /// Gives the result of a case that need not be run.
  bool skip(CaseResult& result, const Case& run) const {
    const auto found = smallest_.find(key(result, run));
    if (found == smallest_.end() || found->second > result.recording.scene.objects) return false;
    result.status = Status::timeout;
    result.reason = fmt::format("not run: crossed the time limit with {} bodies", found->second);
    return true;
  }

 private:
  static std::string key(const CaseResult& result, const Case& run) {
    const SceneInfo& scene = result.recording.scene;
    return fmt::format("{}/{}/{}", scene.name, scene.object_type, caseName(run));
  }
  std::map<std::string, std::uint32_t> smallest_;
};

/// Outcome of all cases of one job.
struct JobResult {
  std::vector<CaseResult> cases;
  bool interrupted = false;
};

/// Runs all repetitions of all cases, interleaved.
JobResult runJob(const Job& job, Recording& recording, Oracle& oracle,
                 const HeadlessOptions& options, Exhausted& exhausted) {
  JobResult outcome;
  for (const Case& run : job.cases) outcome.cases.push_back(beginCase(run, job.source.reference));

  const int passes = options.warmup + options.repetitions;
  const std::uint64_t frames = recording.scene().frames;
  Progress progress(
      fmt::format("running {} N{}", recording.scene().name, recording.scene().objects),
      frames * job.cases.size() * static_cast<std::uint64_t>(passes), options.quiet);
  std::uint64_t steps = 0;
  RunOptions run_options{.check = options.check,
                         .frame_limit_seconds = options.frame_limit_seconds,
                         .cancelled = InterruptGuard::requested,
                         .progress = [&](std::uint32_t frame) { progress.update(steps + frame); }};
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < job.cases.size(); ++i) {
      CaseResult& result = outcome.cases[i];
      progress.detail(job.cases[i].algorithm.id);
      const bool finished = result.status != Status::ok || exhausted.skip(result, job.cases[i]);
      if (!finished && !runRepetition(result, job.cases[i], recording, oracle, run_options,
                                      pass >= options.warmup)) {
        outcome.interrupted = true;
        std::erase_if(outcome.cases, [](const CaseResult& r) {
          return r.status == Status::ok && r.repetitions.empty();
        });
        return outcome;
      }
      exhausted.note(result, job.cases[i]);
      progress.update(steps += frames);
    }
  }
  if (options.memory) {
    for (std::size_t i = 0; i < job.cases.size(); ++i) {
      if (outcome.cases[i].status != Status::ok || InterruptGuard::requested()) continue;
      outcome.cases[i].peak_bytes = measurePeakBytes(job.cases[i], recording);
    }
  }
  return outcome;
}

void writeOutputs(const HeadlessOptions& options, const Results& results) {
  for (const ResultWriter& writer : resultWriters()) {
    const auto output = options.outputs.find(std::string(writer.name));
    if (output != options.outputs.end()) writeTextFile(output->second, writer.format(results));
  }
}

/// Every file that the run will write, with what asks for it.
std::vector<std::pair<std::string, fs::path>> plannedFiles(const HeadlessOptions& options,
                                                           const std::vector<Job>& jobs) {
  std::vector<std::pair<std::string, fs::path>> files;
  for (const auto& [name, path] : options.outputs) files.emplace_back("--" + name, path);
  for (const Job& job : jobs) {
    if (!job.screenshot.empty()) files.emplace_back("--screenshot", job.screenshot);
    if (job.source.settings) files.emplace_back("m_outputLog", job.source.settings->output_log);
  }
  return files;
}

/// Fails now rather than after an hour's run: no such place, or a file that would be overwritten
/// by the run itself.
void requireWritable(const HeadlessOptions& options, const std::vector<Job>& jobs) {
  std::map<fs::path, std::string> taken;
  for (const Job& job : jobs) {
    const fs::path source = job.source.simulation ? job.source.simulation->input()
                                                  : fs::path(job.source.reference.path);
    if (!source.empty()) taken[fs::weakly_canonical(source)] = "a source";
  }
  for (const auto& [option, path] : plannedFiles(options, jobs)) {
    const auto [other, free] = taken.emplace(fs::weakly_canonical(path), option);
    if (!free) {
      throw InputError(fmt::format("{}: {}: already the file of {}: another name is needed", option,
                                   path.string(), other->second));
    }
    AtomicFile probe(path);
  }
}

/// The machine, with the compute device that is used in front of the others.
Environment environmentOf(const std::string& wanted_device) {
  Environment environment = thisEnvironment();
  std::vector<ComputeDevice> devices = computeDevices();
  if (devices.empty() && wanted_device.empty()) return environment;
  const auto chosen =
      devices.begin() + static_cast<std::ptrdiff_t>(chooseDevice(devices, wanted_device));
  std::rotate(devices.begin(), chosen, chosen + 1);
  for (const ComputeDevice& device : devices) {
    environment.compute_devices.push_back(describe(device));
  }
  return environment;
}

/// The frame of the screenshot is in every recording.
void requireFrame(const HeadlessOptions& options, const std::vector<Job>& jobs) {
  for (const Job& job : jobs) {
    const SceneInfo& scene = job.source.reference.scene;
    if (options.screenshot_frame.value_or(0) <= scene.frames) continue;
    throw InputError(fmt::format("--frame: there is no frame {}: the last one of {} is {}",
                                 *options.screenshot_frame, scene.name, scene.frames));
  }
}

/// What a run has left to tell when it ends.
struct Outcome {
  bool failed = false;      ///< a case is not right
  bool no_picture = false;  ///< a screenshot could not be taken
  bool interrupted = false;
  std::vector<fs::path> written;
};

bool isFailure(const CaseResult& result) {
  return result.status == Status::mismatch || result.status == Status::timeout ||
         result.status == Status::error;
}

/// One job from recording to report.
void performJob(Job& job, const HeadlessOptions& options, Results& results, Exhausted& exhausted,
                Outcome& outcome) {
  const auto recording =
      openRecording(job.source, options.record, options.scene.recorders, options.quiet);
  if (!recording) {
    outcome.interrupted = true;
    return;
  }
  Oracle oracle;
  const JobResult done = runJob(job, *recording, oracle, options, exhausted);
  outcome.interrupted = done.interrupted;
  if (done.cases.empty()) return;
  for (const CaseResult& result : done.cases) outcome.failed |= isFailure(result);
  std::cout << formatTable(done.cases) << std::endl;
  if (job.source.settings) {
    const fs::path log = job.source.settings->output_log;
    writeTextFile(log, formatOriginalLog(*job.source.settings, done.cases.front()));
    outcome.written.push_back(log);
  }
  results.cases.insert(results.cases.end(), done.cases.begin(), done.cases.end());
  writeOutputs(options, results);
  if (job.screenshot.empty() || done.interrupted) return;
  try {
    takeScreenshot(options, *recording, oracle, job.screenshot);
    outcome.written.push_back(job.screenshot);
  } catch (const RenderError& error) {
    std::cerr << fmt::format("broadmark: no screenshot: {}\n", error.what());
    outcome.no_picture = true;
  }
}

}  // namespace

int runHeadless(const HeadlessOptions& options) {
  std::vector<Job> jobs = makeJobs(options);
  if (options.list_only) {
    for (const Job& job : jobs) {
      for (const Case& run : job.cases) fmt::print("{}\n", caseId(job.source.reference, run));
    }
    return 0;
  }
  if (jobs.empty()) throw InputError("no case is left to run after --filter and --shard");
  requireFrame(options, jobs);
  requireWritable(options, jobs);
  if (!options.record.empty()) makeDirectory(options.record);

  const InterruptGuard guard;
  Results results{.environment = environmentOf(jobs.front().cases.front().device),
                  .options = options.command_line,
                  .cases = {}};
  Exhausted exhausted;
  Outcome outcome;
  for (Job& job : jobs) {
    performJob(job, options, results, exhausted, outcome);
    if (outcome.interrupted) break;
  }

  if (!options.record.empty()) outcome.written.push_back(options.record);
  if (!results.cases.empty()) {
    for (const auto& [name, path] : options.outputs) outcome.written.push_back(path);
  }
  for (const fs::path& path : outcome.written) fmt::print("written: {}\n", path.string());
  if (outcome.interrupted) {
    throw InputError(fmt::format("interrupted: {} finished cases kept", results.cases.size()));
  }
  if (outcome.no_picture) return 2;
  return outcome.failed ? 1 : 0;
}

}  // namespace broadmark
