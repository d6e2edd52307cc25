#include "commands/torture_process.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "commands/torture_log.h"
#include "support/interrupt.h"

namespace broadmark {
namespace {

constexpr char kWorldStart = '.';

/// This command line, as one that serves rounds.
std::vector<std::string> servingCommand(std::uint64_t seed) {
  const std::string line = readTextFile("/proc/self/cmdline");
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < line.size();) {
    const std::size_t end = line.find('\0', begin);
    words.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  words.front() = "/proc/self/exe";
  words.insert(words.begin() + 2, fmt::format("--serve-rounds={}", seed));
  return words;
}

Fault faultOfEnd(int wait_status) {
  if (WIFEXITED(wait_status)) {
    return {FaultKind::failure, 0, fmt::format("exited with status {}", WEXITSTATUS(wait_status))};
  }
  const int signal = WTERMSIG(wait_status);
  if (signal == SIGALRM) return {FaultKind::hang, 0, "no answer within the hard limit"};
  return {FaultKind::failure, 0, fmt::format("crashed: {}", ::sigdescr_np(signal))};
}

}  // namespace

TortureProcess::Outcome TortureProcess::run(std::uint64_t number, const CancelQuery& cancelled) {
  // Enough to amortise the start. All are suspects if the process ends.
  constexpr std::size_t kMaxRounds = 50;
  if (rounds_.size() == kMaxRounds) end();
  if (!process_.alive()) start(cancelled);
  Outcome outcome{.coverage = {}, .suspected = {}, .earlier = rounds_};
  rounds_.push_back(number);
  const bool sent =
      ::send(lines_.descriptor(), &number, sizeof number, MSG_NOSIGNAL) == sizeof number;
  const std::optional<std::string> reply = sent ? readLine(cancelled) : std::nullopt;
  const std::string unfinished = lines_.unfinished();
  const std::string& text = reply ? *reply : unfinished;
  const auto worlds = static_cast<std::size_t>(
      std::ranges::count(text.substr(0, text.find_first_not_of(kWorldStart)), kWorldStart));
  const std::size_t world = std::max<std::size_t>(worlds, 1) - 1;
  if (!reply) {
    outcome.suspected = {faultOfEnd(end()), world};
    return outcome;
  }
  const std::string name = "torture round";
  const Json json = parseJson(text.substr(worlds), name);
  const JsonFields fields(json, name);
  outcome.coverage = coverageFrom(fields);
  if (fields.has("kind")) {
    const auto kind = kFaultKinds.find(fields.text("kind"));
    outcome.suspected = {{kind.value(), 0, fields.text("text")}, world};
  }
  return outcome;
}

void TortureProcess::start(const CancelQuery& cancelled) {
  auto [here, there] = openSockets();
  process_ = ChildProcess(servingCommand(seed_),
                          {.descriptors = {there.get(), there.get(), STDERR_FILENO}});
  lines_ = LineChannel(std::move(here));
  rounds_.clear();
  there = FileDescriptor();  // its last copy is closed by the end of the process
  if (readLine(cancelled)) return;
  throw InputError(fmt::format("torture: a process for rounds {}", faultOfEnd(end()).text));
}

std::optional<std::string> TortureProcess::readLine(const CancelQuery& cancelled) {
  try {
    return lines_.read(cancelled);
  } catch (const Cancelled&) {
    end();
    throw;
  }
}

int TortureProcess::end() {
  if (!process_.alive()) return 0;
  // One that ended by itself keeps its status: it closed the channel as it ended.
  constexpr std::chrono::seconds kGracePeriod{2};
  lines_ = {};
  return process_.wait(kGracePeriod, InterruptGuard::requested);
}

void TortureChannel::serve(TortureOptions options, std::chrono::duration<double> limit) {
  const auto set_timer = [](double seconds) {
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(seconds);
    timer.it_value.tv_usec = static_cast<suseconds_t>(std::fmod(seconds, 1) * 1e6);
    ::setitimer(ITIMER_REAL, &timer, nullptr);
  };
  const auto send = [this](std::string_view text) {
    return ::write(socket_.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
  };
  options.make_executor = makeInProcessExecutor;
  options.own_process = true;
  options.is_news = [](const std::string&, FaultKind) { return false; };
  options.on_world = [&] { send({&kWorldStart, 1}); };
  // Asked once per frame.
  options.cancelled = [&] {
    set_timer(limit.count());
    return false;
  };
  bool connected = send("\n");
  std::uint64_t number = 0;
  while (connected && ::read(socket_.get(), &number, sizeof number) == sizeof number) {
    options.cancelled();
    const TortureRound round = runTortureRound(options, number);
    set_timer(0);
    Json reply = {{"coverage", toJson(round.coverage)}};
    if (round.finding) {
      reply["kind"] = std::string(kFaultKinds.nameOf(round.finding->fault.kind));
      reply["text"] = round.finding->fault.text;
    }
    connected = send(reply.dump() + "\n");
  }
}

}  // namespace broadmark
