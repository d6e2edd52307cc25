// Packets, shared memory, and values as JSON.

#include "worker/protocol.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <type_traits>

namespace broadmark::worker {
namespace {

// Types copied to shared memory as they are.
static_assert(sizeof(Aabb) == 32 && sizeof(Pair) == 8 && sizeof(RecordedDrawing::Box) == 48 &&
              sizeof(RecordedDrawing::Segment) == 28);
static_assert(std::is_trivially_copyable_v<BodyGroups> && std::is_trivially_copyable_v<Aabb> &&
              std::is_trivially_copyable_v<Pair> &&
              std::is_trivially_copyable_v<RecordedDrawing::Box> &&
              std::is_trivially_copyable_v<RecordedDrawing::Segment>);

/// Longer than any message; longer ones would be truncated.
constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 17;

}  // namespace

ChannelEnds openChannel() {
  int ends[2];
  // Packets preserve message boundaries.
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
    throw systemError("no channel to a worker process");
  }
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

bool Channel::send(const Json& message) const {
  const std::string text = formatJson(message, -1);
  if (text.size() > kMaxMessageBytes) {
    throw std::runtime_error(fmt::format("a message of {} bytes is too long", text.size()));
  }
  ssize_t sent = -1;
  do {
    sent = ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent >= 0;
}

bool Channel::wait(int milliseconds) const {
  pollfd descriptor{.fd = socket_.get(), .events = POLLIN, .revents = 0};
  return ::poll(&descriptor, 1, milliseconds) > 0;
}

std::optional<Json> Channel::receive() {
  buffer_.resize(kMaxMessageBytes);
  ssize_t received = -1;
  do {
    received = ::recv(socket_.get(), buffer_.data(), buffer_.size(), 0);
  } while (received < 0 && errno == EINTR);
  if (received <= 0) return std::nullopt;
  try {
    return parseJson({buffer_.data(), static_cast<std::size_t>(received)}, "message");
  } catch (const InputError& error) {
    throw HostError(error.what());
  }
}

Json toJson(const Case& test_case) {
  return {{"algorithm", test_case.algorithm.id},
          {"plugin", test_case.algorithm.plugin},
          {"plugin_hash", test_case.algorithm.plugin_build.hash},
          {"isa", isaName(test_case.isa)},
          {"threads", test_case.threads},
          {"device", test_case.device},
          {"parameters", test_case.parameters},
          {"answer", answerName(test_case.answer)}};
}

Case caseFrom(const Json& json, const AlgorithmFinder& find) {
  const auto isa = json.at("isa").get<std::string>();
  Case test_case{.algorithm = find(json.at("algorithm").get<std::string>(),
                                   json.at("plugin").get<std::string>()),
                 .threads = integerOf<int>(json.at("threads")),
                 .device = json.at("device").get<std::string>(),
                 .parameters = json.at("parameters").get<ParameterValues>()};
  const auto hash = json.value("plugin_hash", std::string());
  if (!hash.empty() && hash != test_case.algorithm.plugin_build.hash) {
    throw InputError(fmt::format("--plugin: {}: was replaced after the run had begun",
                                 test_case.algorithm.plugin));
  }
  const auto value = kIsas.find(isa);
  if (!value) throw UnsupportedError("there is no instruction set " + isa);
  test_case.isa = *value;
  test_case.answer = findAnswer(json.at("answer").get<std::string>()).value();
  return test_case;
}

Json toJson(const SceneInfo& scene) {
  return {{"name", scene.name},
          {"object_type", scene.object_type},
          {"objects", scene.objects},
          {"frames", scene.frames},
          {"world", {scene.world.min, scene.world.max}},
          {"all_present", scene.all_present},
          {"filter_changes", scene.filter_changes},
          {"periodic", {scene.periodic.min, scene.periodic.max}}};
}

SceneInfo sceneFrom(const Json& json) {
  SceneInfo scene{.name = json.at("name").get<std::string>(),
                  .object_type = json.at("object_type").get<std::string>(),
                  .objects = integerOf<std::uint32_t>(json.at("objects")),
                  .frames = integerOf<std::uint32_t>(json.at("frames")),
                  .all_present = json.at("all_present").get<bool>(),
                  .filter_changes = json.at("filter_changes").get<bool>()};
  json.at("world").at(0).get_to(scene.world.min);
  json.at("world").at(1).get_to(scene.world.max);
  json.at("periodic").at(0).get_to(scene.periodic.min);
  json.at("periodic").at(1).get_to(scene.periodic.max);
  return scene;
}

Json writeFilter(const CollisionFilter& filter, const SharedMemory& memory, std::uint64_t offset) {
  if (filter.wantsAll()) return nullptr;
  // Tags first, for alignment: each array begins at a multiple of its item size.
  offset = memory.write(filter.tags(), offset);
  offset = memory.write(filter.worlds(), offset);
  memory.write(filter.layers(), offset);
  return {{"matrix", filter.matrix().rows()},
          {"tags", !filter.tags().empty()},
          {"worlds", !filter.worlds().empty()},
          {"layers", !filter.layers().empty()}};
}

CollisionFilter readFilter(const Json& json, const SharedMemory& memory, std::uint64_t offset,
                           const SceneInfo& scene) {
  if (json.is_null()) return {};
  const std::size_t bodies = scene.objects;
  std::vector<BodyGroups> groups(bodies);
  const auto read = [&]<class Item>(const char* name, Item BodyGroups::* member) {
    if (!json.at(name).get<bool>()) return;
    std::vector<Item> items;
    memory.read(items, bodies, offset);
    offset += bodies * sizeof(Item);
    for (std::size_t i = 0; i < bodies; ++i) groups[i].*member = items[i];
  };
  read("tags", &BodyGroups::tags);
  read("worlds", &BodyGroups::world);
  read("layers", &BodyGroups::layer);
  LayerMatrix matrix;
  const Json& rows = json.at("matrix");
  for (std::size_t a = 0; a < std::min(rows.size(), LayerMatrix::kLayers); ++a) {
    const auto row = integerOf<std::uint32_t>(rows.at(a));
    for (std::size_t b = 0; b < LayerMatrix::kLayers; ++b) {
      if ((row >> b & 1) != 0) matrix.set(a, b);
    }
  }
  return {groups, matrix, scene.filter_changes};
}

}  // namespace broadmark::worker
