// This side: starts the process, talks to it, and says how it ended.

#include "broadmark/worker_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <thread>

#include "broadmark/error.h"
#include "worker/protocol.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;
using worker::SharedMemory;

/// How long a process may take to end once it is asked to.
constexpr std::chrono::seconds kPatience{5};
/// How often somebody is asked whether to go on waiting.
constexpr int kPollMilliseconds = 50;

/// "crashed with SIGSEGV (Segmentation fault)"
std::string endText(int wait_status) {
  if (WIFEXITED(wait_status)) {
    return fmt::format("ended its process by itself, with status {}", WEXITSTATUS(wait_status));
  }
  const int signal = WTERMSIG(wait_status);
  const char* name = ::sigabbrev_np(signal);
  const std::string what =
      fmt::format("SIG{} ({})", name == nullptr ? "?" : name, ::sigdescr_np(signal));
  if (signal == SIGKILL) return "killed with " + what + ", perhaps as memory ran out";
  return "crashed with " + what;
}

/// A copy of a descriptor beyond those that a worker process is given.
FileDescriptor movedUp(int descriptor) {
  constexpr int kBeyond = 16;
  return FileDescriptor(::fcntl(descriptor, F_DUPFD_CLOEXEC, kBeyond));
}

/// What a new process does with its descriptors.
class DescriptorPlan {
 public:
  DescriptorPlan() { ::posix_spawn_file_actions_init(&actions_); }
  ~DescriptorPlan() { ::posix_spawn_file_actions_destroy(&actions_); }
  DescriptorPlan(const DescriptorPlan&) = delete;
  DescriptorPlan& operator=(const DescriptorPlan&) = delete;

  void hand(int from, int to) { ::posix_spawn_file_actions_adddup2(&actions_, from, to); }
  void open(int descriptor, const char* path, int flags) {
    ::posix_spawn_file_actions_addopen(&actions_, descriptor, path, flags, 0);
  }
  void closeFrom(int first) { ::posix_spawn_file_actions_addclosefrom_np(&actions_, first); }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// A process of ours. It is killed when this goes.
class ChildProcess {
 public:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  ~ChildProcess() {
    if (pid_ > 0) kill();
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool ended() const { return pid_ == 0; }

  void kill() {
    ::kill(pid_, SIGKILL);
    wait();
  }
  /// Waits for its end, and brings that about when patience is over. Returns how it ended.
  int wait() {
    const auto end = Clock::now() + kPatience;
    int status = 0;
    while (::waitpid(pid_, &status, WNOHANG) == 0) {
      if (Clock::now() > end) ::kill(pid_, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    pid_ = 0;
    return status;
  }

 private:
  pid_t pid_;
};

}  // namespace

class WorkerProcess::Link {
 public:
  explicit Link(const WorkerOptions& options) : Link(options, worker::openChannel()) {}
  ~Link() {
    // Without a channel it ends, unless it hangs.
    channel_.reset();
    if (!process_.ended()) process_.wait();
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  SharedMemory frames;
  SharedMemory answers;

  [[nodiscard]] bool alive() const { return !process_.ended(); }

  /// Introduces both sides.
  void greet() {
    const std::optional<Json> hello = receive();
    const int version = hello ? hello->value("protocol", 0) : 0;
    if (version == worker::kProtocolVersion) return;
    const std::string& program = options_.command.front();
    if (!hello) {
      throw InputError(
          fmt::format("{}: not fit as a worker process: {}", program, endText(process_.wait())));
    }
    throw InputError(fmt::format("{}: speaks version {} of the worker protocol, this program {}",
                                 program, version, worker::kProtocolVersion));
  }

  /// The answer to a call. Throws what the algorithm threw, and as CaseHost says.
  Json call(const Json& message) {
    if (!channel_->send(message)) fail();
    std::optional<Json> answer = receive();
    if (!answer) fail();
    if (!answer->contains("error")) return std::move(*answer);
    const auto text = answer->at("error").get<std::string>();
    const std::string kind = answer->value("kind", "error");
    if (kind == "input") throw InputError(text);
    if (kind == "unsupported") throw UnsupportedError(text);
    throw std::runtime_error(text);
  }

 private:
  Link(const WorkerOptions& options, worker::ChannelEnds ends)
      : options_(options),
        process_(spawn(ends.there.get())),
        channel_(std::in_place, std::move(ends.here)) {}

  [[nodiscard]] pid_t spawn(int channel) const {
    std::vector<std::string> command = options_.command;
    std::vector<char*> arguments;
    for (std::string& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const FileDescriptor there = movedUp(channel);
    const FileDescriptor frames_there = movedUp(frames.descriptor());
    const FileDescriptor answers_there = movedUp(answers.descriptor());
    DescriptorPlan plan;
    plan.open(0, "/dev/null", O_RDONLY);
    // What a plug-in prints is not to stand among our results.
    plan.hand(2, 1);
    plan.hand(there.get(), worker::kChannelDescriptor);
    plan.hand(frames_there.get(), worker::kFramesDescriptor);
    plan.hand(answers_there.get(), worker::kAnswersDescriptor);
    plan.closeFrom(worker::kAnswersDescriptor + 1);
    pid_t pid = 0;
    const int error =
        ::posix_spawn(&pid, arguments.front(), plan.get(), nullptr, arguments.data(), environ);
    if (error != 0) {
      throw InputError(fmt::format("{}: cannot be started as a worker process: {}",
                                   options_.command.front(), std::strerror(error)));
    }
    return pid;
  }

  /// The next message; nothing once the process has hung up.
  std::optional<Json> receive() {
    const auto end = Clock::now() + options_.hard_limit;
    while (!channel_->wait(kPollMilliseconds)) {
      if (options_.cancelled && options_.cancelled()) {
        process_.kill();
        throw Cancelled();
      }
      if (Clock::now() < end) continue;
      process_.kill();
      throw HardLimitError(
          fmt::format("no answer within the hard limit of {:.3g} s", options_.hard_limit.count()));
    }
    try {
      return channel_->receive();
    } catch (const HostError&) {
      process_.kill();
      throw;
    }
  }

  /// The process has hung up.
  [[noreturn]] void fail() { throw HostError(endText(process_.wait())); }

  const WorkerOptions& options_;
  ChildProcess process_;
  std::optional<worker::Channel> channel_;
};

WorkerProcess::WorkerProcess(Case run, WorkerOptions options)
    : case_(std::move(run)), options_(std::move(options)) {}

WorkerProcess::~WorkerProcess() = default;

/// A call that says nothing more.
static auto calling(const char* name) {
  return [name](auto& link) { return link.call({{"call", name}}); };
}

template <class Talk>
auto WorkerProcess::talk(Talk&& talk) {
  try {
    return talk(*link_);
  } catch (...) {
    if (!link_->alive()) link_.reset();
    throw;
  }
}

void WorkerProcess::open() {
  if (link_) return;
  link_ = std::make_unique<Link>(options_);
  talk([&](Link& link) {
    link.greet();
    Json message = worker::toJson(case_);
    message["call"] = "case";
    message["memory_limit_bytes"] = options_.memory_limit_bytes;
    return link.call(message);
  });
}

std::int64_t WorkerProcess::start(const SceneInfo& scene, const Frame& first) {
  open();
  return talk([&](Link& link) {
    link.frames.write(first.boxes);
    const Json started = link.call(
        {{"call", "start"}, {"scene", worker::toJson(scene)}, {"bodies", first.boxes.size()}});
    return started.at("initialize_ns").get<std::int64_t>();
  });
}

FrameRun WorkerProcess::step(const Frame& frame) {
  return talk([&](Link& link) {
    link.frames.write(frame.boxes);
    const Json run =
        link.call({{"call", "step"}, {"frame", frame.index}, {"bodies", frame.boxes.size()}});
    return FrameRun{.times = worker::timesFrom(run.at("times_ns")),
                    .pairs = run.at("pairs").get<std::uint64_t>()};
  });
}

void WorkerProcess::stop() {
  answer_ = {};
  if (!link_) return;
  const Json stopped = talk(calling("stop"));
  if (!peak_bytes_ && stopped.at("peak_bytes").is_number()) {
    peak_bytes_ = stopped.at("peak_bytes").get<std::uint64_t>();
  }
  link_->frames.clear();
  link_->answers.clear();
}

PairDigest WorkerProcess::digest() {
  const Json digest = talk(calling("digest"));
  return {.count = digest.at("count").get<std::uint64_t>(),
          .hash = digest.at("hash").get<std::uint64_t>()};
}

PairRuns WorkerProcess::answer() {
  const auto count = talk(calling("answer")).at("pairs").get<std::size_t>();
  link_->answers.read(answer_, count);
  answer_run_ = answer_;
  return {&answer_run_, 1};
}

Counts WorkerProcess::counters() { return talk(calling("counters")).at("counts").get<Counts>(); }

Counts WorkerProcess::setup() { return talk(calling("setup")).at("counts").get<Counts>(); }

RecordedDrawing WorkerProcess::structure() {
  const Json drawn = talk(calling("structure"));
  std::vector<RecordedDrawing::Box> boxes;
  std::vector<RecordedDrawing::Line> lines;
  link_->answers.read(boxes, drawn.at("boxes").get<std::size_t>());
  link_->answers.read(lines, drawn.at("lines").get<std::size_t>(),
                      boxes.size() * sizeof(RecordedDrawing::Box));
  return {std::move(boxes), std::move(lines), drawn.at("left_out").get<std::size_t>()};
}

}  // namespace broadmark
