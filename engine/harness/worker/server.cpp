// The worker's side: an InProcessExecutor that is called by messages.

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/harness/memory_limit.h"
#include "broadmark/headers_hash.h"
#include "broadmark/large_array.h"
#include "worker/protocol.h"

namespace broadmark {
namespace {

/// Peak resident memory of this process.
std::optional<std::uint64_t> peakBytes() { return statusBytes("VmHWM"); }

/// Resident memory of this process that it does not share. Read in microseconds.
std::uint64_t privateBytes() {
  std::uint64_t size = 0;
  std::uint64_t resident = 0;
  std::uint64_t shared = 0;  // files and shared memory; all in pages
  std::ifstream("/proc/self/statm") >> size >> resident >> shared;
  return (resident - std::min(shared, resident)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Lets the OOM killer pick the worker, not its parent.
void raiseOomScore() { std::ofstream("/proc/self/oom_score_adj") << 1000; }

/// Disables facilities that algorithms do not need. Core dumps: the parent reports the signal of a
/// crash, and a dump of that much memory would fill the disk. Privileges: no program with more
/// rights than the user's (sudo) can be started.
void dropPrivileges() {
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
}

class Server {
 public:
  Server(SharedMemory frames, SharedMemory answers, const AlgorithmFinder& find)
      : find_(find), frames_(std::move(frames)), answers_(std::move(answers)) {}

  Json answer(const Json& message) {
    try {
      const auto call = calls().find(message.at("call").get<std::string>());
      if (call == calls().end()) throw std::runtime_error("unknown call");
      return (this->*call->second)(message);
    } catch (const InputError& error) {
      return failure("input", error.what());
    } catch (const UnsupportedError& error) {
      return failure("unsupported", error.what());
    } catch (...) {
      return failure("error", currentErrorText());
    }
  }

 private:
  using Call = Json (Server::*)(const Json&);
  static const std::map<std::string, Call>& calls() {
    static const std::map<std::string, Call> all = {{"case", &Server::setCase},
                                                    {"start", &Server::start},
                                                    {"step", &Server::step},
                                                    {"digest", &Server::digest},
                                                    {"answer", &Server::pairs},
                                                    {"events", &Server::events},
                                                    {"counters", &Server::counters},
                                                    {"setup", &Server::setup},
                                                    {"structure", &Server::structure},
                                                    {"validate", &Server::validate},
                                                    {"stop", &Server::stop}};
    return all;
  }

  static Json failure(const char* kind, std::string text) {
    constexpr std::size_t kMaxLength = 10'000;
    text.resize(std::min(text.size(), kMaxLength));
    return {{"error", text}, {"kind", kind}};
  }

  Json setCase(const Json& message) {
    started_ = false;
    const auto counters = kCounterSources.find(message.value("counters", std::string()))
                              .value_or(CounterSource::processor);
    executor_.emplace(worker::caseFrom(message, find_), message.value("pin", false), counters);
    const auto limit = worker::integerOf<std::uint64_t>(message.at("memory_limit_bytes"));
    // Sanitizers reserve more than the machine has, and cannot be limited.
    const std::uint64_t used = statusBytes("VmData").value_or(0);
    if (limit != 0 && limit < used && used < machineMemory()) {
      constexpr double kGibibyte = 1 << 30;
      throw InputError(fmt::format(
          "--memory-limit: {:.3g} GiB: a worker process takes {:.3g} GiB before it runs a case",
          static_cast<double>(limit) / kGibibyte, static_cast<double>(used) / kGibibyte));
    }
    limitMemory(limit, /*permanent=*/true);
    return {{"counters", kCounterSources.nameOf(counters)}};
  }

  InProcessExecutor& executor() {
    if (!executor_) throw std::runtime_error("no case has been named");
    return *executor_;
  }

  /// Only during a pass.
  InProcessExecutor& startedExecutor() {
    if (!started_) throw std::runtime_error("no pass has been started");
    return executor();
  }

  Json start(const Json& message) {
    SceneInfo scene = worker::sceneFrom(message.at("scene"));
    frames_.read(boxes_, scene.objects);
    scene.filter =
        worker::readFilter(message.at("filter"), frames_, boxes_.size() * sizeof(Aabb), scene);
    changed_.resize(boxes_.size());  // outside the pass: not the algorithm's memory
    changed_boxes_.resize(boxes_.size());
    if (!measured_) peak_before_ = peakBytes();
    private_before_ = privateBytes();
    filter_ = scene.filter;
    filter_changes_ = scene.filter_changes;
    Frame first{0, boxes_, std::span<const std::uint32_t>()};
    if (filter_changes_) first.filter = &filter_;
    started_ = false;
    const std::int64_t initialize_ns = executor().start(scene, first);
    started_ = true;
    return {{"initialize_ns", initialize_ns}, {"pinned", executor().report().pinned}};
  }

  /// Copies the frame from shared memory to private memory.
  Frame readFrame(const Json& message) {
    frames_.read(changed_, worker::integerOf<std::size_t>(message.at("changed")));
    frames_.read(changed_boxes_, changed_.size(), changed_.size() * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < changed_.size(); ++i) {
      boxes_.at(changed_[i]) = changed_boxes_[i];
    }
    Frame frame{worker::integerOf<std::uint32_t>(message.at("frame")), boxes_, changed_};
    if (filter_changes_) readFilterChanges(message, frame);
    return frame;
  }

  void readFilterChanges(const Json& message, Frame& frame) {
    const std::uint64_t ids_offset = changed_.size() * (sizeof(std::uint32_t) + sizeof(Aabb));
    frames_.read(filter_changed_, worker::integerOf<std::size_t>(message.at("filter_changed")),
                 ids_offset);
    frames_.read(groups_, filter_changed_.size(),
                 ids_offset + filter_changed_.size() * sizeof(std::uint32_t));
    if (std::ranges::any_of(filter_changed_,
                            [this](std::uint32_t body) { return body >= boxes_.size(); })) {
      throw std::out_of_range("filter_changed");
    }
    if (!filter_changed_.empty()) filter_ = filter_.with(filter_changed_, groups_, boxes_.size());
    frame.filter = &filter_;
    frame.filter_changed = filter_changed_;
  }

  Json step(const Json& message) {
    const StepResult result = startedExecutor().step(readFrame(message));
    return {{"times_ns", worker::namedToJson(kPhases, result.times)}, {"pairs", result.pairs}};
  }

  Json digest(const Json& /*message*/) {
    const PairDigest digest = startedExecutor().digest();
    return {{"count", digest.count}, {"hash", digest.hash}};
  }

  Json pairs(const Json& /*message*/) {
    const PairRuns runs = startedExecutor().answer();
    sharePairs(runs, 0);
    return {{"pairs", pairCount(runs)}};
  }

  Json events(const Json& /*message*/) {
    const PairEvents events = startedExecutor().events();
    sharePairs(events.ended, sharePairs(events.began, 0));
    return {{"began", pairCount(events.began)}, {"ended", pairCount(events.ended)}};
  }

  /// Returns the offset behind them.
  std::uint64_t sharePairs(PairRuns runs, std::uint64_t offset) {
    for (const PairRun chunk : runs) offset = answers_.write(chunk, offset);
    return offset;
  }

  Json counters(const Json& /*message*/) {
    const std::uint64_t now = privateBytes();
    const bool is_known = !executor().testCase().algorithm.traits.self_timed;
    return {
        {"counts", startedExecutor().counters()},
        {"private_bytes", is_known ? Json(now - std::min(private_before_, now)) : Json(nullptr)}};
  }
  Json setup(const Json& /*message*/) { return {{"counts", startedExecutor().setup()}}; }

  Json structure(const Json& /*message*/) {
    const RecordedDrawing drawing = startedExecutor().structure();
    std::uint64_t end = answers_.write(std::span(drawing.boxes()));
    end = answers_.write(std::span(drawing.lines()), end);
    answers_.write(std::span(drawing.tests()), end);
    return {{"boxes", drawing.boxes().size()},
            {"lines", drawing.lines().size()},
            {"tests", drawing.tests().size()},
            {"left_out", drawing.dropped()}};
  }

  Json validate(const Json& /*message*/) { return {{"broken", startedExecutor().validate()}}; }

  Json stop(const Json& /*message*/) {
    if (!measured_) measure();
    started_ = false;
    executor().stop();
    // Other workers run while this one waits for its next pass.
    LargeVector<Aabb>().swap(boxes_);
    std::vector<Aabb>().swap(changed_boxes_);
    std::vector<std::uint32_t>().swap(changed_);
    filter_ = {};
    return {{"peak_bytes", peak_growth_ ? Json(*peak_growth_) : Json(nullptr)},
            {"heap_bytes", heapBytes()},
            {"processor", worker::namedToJson(kProcessorCounters, executor().report().processor)}};
  }

  /// Only the first pass is representative: later passes reuse freed memory.
  void measure() {
    measured_ = true;
    if (executor().testCase().algorithm.traits.self_timed) return;
    const auto peak = peakBytes();
    if (peak && peak_before_) peak_growth_ = *peak - *peak_before_;
  }

  const AlgorithmFinder& find_;
  SharedMemory frames_;
  SharedMemory answers_;
  LargeVector<Aabb> boxes_;  ///< of the last frame
  std::vector<std::uint32_t> changed_;
  std::vector<Aabb> changed_boxes_;
  CollisionFilter filter_;  ///< of the last frame, if filters change
  bool filter_changes_ = false;
  std::vector<std::uint32_t> filter_changed_;
  std::vector<BodyGroups> groups_;  ///< of the bodies in filter_changed_
  std::optional<InProcessExecutor> executor_;
  bool started_ = false;
  bool measured_ = false;
  std::uint64_t private_before_ = 0;  ///< before this pass
  std::optional<std::uint64_t> peak_before_;
  std::optional<std::uint64_t> peak_growth_;
};

}  // namespace

void serveCase(const AlgorithmFinder& find) {
  // Ctrl-C is for the parent process. The worker ends when the parent hangs up.
  std::signal(SIGINT, SIG_IGN);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  raiseOomScore();
  dropPrivileges();
  worker::Channel channel{FileDescriptor(worker::kChannelDescriptor)};
  if (!channel.send(
          {{"protocol", worker::kProtocolVersion}, {"program", BROADMARK_VERSION_TEXT}})) {
    throw InputError("'worker' is internal: it is started by broadmark");
  }
  worker::answerCalls(channel, SharedMemory(FileDescriptor(worker::kFramesDescriptor)),
                      SharedMemory(FileDescriptor(worker::kAnswersDescriptor)), find);
}

void worker::answerCalls(Channel& channel, SharedMemory frames, SharedMemory answers,
                         const AlgorithmFinder& find) {
  Server server(std::move(frames), std::move(answers), find);
  while (const std::optional<Json> message = channel.receive()) {
    if (!channel.send(server.answer(*message))) return;
  }
}

}  // namespace broadmark
