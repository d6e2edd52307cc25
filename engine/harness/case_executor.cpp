// Timed calls of an algorithm.

#include "broadmark/harness/case_executor.h"

#include <fmt/format.h>

#include <chrono>

#include "broadmark/adapters.h"
#include "broadmark/cores.h"
#include "broadmark/exclusive_use.h"
#include "callgrind.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t nanoseconds(Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

/// Runs and times the four phases. Nothing else is timed. Null: no queries, but pairs.
FrameTimes runPhases(BroadPhase& algorithm, const Frame& frame, const QueryBatch* queries) {
  FrameTimes times;
  const auto start = Clock::now();
  algorithm.updateObjects(frame);
  const auto updated = Clock::now();
  algorithm.cleanCache();
  const auto cleaned = Clock::now();
  algorithm.updateStructures();
  const auto structured = Clock::now();
  queries == nullptr ? algorithm.searchOverlaps() : algorithm.searchQueries(*queries);
  const auto end = Clock::now();
  times[Phase::update_objects] = nanoseconds(updated - start);
  times[Phase::clean_cache] = nanoseconds(cleaned - updated);
  times[Phase::update_structures] = nanoseconds(structured - cleaned);
  times[Phase::search_overlaps] = nanoseconds(end - structured);
  const TransferTimes transfers = algorithm.transfers();
  times[Phase::upload] = transfers.upload_ns;
  times[Phase::download] = transfers.download_ns;
  times[Phase::update_objects] -= transfers.update_overhead_ns;
  times[Phase::search_overlaps] -= transfers.search_overhead_ns;
  times[Phase::total] =
      nanoseconds(end - start) - transfers.update_overhead_ns - transfers.search_overhead_ns;
  return times;
}

void requireQueries(const Case& test_case, const SceneInfo& scene) {
  const std::vector<AnswerKind>& kinds = test_case.algorithm.traits.queries;
  if (std::ranges::find(kinds, test_case.answer.kind) == kinds.end()) {
    throw UnsupportedError(fmt::format("does not answer queries of the kind {}",
                                       kQueryKinds.nameOf(test_case.answer.kind)));
  }
  if (scene.periodic.repeats()) throw UnsupportedError("queries in periodic worlds");
  if (worldCount(scene) > 1) throw UnsupportedError("queries in several worlds");
}

void requireRunnable(const Case& test_case, const SceneInfo& scene) {
  const AlgorithmTraits& traits = test_case.algorithm.traits;
  if (traits.vectorised && !isaSupported(test_case.isa)) {
    throw UnsupportedError(fmt::format("{} has no {}",
                                       callgrind::isRunning() ? "valgrind" : "this processor",
                                       isaName(test_case.isa)));
  }
  if (scene.objects > traits.max_objects) {
    throw UnsupportedError(
        fmt::format("at most {} bodies, the scene has {}", traits.max_objects, scene.objects));
  }
  if (isQuery(test_case.answer)) return requireQueries(test_case, scene);
  if (isChangingWorld(scene) && traits.changing_worlds == ChangingWorlds::unknown) {
    throw UnsupportedError(scene.all_present && !scene.periodic.repeats()
                               ? "does not support collision filters"
                               : "does not support scenes where bodies appear or disappear");
  }
}

/// Whether the bodies' indices in the algorithm vary between frames.
bool isCompacted(const Case& test_case, const SceneInfo& scene) {
  return test_case.algorithm.traits.changing_worlds == ChangingWorlds::compacted &&
         isChangingWorld(scene);
}

/// Whether each of several worlds gets its own instance.
bool hasInstancePerWorld(const Case& test_case, const SceneInfo& scene) {
  const AlgorithmTraits& traits = test_case.algorithm.traits;
  const std::size_t worlds = worldCount(scene);
  if (worlds < 2) return false;
  if (traits.instance_per_world) return true;
  return traits.changing_worlds == ChangingWorlds::compacted && !traits.on_device &&
         scene.objects / worlds >= traits.side_by_side_below;
}

std::unique_ptr<BroadPhase> makeWorldInstance(const Case& test_case, const SceneInfo& scene) {
  if (scene.periodic.repeats()) {
    return withImages(scene, [test_case](const SceneInfo& images) {
      return makeWorldInstance(test_case, images);
    });
  }
  std::unique_ptr<BroadPhase> instance = makeInstance(test_case);
  if (isCompacted(test_case, scene)) return compacted(std::move(instance));
  if (scene.filter_changes) return withFilterChanges(std::move(instance));
  return instance;
}

CounterVisitor recorderOf(Counts& counts) {
  return [&counts](std::string_view name, std::uint64_t count) { counts.emplace(name, count); };
}

}  // namespace

InProcessExecutor::~InProcessExecutor() {
  const ExclusiveUse exclusive(case_.algorithm.traits.exclusive);
  instance_.reset();
  execution_.reset();
}

std::int64_t InProcessExecutor::start(const SceneInfo& scene, const Frame& first) {
  stop();
  requireRunnable(case_, scene);
  const ExclusiveUse exclusive(case_.algorithm.traits.exclusive);
  report_.processor = {};
  if (!processor_) processor_.emplace(counter_source_);
  processor_->restart();
  if (usable_cores_.empty()) usable_cores_ = usableCores();
  if (!execution_) execution_.emplace(case_.threads, case_.isa, case_.device);
  if (pin_) pinThreads();
  instance_ = makeInstanceFor(scene);
  bodies_ = scene.objects;
  const auto start = Clock::now();
  instance_->initialize(scene, first, *execution_);
  const auto end = Clock::now();
  if (case_.answer == AnswerKind::events) storeAnswer();
  return nanoseconds(end - start);
}

std::unique_ptr<BroadPhase> InProcessExecutor::makeInstanceFor(const SceneInfo& scene) const {
  if (isQuery(case_.answer)) {
    std::unique_ptr<BroadPhase> instance = makeInstance(case_);
    instance->answerQueries(case_.answer.kind);
    return instance;
  }
  const AlgorithmTraits& traits = case_.algorithm.traits;
  const auto make = [this](const SceneInfo& world) { return makeWorldInstance(case_, world); };
  std::unique_ptr<BroadPhase> instance = hasInstancePerWorld(case_, scene)
                                             ? perWorld(scene, make, traits.exclusive.empty())
                                             : make(scene);
  if (case_.answer == AnswerKind::pairs) return instance;
  if (!traits.events || isCompacted(case_, scene) || scene.periodic.repeats()) {
    return withEvents(std::move(instance));
  }
  instance->reportEvents();
  return instance;
}

/// Called once per frame, so that all later queries return the same answer. Returns its size.
std::uint64_t InProcessExecutor::storeAnswer() {
  if (case_.answer == AnswerKind::events) {
    events_ = instance_->events();
    return eventCount(events_);
  }
  answer_ = instance_->overlaps();
  return pairCount(answer_);
}

void InProcessExecutor::pinThreads() {
  // Threads started by the library would inherit the affinity to one core.
  if (case_.algorithm.traits.on_device) return;
  constexpr std::chrono::milliseconds kSampleTime{60};
  const bool has_choice = execution_->threads() < static_cast<int>(usable_cores_.size());
  const std::vector<int> cores =
      quietestCores(execution_->threads(), usable_cores_,
                    has_choice ? measureBusyShares(kSampleTime) : BusyShares(), coreSiblings());
  report_.pinned = execution_->team().pin(cores, usable_cores_);
}

FrameTimes InProcessExecutor::runCounted(const Frame& frame) {
  const bool has_queries = isQuery(case_.answer);
  if (has_queries) queries_ = makeQueries(case_.answer, frame.boxes, frame.index);
  const QueryBatch batch{case_.answer.kind, queries_};
  const ProcessorCounters::Counting counting(*processor_);
  return runPhases(*instance_, frame, has_queries ? &batch : nullptr);
}

StepResult InProcessExecutor::step(const Frame& frame) {
  const ExclusiveUse exclusive(case_.algorithm.traits.exclusive);
  StepResult result{.times = runCounted(frame)};
  result.pairs = storeAnswer();
  return result;
}

void InProcessExecutor::stop() {
  answer_ = {};
  events_ = {};
  if (instance_ == nullptr) return;
  report_.processor = processor_->counts();
  const ExclusiveUse exclusive(case_.algorithm.traits.exclusive);
  instance_.reset();
}

Counts InProcessExecutor::counters() {
  Counts counts;
  instance_->visitCounters(recorderOf(counts));
  return counts;
}

Counts InProcessExecutor::setup() {
  Counts counts;
  instance_->visitSetup(recorderOf(counts));
  return counts;
}

RecordedDrawing InProcessExecutor::structure() {
  RecordedDrawing drawing(bodies_);
  instance_->drawStructure(drawing);
  return drawing;
}

std::string InProcessExecutor::validate() {
  const ExclusiveUse exclusive(case_.algorithm.traits.exclusive);
  return instance_->validate();
}

std::unique_ptr<CaseExecutor> makeInProcessExecutor(const Case& test_case,
                                                    CancelQuery /*cancelled*/) {
  return std::make_unique<InProcessExecutor>(test_case);
}

}  // namespace broadmark
