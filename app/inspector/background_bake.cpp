#include "inspector/background_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>
#include <utility>

#include "bake_plan.h"
#include "recordings.h"
#include "broadmark/error.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kGlance{20};
constexpr std::uint32_t kMostObjects = 10'000'000;

}  // namespace

std::size_t BackgroundBake::Report::count(Outcome outcome) const {
  return static_cast<std::size_t>(std::ranges::count(items, outcome, &Item::outcome));
}

std::string BackgroundBake::Report::text() const {
  std::string text = fmt::format("{} baked, {} kept", count(Outcome::baked), count(Outcome::kept));
  if (failed() > 0) text += fmt::format(", {} failed", failed());
  if (const std::size_t left = count(Outcome::waiting); left > 0) {
    text += fmt::format(", {} not finished", left);
  }
  return text;
}

std::string_view bakeStateName(BackgroundBake::State state) {
  switch (state) {
    case BackgroundBake::State::idle:
      return "idle";
    case BackgroundBake::State::planning:
      return "planning";
    case BackgroundBake::State::baking:
      return "baking";
    case BackgroundBake::State::done:
      return "done";
    case BackgroundBake::State::cancelled:
      return "cancelled";
    case BackgroundBake::State::failed:
      return "failed";
  }
  return "";
}

BackgroundBake::~BackgroundBake() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

bool BackgroundBake::running() const {
  const std::lock_guard lock(mutex_);
  return report_.state == State::planning || report_.state == State::baking;
}

BackgroundBake::Report BackgroundBake::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void BackgroundBake::begin(std::function<void()> work) {
  if (running()) throw InputError("a batch is being baked: wait for its end, or cancel it");
  if (thread_.joinable()) thread_.join();
  stopping_ = false;
  report_ = {.state = State::planning};
  thread_ = std::thread([this, work = std::move(work)] {
    std::string failure;
    try {
      work();
    } catch (const std::bad_alloc&) {
      failure = "baking: out of memory";
    } catch (const std::exception& error) {
      failure = error.what();
    }
    const std::lock_guard lock(mutex_);
    report_.doing.clear();
    report_.state = !failure.empty() ? State::failed : stopping_ ? State::cancelled : State::done;
    report_.failure = std::move(failure);
    ended_ = true;
  });
}

void BackgroundBake::start(BakeOptions options) {
  begin([this, options = std::move(options)] { planAndBake(options); });
}

void BackgroundBake::start(std::unique_ptr<Simulation> simulation, fs::path path) {
  // std::function wants what can be copied.
  const auto job = std::make_shared<BakeJob>();
  job->scene = simulation->scene();
  job->simulation = std::move(simulation);
  job->paths = {std::move(path)};
  begin([this, job] {
    requireApart(*job->simulation, job->paths);
    {
      const std::lock_guard lock(mutex_);
      report_.items = {{.path = job->paths.front()}};
    }
    std::vector<BakeJob> jobs;
    jobs.push_back(std::move(*job));
    bake(std::move(jobs), 1);
  });
}

void BackgroundBake::planAndBake(const BakeOptions& options) {
  auto plan =
      planBake(options, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        const std::lock_guard lock(mutex_);
        report_.doing = fmt::format("checking {}", path.filename().string());
        report_.fraction = static_cast<float>(number) / static_cast<float>(total);
        return !stopping_;
      });
  if (!plan) return;
  prepare(*plan, options.output);
  {
    const std::lock_guard lock(mutex_);
    for (const fs::path& path : plan->kept) report_.items.push_back({path, Outcome::kept, {}});
    for (const BakeJob& job : plan->pending) {
      for (const fs::path& path : job.paths) report_.items.push_back({.path = path});
    }
  }
  if (!plan->pending.empty()) bake(std::move(plan->pending), options.threads);
}

void BackgroundBake::bake(std::vector<BakeJob> jobs, int threads) {
  BakeBatch batch(std::move(jobs), threads);
  {
    const std::lock_guard lock(mutex_);
    report_.state = State::baking;
  }
  while (!batch.ended()) {
    if (stopping_) batch.cancel();
    for (const BakedJob& job : batch.await(kGlance)) take(job);
    const BatchState state = batch.state();
    const std::lock_guard lock(mutex_);
    report_.doing = state.running;
    report_.seconds_left = state.seconds_left;
    report_.fraction =
        static_cast<float>(static_cast<double>(state.done) /
                           static_cast<double>(std::max<std::uint64_t>(state.total, 1)));
  }
}

void BackgroundBake::take(const BakedJob& job) {
  const std::lock_guard lock(mutex_);
  for (Item& item : report_.items) {
    if (std::ranges::find(job.paths, item.path) == job.paths.end()) continue;
    item.outcome = job.failure.empty() ? Outcome::baked : Outcome::failed;
    item.failure = job.failure;
  }
}

std::vector<std::uint32_t> parseCounts(std::string_view text) {
  std::vector<std::uint32_t> counts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(", ", start), text.size());
    const std::string_view word = text.substr(start, end - start);
    start = end + 1;
    if (word.empty()) continue;
    std::uint32_t count = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || rest != word.data() + word.size() || count < 1 ||
        count > kMostObjects) {
      throw InputError(fmt::format(
          "object counts: '{}' is no count: whole numbers from 1 to {} are, such as 1000, 8000",
          word, kMostObjects));
    }
    counts.push_back(count);
  }
  return counts;
}

}  // namespace broadmark
