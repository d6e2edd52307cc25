// Calls and replies are lines of JSON; frames, poses and bodies are in shared memory. The parent's
// own simulation is never started: its parameters describe the scene.

#include "request/simulation_process.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/harness/child_process.h"
#include "broadmark/harness/shared_memory.h"
#include "broadmark/json_fields.h"
#include "broadmark/large_array.h"
#include "broadmark/scenes/authored_simulation.h"
#include "request/plugins.h"
#include "support/line_channel.h"

namespace broadmark {
namespace {

constexpr int kMemoryDescriptor = 3;

// Types copied to shared memory as they are.
static_assert(std::is_trivially_copyable_v<Escape> && std::is_trivially_copyable_v<BodyGroups> &&
              std::is_trivially_copyable_v<scenes::AuthoredBody>);

bool send(int socket, const Json& message) {
  const std::string line = compactJson(message) + "\n";
  return ::send(socket, line.data(), line.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(line.size());
}

/// Writes the bodies to the memory, and the rest of the scene to the message: a document of a
/// million bodies would take seconds to parse.
Json writeScene(scenes::AuthoredScene scene, const SharedMemory& memory) {
  const std::vector<scenes::AuthoredBody> bodies = std::move(scene.bodies);
  scene.bodies.clear();
  memory.write(std::span(bodies));
  return {{"scene", formatAuthoredScene(scene)}, {"bodies", bodies.size()}};
}

scenes::AuthoredScene readScene(const Json& message, const SharedMemory& memory) {
  scenes::AuthoredScene scene =
      scenes::parseAuthoredScene(message.at("scene").get<std::string>(), "scene");
  memory.read(scene.bodies, message.at("bodies").get<std::size_t>());
  return scene;
}

/// A simulation with frames from a process.
class SimulationProcess : public Simulation {
 public:
  SimulationProcess(std::unique_ptr<Simulation> simulation, std::string program,
                    CancelQuery cancelled)
      : Simulation(simulation->listing()),
        simulation_(std::move(simulation)),
        program_(std::move(program)),
        cancelled_(std::move(cancelled)) {}

  void visitParameters(const ParameterVisitor& visit) override {
    simulation_->visitParameters(visit);
  }
  [[nodiscard]] const SceneInfo& scene() const override {
    return memory_ ? info_ : simulation_->scene();
  }
  [[nodiscard]] std::filesystem::path input() const override { return simulation_->input(); }
  /// That of the process, as the path may name another file now.
  [[nodiscard]] std::string inputHash() override {
    return memory_ ? call({{"call", "input_hash"}}).at("hash").get<std::string>()
                   : simulation_->inputHash();
  }
  [[nodiscard]] std::span<const Escape> escapes() const override { return escapes_; }

  Frame rewind() override {
    start();
    return frame("rewind");
  }
  std::optional<Frame> next() override {
    if (!memory_) rewind();
    if (index_ == info_.frames) return {};
    ++index_;
    return frame("next");
  }

  std::span<const Aabb> unrotatedBoxes() override {
    return readAll(call({{"call", "unrotated_boxes"}}), unrotated_);
  }
  std::span<const Pose> poses() override { return readAll(call({{"call", "poses"}}), poses_); }

 protected:
  /// The reply. Throws Cancelled, and InputError with the error or the end of the process.
  Json call(const Json& message) {
    if (!failure_.empty()) throw InputError(failure_);
    std::optional<std::string> reply;
    try {
      if (send(replies_.descriptor(), message)) reply = replies_.read(cancelled_);
    } catch (const Cancelled&) {
      process_.kill();
      failure_ = fmt::format("{}: cancelled in frame {}", info_.name, index_);
      throw;
    }
    if (!reply) {
      constexpr std::chrono::seconds kGracePeriod{5};
      const std::string end = endText(process_.wait(kGracePeriod, cancelled_));
      failure_ = fmt::format("{}: frame {}: engine '{}' {}", info_.name, index_, engine(), end);
      throw InputError(failure_);
    }
    Json json = parseJson(*reply, "simulation process");
    if (json.contains("error")) throw InputError(json.at("error").get<std::string>());
    return json;
  }

  [[nodiscard]] const SharedMemory& memory() const { return *memory_; }

 private:
  std::string engine() { return parameterValues(*simulation_)["engine"]; }

  /// Starts a process with the current parameters; ends an earlier one.
  void start() {
    info_ = simulation_->scene();
    index_ = 0;
    escapes_.clear();
    failure_.clear();
    auto [here, there] = openSockets();
    memory_.emplace();
    process_ = ChildProcess(
        {program_, "simulate"},
        {.descriptors = {there.get(), STDERR_FILENO, STDERR_FILENO, memory_->descriptor()}});
    replies_ = LineChannel(std::move(here));
    there = FileDescriptor();  // closed by the end of the process
    Json message = {{"scene", ""}};
    if (auto* authored = dynamic_cast<scenes::SceneDocument*>(simulation_.get())) {
      message = writeScene(authored->document(), *memory_);
    } else {
      message["scene"] = formatSceneParameters(*simulation_);
    }
    message["call"] = "open";
    message["plugins"] = Json::array();
    for (const EngineListing& listing : availableEngines()) {
      if (listing.id == engine() && !listing.plugin.empty()) {
        message["plugins"].push_back(listing.plugin);
      }
    }
    call(message);
  }

  /// After a failure there are no further frames.
  Frame frame(const char* name) {
    try {
      return readFrame(call({{"call", name}}));
    } catch (const InputError& error) {
      failure_ = error.what();
      throw;
    }
  }

  Frame readFrame(const Json& reply) {
    const auto count = [&](const char* name) { return reply.at(name).get<std::size_t>(); };
    std::uint64_t offset = 0;
    const auto read = [&](auto& items, std::size_t number) {
      memory_->read(items, number, offset);
      offset += std::span(items).size_bytes();
    };
    read(boxes_, info_.objects);
    std::vector<Escape> escapes;
    read(escapes, count("escapes"));
    escapes_.insert(escapes_.end(), escapes.begin(), escapes.end());
    Frame frame{index_, boxes_};
    if (!reply.at("changed").is_null()) {
      read(changed_, count("changed"));
      frame.changed = changed_;
    }
    if (!info_.filter_changes) return frame;
    std::vector<BodyGroups> groups;
    read(groups, info_.objects);
    filter_ = CollisionFilter(groups, info_.filter.matrix(), true);
    frame.filter = &filter_;
    read(filter_changed_, count("filter_changed"));
    frame.filter_changed = filter_changed_;
    return frame;
  }

  template <class Item>
  std::span<const Item> readAll(const Json& reply, std::vector<Item>& items) {
    memory_->read(items, reply.at("items").get<std::size_t>());
    return items;
  }

  std::unique_ptr<Simulation> simulation_;  ///< describes the scene; never started
  const std::string program_;
  const CancelQuery cancelled_;
  std::optional<SharedMemory> memory_;  ///< set by the first start()
  LineChannel replies_;
  ChildProcess process_;
  std::string failure_;  ///< why no call is possible
  SceneInfo info_;
  std::uint32_t index_ = 0;  ///< of the last frame
  LargeVector<Aabb> boxes_;
  std::vector<std::uint32_t> changed_;
  CollisionFilter filter_;
  std::vector<std::uint32_t> filter_changed_;
  std::vector<Escape> escapes_;
  std::vector<Aabb> unrotated_;
  std::vector<Pose> poses_;
};

/// The same with frames that can be converted to authored scenes.
class SceneProcess final : public SimulationProcess, public scenes::SceneSource {
 public:
  using SimulationProcess::SimulationProcess;

  [[nodiscard]] scenes::AuthoredScene authoredScene() override {
    return readScene(call({{"call", "authored_scene"}}), memory());
  }
};

/// The simulation in its process.
class Server {
 public:
  Json answer(const Json& message) {
    try {
      const auto name = message.at("call").get<std::string>();
      if (name == "open") return open(message);
      if (name == "rewind") return writeFrame(simulation_->rewind());
      if (name == "next") return writeFrame(simulation_->next().value());
      if (name == "poses") return writeAll(simulation_->poses());
      if (name == "unrotated_boxes") return writeAll(simulation_->unrotatedBoxes());
      if (name == "input_hash") return {{"hash", simulation_->inputHash()}};
      return writeScene(dynamic_cast<scenes::SceneSource&>(*simulation_).authoredScene(), memory_);
    } catch (const std::bad_alloc&) {
      return {{"error", "the simulation is out of memory"}};
    } catch (...) {
      return {{"error", currentErrorText()}};
    }
  }

 private:
  Json open(const Json& message) {
    addEnginesOf(message.at("plugins").get<std::vector<std::string>>(), std::nullopt);
    if (message.contains("bodies")) {
      simulation_ = scenes::makeAuthoredSimulation(readScene(message, memory_));
    } else {
      simulation_ =
          parseSceneParameters(message.at("scene").get<std::string>(), "scene parameters");
    }
    return Json::object();
  }

  Json writeFrame(const Frame& frame) {
    const std::span<const Escape> escapes = simulation_->escapes();
    if (frame.index == 0) escapes_sent_ = 0;
    const auto fresh = escapes.subspan(escapes_sent_);
    escapes_sent_ = escapes.size();
    std::uint64_t end = memory_.write(frame.boxes);
    end = memory_.write(fresh, end);
    if (frame.changed) end = memory_.write(*frame.changed, end);
    if (frame.filter != nullptr) {
      std::vector<BodyGroups> groups;
      for (std::uint32_t body = 0; body < frame.boxes.size(); ++body) {
        groups.push_back(frame.filter->groupsOf(body));
      }
      end = memory_.write(std::span<const BodyGroups>(groups), end);
      memory_.write(frame.filter_changed, end);
    }
    return {{"escapes", fresh.size()},
            {"changed", frame.changed ? Json(frame.changed->size()) : Json(nullptr)},
            {"filter_changed", frame.filter_changed.size()}};
  }

  template <class Item>
  Json writeAll(std::span<const Item> items) {
    memory_.write(items);
    return {{"items", items.size()}};
  }

  SharedMemory memory_{FileDescriptor(kMemoryDescriptor)};
  std::unique_ptr<Simulation> simulation_;
  std::size_t escapes_sent_ = 0;
};

}  // namespace

std::unique_ptr<Simulation> simulateInProcess(std::unique_ptr<Simulation> simulation,
                                              CancelQuery /*cancelled*/) {
  return simulation;
}

SimulationHost simulateInProcesses(std::string program) {
  return [program = std::move(program)](std::unique_ptr<Simulation> simulation,
                                        CancelQuery cancelled) -> std::unique_ptr<Simulation> {
    const bool is_scene = dynamic_cast<scenes::SceneSource*>(simulation.get()) != nullptr;
    const auto make = [&]<class Process>(std::type_identity<Process>) {
      return std::make_unique<Process>(std::move(simulation), program, std::move(cancelled));
    };
    if (is_scene) return make(std::type_identity<SceneProcess>());
    return make(std::type_identity<SimulationProcess>());
  };
}

void serveSimulation() {
  LineChannel calls(serveParent());
  Server server;
  while (const std::optional<std::string> line = calls.read()) {
    if (!send(calls.descriptor(), server.answer(parseJson(*line, "simulation process")))) return;
  }
}

}  // namespace broadmark
