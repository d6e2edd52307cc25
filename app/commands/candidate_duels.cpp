#include "commands/candidate_duels.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <utility>

#include "broadmark/harness/runner.h"
#include "support/clock.h"
#include "support/interrupt.h"
#include "support/words.h"

namespace broadmark::commands {
namespace {

/// Candidates that take longer than this times the fastest are dropped after a few frames, unless
/// fewer than kMinDuellists would be left: a few frames do not show everything.
constexpr double kSlow = 4;
constexpr std::size_t kMinDuellists = 6;
constexpr std::size_t kMaxDuellists = 12;
/// Of a duel.
constexpr double kMinFrames = 16;

using Clock = std::chrono::steady_clock;

std::string nameWithoutAnswer(const Candidate& candidate) {
  Case test_case = candidate.test_case;
  test_case.answer = {};
  return caseName(test_case);
}

/// Leaves the fastest.
void keepFastest(std::vector<Candidate>& candidates) {
  std::ranges::stable_sort(candidates, {}, &Candidate::seconds);
  std::size_t count = 0;
  while (
      count < std::min(candidates.size(), kMaxDuellists) &&
      (count < kMinDuellists || candidates[count].seconds < kSlow * candidates.front().seconds)) {
    ++count;
  }
  candidates.resize(count);
}

}  // namespace

std::string nameOf(const Candidate& candidate) { return caseName(candidate.test_case); }

double costOf(const CaseResult& times) { return ratioWithinRun(times, times)->before; }

CandidateDuels::CandidateDuels(const HostOptions& hosts, IndexedFrames& recording,
                               std::function<void(const std::string&)> progress)
    : hosts_(hosts),
      recording_(recording),
      progress_(std::move(progress)),
      make_executor_(executorFactory(hosts)) {}

void CandidateDuels::screen(std::vector<Candidate>& candidates) {
  constexpr double kFirstLimit = 1;  // initialisation takes longer than a frame
  constexpr double kGrowth = 4;
  constexpr std::uint32_t kFrames = 32;
  const Excerpt excerpt = excerptOf(recording_.scene().frames, kFrames);
  SubRecording frames = part(excerpt);
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return hopeless_.contains(nameWithoutAnswer(candidate)) || failed_.contains(nameOf(candidate));
  });
  std::vector<Candidate> done;
  double fastest = std::numeric_limits<double>::infinity();
  for (double limit = kFirstLimit; !candidates.empty(); limit *= kGrowth) {
    limit = std::min(limit, hosts_.hard_limit_seconds);
    std::vector<Candidate> killed;
    for (Candidate& candidate : candidates) {
      // A device's kernels are compiled in the first call.
      const bool on_device = candidate.test_case.algorithm.traits.on_device;
      const Status status =
          runBriefly(candidate, frames, excerpt, on_device ? hosts_.hard_limit_seconds : limit);
      if (status == Status::ok) {
        fastest = std::min(fastest, candidate.seconds);
        done.push_back(std::move(candidate));
      } else if (status == Status::timeout) {
        killed.push_back(std::move(candidate));
      }
    }
    candidates = std::move(killed);
    if (limit >= 2 * kSlow * fastest || limit == hosts_.hard_limit_seconds) break;
  }
  for (const Candidate& candidate : candidates) hopeless_.insert(nameWithoutAnswer(candidate));
  keepFastest(done);
  candidates = std::move(done);
}

/// Runs a few passes over the frames, with a limit on each call, and sets the candidate's times.
Status CandidateDuels::runBriefly(Candidate& candidate, IndexedFrames& frames,
                                  const Excerpt& excerpt, double limit) {
  constexpr int kPasses = 3;
  constexpr double kEnough = 0.1;
  progress_(nameOf(candidate));
  HostOptions hosts = hosts_;
  hosts.hard_limit_seconds = limit;
  CaseRun case_run(candidate.test_case, RunPolicy::unlimited(CheckMode::hash),
                   executorFactory(hosts), InterruptGuard::requested);
  CaseResult result = beginCase(candidate.test_case, {.scene = frames.scene()});
  const Clock::time_point begin = Clock::now();
  for (int pass = 0; pass < kPasses && result.status == Status::ok; ++pass) {
    if (pass > 0 && secondsSince(begin) > kEnough) break;
    const Clock::time_point pass_begin = Clock::now();
    if (!runRepetition(result, case_run, frames, oracle_,
                       {.cancelled = InterruptGuard::requested})) {
      throw Cancelled();
    }
    // Of the last pass: the first one also creates the process.
    candidate.wall_seconds = secondsSince(pass_begin) / frames.scene().frames;
  }
  if (result.status != Status::ok) {
    note(nameOf(candidate), result.status, result.reason);
    return result.status;
  }
  for (Repetition& pass : result.repetitions) {
    std::size_t frame = 0;
    std::erase_if(pass.frames, [&](const FrameTimes&) { return !excerpt.counts[frame++]; });
  }
  candidate.seconds = costOf(result);
  return Status::ok;
}

double CandidateDuels::minSeconds(const std::vector<Candidate>& candidates) {
  double seconds = 0;
  for (const Candidate& candidate : candidates) seconds += kMinFrames * candidate.wall_seconds;
  return seconds;
}

std::vector<std::optional<CaseResult>> CandidateDuels::measure(
    const std::vector<Candidate>& candidates, double seconds) {
  constexpr double kPasses = 3;
  std::vector<std::optional<CaseResult>> results(candidates.size());
  std::vector<std::size_t> left(candidates.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  while (!left.empty()) {
    double wall_seconds = 0;
    std::vector<DuelSide> sides;
    for (const std::size_t i : left) {
      wall_seconds += candidates[i].wall_seconds;
      sides.push_back({nameOf(candidates[i]), candidates[i].test_case, make_executor_});
    }
    // A duel of one is one with itself.
    if (left.size() == 1) sides.push_back(sides.front());
    const std::uint32_t frames = recording_.scene().frames;
    const double wanted = std::max(seconds / (kPasses * wall_seconds), kMinFrames);
    const Excerpt excerpt =
        excerptOf(frames, wanted < frames ? static_cast<std::uint32_t>(wanted) : frames);
    SubRecording stretches = part(excerpt);
    const DuelResult result =
        fight(sides, excerpt.counts.size() < frames ? stretches : recording_, seconds);
    if (result.ok()) {
      describe(result, excerpt);
      for (std::size_t i = 0; i < left.size(); ++i) {
        results[left[i]].emplace().repetitions =
            repetitionsOf(result.sides[i], excerpt, result.processes);
      }
      return results;
    }
    for (std::size_t i = left.size(); i-- > 0;) {
      const DuelResult::Side& side = result.sides[i];
      if (side.status == Status::ok) continue;
      note(side.name, side.status, side.reason);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return results;
}

DuelResult CandidateDuels::fight(const std::vector<DuelSide>& sides, FrameSource& frames,
                                 double seconds) {
  DuelOptions duel;
  duel.precision = kAdviceMargin / 2;
  duel.max_seconds = seconds;
  duel.whole_passes = true;
  duel.cancelled = InterruptGuard::requested;
  duel.progress = [&](const DuelResult& now) {
    progress_(fmt::format("{}, {}", counted(sides.size(), "side"), counted(now.rounds(), "round")));
  };
  return runDuel(sides, frames, duel);
}

SubRecording CandidateDuels::part(const Excerpt& excerpt) {
  const SceneInfo& scene = recording_.scene();
  std::vector<std::uint32_t> bodies(scene.objects);
  std::iota(bodies.begin(), bodies.end(), 0U);
  return {recording_, selectionOf(scene, std::move(bodies), excerpt.frames), scene.name};
}

void CandidateDuels::describe(const DuelResult& result, const Excerpt& excerpt) {
  const std::size_t frames = recording_.scene().frames;
  const std::size_t chosen = excerpt.counts.size();
  const std::size_t passes = result.rounds() / chosen;
  if (chosen == frames) {
    frames_text_ = fmt::format("all frames ({})", frames);
  } else {
    frames_text_ = fmt::format("{} of {}", chosen, counted(frames, "frame"));
    if (excerpt.stretches > 1) {
      frames_text_ += fmt::format(", in {} stretches spread evenly", excerpt.stretches);
    }
  }
  if (passes > 1) frames_text_ += fmt::format(", {} times", passes);
}

/// Notes a failure. Being slow or unsupported is none.
void CandidateDuels::note(const std::string& name, Status status, const std::string& reason) {
  if (status != Status::mismatch && status != Status::error) return;
  if (!failed_.insert(name).second) return;
  new_failures_.push_back(fmt::format("{}: {}: {}", name, statusName(status), reason));
}

}  // namespace broadmark::commands
