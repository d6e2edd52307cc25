// The parent's side: starts the process, exchanges messages with it, and reports how it ended.

#include "broadmark/harness/worker_process.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "broadmark/error.h"
#include "broadmark/harness/child_process.h"
#include "callgrind.h"
#include "worker/protocol.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

/// Grace period before the process is killed.
constexpr std::chrono::seconds kGracePeriod{5};

/// Starts a command with these descriptors as 3, 4, …: its output goes to our standard error, which
/// keeps a plug-in's output out of our results. Throws InputError when it cannot be started.
ChildProcess start(std::vector<std::string> command, std::vector<int> descriptors) {
  descriptors.insert(descriptors.begin(), {-1, STDERR_FILENO, STDERR_FILENO});
  try {
    return {std::move(command), {.descriptors = descriptors}};
  } catch (const InputError& error) {
    throw InputError(fmt::format("worker process: {}", error.what()));
  }
}

/// The command of the process. Under valgrind /proc/self would be valgrind's.
std::vector<std::string> commandOf(const WorkerOptions& options) {
  if (!options.valgrind) return options.command;
  std::vector<std::string> command = options.command;
  if (command.front() == "/proc/self/exe") command.front() = fmt::format("/proc/{}/exe", getpid());
  return callgrind::commandUnder(command);
}

/// Interval for polling `cancelled` during a wait.
constexpr int kPollMilliseconds = 50;

/// The connection to a process; ends the process when destroyed.
class Connection {
 public:
  explicit Connection(const WorkerOptions& options) : Connection(options, worker::openChannel()) {}
  ~Connection() {
    // Closing the channel ends the process, unless it hangs.
    channel_.reset();
    if (alive()) process_.wait(kGracePeriod, options_.cancelled);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  SharedMemory frames;
  SharedMemory answers;
  SharedMemory counts;  ///< of callgrind

  [[nodiscard]] bool alive() const { return process_.alive(); }

  /// Exchanges versions, and sends the case. Returns the answer.
  Json setUp(const Json& case_message) {
    checkVersion();
    return call(case_message, options_.begin_limit);
  }

  /// The answer to a call into the algorithm. Rethrows its exception; else throws as CaseExecutor.
  Json call(const Json& message) { return call(message, options_.hard_limit); }

 private:
  using Seconds = std::chrono::duration<double>;

  void checkVersion() {
    const std::optional<Json> greeting = receive(options_.begin_limit);
    const int version = greeting && greeting->contains("protocol")
                            ? worker::integerOf<int>(greeting->at("protocol"))
                            : 0;
    if (version == worker::kProtocolVersion) return;
    const std::string& program = options_.command.front();
    if (!greeting) {
      throw InputError(fmt::format("{}: cannot serve as a worker process: {}", program,
                                   endText(process_.wait(kGracePeriod))));
    }
    throw InputError(
        fmt::format("{}: uses version {} of the worker protocol, this program version {}", program,
                    version, worker::kProtocolVersion));
  }

  Json call(const Json& message, Seconds limit) {
    if (!channel_->send(message)) fail();
    std::optional<Json> answer = receive(limit);
    if (!answer) fail();
    if (!answer->contains("error")) return std::move(*answer);
    const auto text = answer->at("error").get<std::string>();
    const std::string kind = answer->value("kind", "error");
    if (kind == "input") throw InputError(text);
    if (kind == "unsupported") throw UnsupportedError(text);
    throw std::runtime_error(text);
  }

  Connection(const WorkerOptions& options, worker::ChannelEnds ends)
      : options_(options),
        process_(start(commandOf(options), {ends.there.get(), frames.descriptor(),
                                            answers.descriptor(), counts.descriptor()})),
        channel_(std::in_place, std::move(ends.here)) {}

  /// The next message; nullopt once the process has hung up.
  std::optional<Json> receive(Seconds limit) {
    const auto end = Clock::now() + limit;
    while (!channel_->wait(kPollMilliseconds)) {
      if (options_.cancelled && options_.cancelled()) {
        process_.kill();
        throw Cancelled();
      }
      if (Clock::now() < end) continue;
      process_.kill();
      throw HardLimitError(
          fmt::format("no answer within the hard limit of {:.3g} s", limit.count()));
    }
    try {
      return channel_->receive();
    } catch (const HostError&) {
      process_.kill();
      throw;
    }
  }

  /// Reports the end of the process.
  [[noreturn]] void fail() {
    const int status = process_.wait(kGracePeriod);
    if (options_.valgrind && WIFSIGNALED(status) && WTERMSIG(status) == SIGILL) {
      throw UnsupportedError(
          "an illegal instruction, or one that valgrind does not support (SIGILL)");
    }
    throw HostError(endText(status));
  }

  const WorkerOptions& options_;
  ChildProcess process_;
  std::optional<worker::Channel> channel_;
};

class WorkerProcess final : public CaseExecutor {
 public:
  WorkerProcess(Case test_case, WorkerOptions options)
      : case_(std::move(test_case)), options_(std::move(options)) {}

  std::int64_t start(const SceneInfo& scene, const Frame& first) override {
    report_.processor = {};
    open();
    const std::uint64_t end = connection_->frames.write(first.boxes);
    const Json started = connection_->call(
        {{"call", "start"},
         {"scene", worker::toJson(scene)},
         {"filter", worker::writeFilter(scene.filter, connection_->frames, end)}});
    report_.pinned = started.value("pinned", false);
    return worker::integerOf<std::int64_t>(started.at("initialize_ns"));
  }

  StepResult step(const Frame& frame) override {
    changed_boxes_.clear();
    for (const std::uint32_t body : *frame.changed) changed_boxes_.push_back(frame.boxes[body]);
    std::uint64_t end = connection_->frames.write(*frame.changed);
    end = connection_->frames.write(std::span<const Aabb>(changed_boxes_), end);
    if (!frame.filter_changed.empty()) writeFilterChanges(frame, end);
    const Json answer = connection_->call({{"call", "step"},
                                           {"frame", frame.index},
                                           {"changed", frame.changed->size()},
                                           {"filter_changed", frame.filter_changed.size()}});
    StepResult result{.pairs = worker::integerOf<std::uint64_t>(answer.at("pairs"))};
    worker::readNamed(answer.at("times_ns"), kPhases, result.times);
    return result;
  }

  void stop() override {
    answer_ = {};
    ended_ = {};
    if (!isOpen()) return;
    const Json stopped = call("stop");
    if (!options_.valgrind && !report_.peak_bytes && stopped.at("peak_bytes").is_number()) {
      report_.peak_bytes = worker::integerOf<std::uint64_t>(stopped.at("peak_bytes"));
    }
    report_.heap_bytes.reset();
    if (stopped.contains("heap_bytes")) {
      report_.heap_bytes = worker::integerOf<std::uint64_t>(stopped.at("heap_bytes"));
    }
    report_.processor = {};
    worker::readNamed(stopped.value("processor", Json::object()), kProcessorCounters,
                      report_.processor);
    connection_->frames.clear();
    connection_->answers.clear();
  }

  PairDigest digest() override {
    const Json digest = call("digest");
    return {.count = worker::integerOf<std::uint64_t>(digest.at("count")),
            .hash = worker::integerOf<std::uint64_t>(digest.at("hash"))};
  }

  PairRuns answer() override {
    connection_->answers.read(answer_, worker::integerOf<std::size_t>(call("answer").at("pairs")));
    answer_run_ = answer_;
    return {&answer_run_, 1};
  }

  PairEvents events() override {
    const Json counts = call("events");
    connection_->answers.read(answer_, worker::integerOf<std::size_t>(counts.at("began")));
    connection_->answers.read(ended_, worker::integerOf<std::size_t>(counts.at("ended")),
                              answer_.size() * sizeof(Pair));
    answer_run_ = answer_;
    ended_run_ = ended_;
    return {{&answer_run_, 1}, {&ended_run_, 1}};
  }

  Counts counters() override {
    const Json answer = call("counters");
    report_.private_bytes.reset();
    if (!options_.valgrind && answer.value("private_bytes", Json()).is_number()) {
      report_.private_bytes = worker::integerOf<std::uint64_t>(answer.at("private_bytes"));
    }
    return countsOf(answer);
  }
  Counts setup() override { return countsOf(call("setup")); }
  std::string validate() override { return call("validate").at("broken").get<std::string>(); }

  RecordedDrawing structure() override {
    const Json drawn = call("structure");
    std::vector<RecordedDrawing::Box> boxes;
    std::vector<RecordedDrawing::Segment> lines;
    std::vector<std::uint32_t> tests;
    connection_->answers.read(boxes, worker::integerOf<std::size_t>(drawn.at("boxes")));
    std::uint64_t end = boxes.size() * sizeof(RecordedDrawing::Box);
    connection_->answers.read(lines, worker::integerOf<std::size_t>(drawn.at("lines")), end);
    end += lines.size() * sizeof(RecordedDrawing::Segment);
    if (drawn.contains("tests")) {  // not in older versions
      connection_->answers.read(tests, worker::integerOf<std::size_t>(drawn.at("tests")), end);
    }
    return {std::move(boxes), std::move(lines),
            worker::integerOf<std::size_t>(drawn.at("left_out")), std::move(tests)};
  }

 private:
  void writeFilterChanges(const Frame& frame, std::uint64_t offset) {
    std::vector<BodyGroups> groups;
    for (const std::uint32_t body : frame.filter_changed) {
      groups.push_back(frame.filter->groupsOf(body));
    }
    offset = connection_->frames.write(frame.filter_changed, offset);
    connection_->frames.write(std::span<const BodyGroups>(groups), offset);
  }

  [[nodiscard]] bool isOpen() const { return connection_ && connection_->alive(); }

  /// Starts the process unless it runs.
  void open() {
    if (isOpen()) return;
    connection_ = std::make_unique<Connection>(options_);
    Json message = worker::toJson(case_);
    message["call"] = "case";
    // Under valgrind the limit would be that of valgrind itself.
    message["memory_limit_bytes"] = options_.valgrind ? 0 : options_.memory_limit_bytes;
    message["pin"] = options_.pin;
    const std::string_view counters = kCounterSources.nameOf(
        options_.valgrind ? CounterSource::valgrind : CounterSource::processor);
    message["counters"] = counters;
    const Json answer = connection_->setUp(message);
    if (options_.valgrind && answer.value("counters", std::string()) != counters) {
      throw InputError(fmt::format("{}: this build cannot count instructions under valgrind",
                                   options_.command.front()));
    }
  }

  /// A call without arguments.
  Json call(const char* name) { return connection_->call({{"call", name}}); }

  static Counts countsOf(const Json& answer) {
    Counts counts;
    for (const auto& [counter, count] : answer.at("counts").items()) {
      counts[counter] = worker::integerOf<std::uint64_t>(count);
    }
    return counts;
  }

  Case case_;
  WorkerOptions options_;
  std::unique_ptr<Connection> connection_;
  std::vector<Aabb> changed_boxes_;
  std::vector<Pair> answer_;  ///< for events: the begun pairs
  std::vector<Pair> ended_;
  PairRun answer_run_;
  PairRun ended_run_;
};

}  // namespace

std::unique_ptr<CaseExecutor> makeWorkerProcess(Case test_case, WorkerOptions options) {
  return std::make_unique<WorkerProcess>(std::move(test_case), std::move(options));
}

}  // namespace broadmark
