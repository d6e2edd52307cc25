#include "request/external_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "broadmark/error.h"
#include "broadmark/harness/child_process.h"
#include "broadmark/harness/shared_memory.h"
#include "broadmark/json_fields.h"
#include "broadmark/names.h"
#include "request/described_parameters.h"
#include "support/line_channel.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kProtocolVersion = 1;

// The program's descriptors after the three standard ones. Opened by these names they are files
// with an offset of their own.
constexpr char kFramesFile[] = "/proc/self/fd/3";
constexpr char kPairsFile[] = "/proc/self/fd/4";

/// A running program.
class Program {
 public:
  explicit Program(const std::string& command) {
    std::array<int, 2> replies{};
    // A socket, as a write to it raises no signal once the program has ended.
    auto [calls, input] = openSockets();
    calls_ = std::move(calls);
    if (::pipe2(replies.data(), O_CLOEXEC) != 0) throw systemError("no pipe");
    replies_ = LineChannel(FileDescriptor(replies[0]));
    const FileDescriptor output(replies[1]);
    // The program ends with this process, even if that is killed. Bash replaces itself by a simple
    // command, to which that applies then.
    process_ = ChildProcess({"setpriv", "--pdeathsig", "KILL", "--", "bash", "-c", command},
                            {.descriptors = {input.get(), output.get(), STDERR_FILENO,
                                             frames.descriptor(), pairs.descriptor()},
                             .own_group = true});
  }
  ~Program() {
    calls_ = FileDescriptor();  // asks the program to end
    constexpr std::chrono::milliseconds kGracePeriod{500};
    if (process_.alive()) process_.wait(kGracePeriod);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// The reply. Throws std::runtime_error with the program's error, or how it ended; and Cancelled.
  Json call(const Json& message, const CancelQuery& cancelled = {}) {
    const std::string line = compactJson(message) + "\n";
    const ssize_t sent = ::send(calls_.get(), line.data(), line.size(), MSG_NOSIGNAL);
    std::optional<std::string> reply;
    if (sent == static_cast<ssize_t>(line.size())) reply = replies_.read(cancelled);
    if (!reply) {
      constexpr std::chrono::seconds kGracePeriod{1};
      throw std::runtime_error(fmt::format("the program {}", endText(process_.wait(kGracePeriod))));
    }
    const Json json = jsonOrNull(*reply);
    if (!json.is_object()) {
      constexpr std::size_t kShown = 80;
      throw std::runtime_error(
          fmt::format("the program replied '{}': a JSON object on one line is expected, and no "
                      "other output on standard output",
                      onOneLine(reply->substr(0, kShown))));
    }
    if (!json.contains("error")) return json;
    const Json& error = json.at("error");
    throw std::runtime_error(error.is_string() ? error.get<std::string>() : compactJson(error));
  }

  SharedMemory frames;  ///< written here
  SharedMemory pairs;   ///< written by the program

 private:
  FileDescriptor calls_;
  LineChannel replies_;
  ChildProcess process_;
};

void requireKnownKeys(const Json& json, const std::string& name,
                      const std::vector<std::string>& known) {
  for (const auto& item : json.items()) {
    if (std::ranges::find(known, item.key()) != known.end()) continue;
    throw InputError(fmt::format("{}: {}", name, unknownName("key", item.key(), known)));
  }
}

struct Description {
  std::string command;
  std::string id;
  std::string family;
  std::string summary;
  std::string principle = "not stated";
  std::string time = "not stated";
  std::string space = "not stated";
  std::string source = command;
  bool parallel = false;
  bool incremental = false;
  std::vector<ParameterDescription> parameters;
  /// A number, or the name of the parameter that is the margin.
  std::variant<double, std::string> margin = 0.0;
};

Description descriptionFrom(const Json& json, const std::string& command) {
  const JsonFields fields(json, "description");
  const auto version = fields.integer<int>("version", 1);
  if (version > kProtocolVersion) {
    throw InputError(
        fmt::format("made for version {} of the protocol, this program supports up to {}", version,
                    kProtocolVersion));
  }
  requireKnownKeys(json, fields.name(),
                   {"version", "id", "family", "summary", "principle", "time", "space", "source",
                    "parallel", "incremental", "parameters", "margin"});
  Description description{.command = command,
                          .id = fields.text("id"),
                          .family = fields.text("family"),
                          .summary = fields.text("summary")};
  const auto read = [](const JsonFields& from, const char* key, auto& value) {
    if (from.has(key)) from.read(key, value);
  };
  read(fields, "principle", description.principle);
  read(fields, "time", description.time);
  read(fields, "space", description.space);
  read(fields, "source", description.source);
  read(fields, "parallel", description.parallel);
  read(fields, "incremental", description.incremental);
  if (fields.has("parameters")) {
    fields.eachObject("parameters", [&](const JsonFields& entry) {
      ParameterDescription parameter{.name = entry.text("name"), .doc = entry.text("doc")};
      entry.read("value", parameter.value);
      read(entry, "min", parameter.min);
      read(entry, "max", parameter.max);
      read(entry, "integer", parameter.is_integer);
      description.parameters.push_back(std::move(parameter));
    });
    for (const Json& entry : json.at("parameters")) {
      requireKnownKeys(entry, fields.path("parameters"),
                       {"name", "doc", "value", "min", "max", "integer"});
    }
  }
  if (!fields.has("margin")) return description;
  if (fields.at("margin").is_number()) {
    description.margin = fields.number("margin");
    return description;
  }
  const std::string name = fields.text("margin");
  if (std::ranges::find(description.parameters, name, &ParameterDescription::name) ==
      description.parameters.end()) {
    throw InputError(
        fmt::format("{}: a number or the name of a parameter is expected", fields.path("margin")));
  }
  description.margin = name;
  return description;
}

class ExternalBroadPhase final : public BroadPhase {
 public:
  explicit ExternalBroadPhase(std::shared_ptr<const Description> description)
      : description_(std::move(description)), parameters_(description_->parameters) {}

  void visitParameters(const ParameterVisitor& visit) override { parameters_.visit(visit); }
  [[nodiscard]] float margin() const override {
    if (const auto* value = std::get_if<double>(&description_->margin)) {
      return static_cast<float>(*value);
    }
    return values().at(std::get<std::string>(description_->margin)).get<float>();
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    program_.emplace(description_->command);
    const Aabb& world = scene.world;
    const std::size_t bodies = writeFrame(first);
    program_->call({{"call", "start"},
                    {"frames_file", kFramesFile},
                    {"pairs_file", kPairsFile},
                    {"max_bodies", scene.objects},
                    {"bodies", bodies},
                    {"threads", execution.threads()},
                    {"world_min", {world.min[0], world.min[1], world.min[2]}},
                    {"world_max", {world.max[0], world.max[1], world.max[2]}},
                    {"parameters", values()}});
  }

  void updateObjects(const Frame& frame) override {
    const auto start = Clock::now();
    const std::size_t bodies = writeFrame(frame);
    call_ = {{"call", "frame"},
             {"frame", frame.index},
             {"bodies", bodies},
             {"changed", frame.changed->size()}};
    overhead_.update_overhead_ns = nanosecondsSince(start);
  }

  void searchOverlaps() override {
    const auto start = Clock::now();
    const Json json = program_->call(call_);
    const std::int64_t taken_ns = nanosecondsSince(start);
    std::int64_t reported_ns = 0;
    try {
      const JsonFields reply(json, "reply to 'frame'");
      program_->pairs.read(pairs_, reply.integer<std::size_t>("pairs"));
      reported_ns = nanosecondsOf(reply.number("seconds"), taken_ns);
    } catch (const std::exception& error) {
      throw std::runtime_error(error.what());  // the program's fault, not that of our input
    }
    run_ = pairs_;
    overhead_.search_overhead_ns = nanosecondsSince(start) - reported_ns;
  }
  [[nodiscard]] PairRuns overlaps() const override { return {&run_, 1}; }
  [[nodiscard]] TransferTimes transfers() const override { return overhead_; }

 private:
  static std::int64_t nanosecondsSince(Clock::time_point start) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
  }

  static std::int64_t nanosecondsOf(double seconds, std::int64_t limit_ns) {
    constexpr double kPerSecond = 1e9;
    if (seconds >= 0 && seconds * kPerSecond <= static_cast<double>(limit_ns)) {
      return static_cast<std::int64_t>(seconds * kPerSecond);
    }
    throw std::runtime_error(
        fmt::format("the program reports {:.6g} s for a frame that took {:.6g} s with all overhead",
                    seconds, static_cast<double>(limit_ns) / kPerSecond));
  }

  [[nodiscard]] Json values() const {
    Json values = Json::object();
    parameters_.eachValue([&](const std::string& name, auto value) { values[name] = value; });
    return values;
  }

  /// Writes the boxes, then the ids of those that changed. Returns the number of boxes.
  std::size_t writeFrame(const Frame& frame) {
    program_->frames.write(*frame.changed, program_->frames.write(frame.boxes));
    return frame.boxes.size();
  }

  std::shared_ptr<const Description> description_;
  DescribedParameters parameters_;
  std::optional<Program> program_;
  Json call_;
  TransferTimes overhead_;
  std::vector<Pair> pairs_;
  PairRun run_;
};

}  // namespace

Algorithm externalAlgorithm(const std::string& command) {
  constexpr std::chrono::seconds kLimit{20};
  const auto end = Clock::now() + kLimit;
  const auto description = std::make_shared<Description>();
  try {
    Program program(command);
    const Json reply = program.call({{"call", "describe"}, {"version", kProtocolVersion}},
                                    [end] { return Clock::now() > end; });
    *description = descriptionFrom(reply, command);
  } catch (const Cancelled&) {
    throw InputError(
        fmt::format("--external: {}: no description within {} s", command, kLimit.count()));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("--external: {}: {}", command, error.what()));
  }
  return {
      .id = description->id,
      .family = description->family + " (self-timed)",
      .summary = description->summary,
      .traits = {.parallel = description->parallel,
                 .incremental = description->incremental,
                 .changing_worlds =
                     description->incremental ? ChangingWorlds::unknown : ChangingWorlds::compacted,
                 // One program for all worlds.
                 .side_by_side_below = std::numeric_limits<std::size_t>::max(),
                 .self_timed = true},
      .description = {.principle = description->principle,
                      .optimisations = "",
                      .time = description->time,
                      .space = description->space,
                      .source = description->source},
      .create = [description] { return std::make_unique<ExternalBroadPhase>(description); },
  };
}

}  // namespace broadmark
