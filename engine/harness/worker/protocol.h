// What a process says to its worker process, and hears from it.
//
// A message is one JSON object in one packet. At first the worker says who it is:
//   {"protocol": 4, "program": "0.1.0"}
// Then it answers one call after the other, with what stands behind the arrow or with
//   {"error": "…", "kind": "input" | "unsupported" | "error"}
//
//   call        says                                              answer
//   case        algorithm, plugin, plugin_hash (of that file),
//               isa, threads, device, parameters {},
//               answer ("pairs" | "events"),
//               memory_limit_bytes (0: none), pin                 {}
//   start       scene {name, object_type, objects, frames, world, initialize_ns, pinned
//               all_present}, filter (null: all pairs are wanted);
//               shared are the boxes of frame 0, then what the
//               filter has of tags, worlds, layers
//   step        frame, changed: the numbers of so many bodies,    times_ns {}, pairs
//               then their boxes, are shared
//   digest                                                        count, hash
//   answer                                                        pairs: so many are shared
//   events                                                        began, then ended: so many pairs
//                                                                 are shared
//   counters, setup                                               counts {}
//   structure                                                     boxes, lines, tests: so many are
//                                                                 shared; left_out
//   validate                                                      broken ("": nothing)
//   stop                                                          peak_bytes (null: not known),
//                                                                 heap_bytes,
//                                                                 processor {} (what is known)
//
// A side passes over keys that it does not know. A change that an older side cannot pass over
// raises kProtocolVersion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/harness/worker_process.h"
#include "broadmark/json_fields.h"

namespace broadmark::worker {

inline constexpr int kProtocolVersion = 4;

// The worker's descriptors.
inline constexpr int kChannelDescriptor = 3;
inline constexpr int kFramesDescriptor = 4;   ///< written by the process that started it
inline constexpr int kAnswersDescriptor = 5;  ///< written by the worker

/// One end of the channel.
class Channel {
 public:
  explicit Channel(FileDescriptor socket) : socket_(std::move(socket)) {}

  /// Whether the other side is still there to get it.
  [[nodiscard]] bool send(const Json& message) const;
  /// Waits so long for a packet to arrive; forever if that is negative. Whether one has, or the
  /// other side has gone.
  [[nodiscard]] bool wait(int milliseconds) const;
  /// The next message; nothing once the other side has gone. Throws HostError for what is none.
  [[nodiscard]] std::optional<Json> receive();

 private:
  FileDescriptor socket_;
  std::vector<char> buffer_;
};

/// Both ends of a new channel.
struct ChannelEnds {
  FileDescriptor here;
  FileDescriptor there;
};
ChannelEnds openChannel();

/// Memory that both sides share. It is read and written by system calls and never mapped: so it is
/// not within the memory that the worker takes.
class SharedMemory {
 public:
  explicit SharedMemory(FileDescriptor file) : file_(std::move(file)) {}
  /// New and empty.
  SharedMemory();

  [[nodiscard]] int descriptor() const { return file_.get(); }

  /// Gives the memory back.
  void clear() const;

  /// Writes `items` at a byte offset. Returns the offset behind them. Throws std::runtime_error
  /// when there is no memory left.
  template <class Item>
  std::uint64_t write(std::span<const Item> items, std::uint64_t offset = 0) const {
    writeBytes(std::as_bytes(items), offset);
    return offset + items.size_bytes();
  }
  /// Reads `count` items from a byte offset into `items`, which keeps its capacity.
  template <class Item, class Allocator>
  void read(std::vector<Item, Allocator>& items, std::size_t count,
            std::uint64_t offset = 0) const {
    requireHeld(offset, count, sizeof(Item));
    items.resize(count);
    readBytes(std::as_writable_bytes(std::span(items)), offset);
  }

 private:
  void writeBytes(std::span<const std::byte> bytes, std::uint64_t offset) const;
  void readBytes(std::span<std::byte> bytes, std::uint64_t offset) const;
  /// Throws HostError for a claim of more than is there.
  void requireHeld(std::uint64_t offset, std::uint64_t count, std::size_t item_bytes) const;

  FileDescriptor file_;
};

/// The worker's side of the protocol, without what it does to its process: answers the calls of the
/// other side until that hangs up. Throws HostError for what is no message.
void answerCalls(Channel& channel, SharedMemory frames, SharedMemory answers,
                 const AlgorithmFinder& find);

Json toJson(const Case&);
/// Throws InputError (no such algorithm) and Json::exception.
Case caseFrom(const Json&, const AlgorithmFinder& find);
/// All but the filter, which is too large for a message.
Json toJson(const SceneInfo&);
SceneInfo sceneFrom(const Json&);
/// Writes the filter's arrays from `offset` on; what there is of them.
Json writeFilter(const CollisionFilter&, const SharedMemory&, std::uint64_t offset);
CollisionFilter readFilter(const Json&, const SharedMemory&, std::uint64_t offset,
                           std::size_t bodies);

/// The values of the names in a table, as far as they are known.
template <class Table, class Values>
Json namedToJson(const Table& table, const Values& values) {
  Json json = Json::object();
  for (const auto& [key, name] : table.entries) {
    if (const std::optional value = values[key]) json[std::string(name)] = *value;
  }
  return json;
}
/// And back. What the other side does not tell stays as it is.
template <class Table, class Values>
void readNamed(const Json& json, const Table& table, Values& values) {
  for (const auto& [key, name] : table.entries) {
    using Value = typename decltype(std::optional(values[key]))::value_type;
    if (json.contains(name)) values[key] = json.at(std::string(name)).template get<Value>();
  }
}

}  // namespace broadmark::worker
