// The protocol between a process and its worker process.
//
// A message is one JSON object in one packet. First the worker sends its version:
//   {"protocol": 5, "program": "0.1.0"}
// Then it answers each call, with the last column or with
//   {"error": "…", "kind": "input" | "unsupported" | "error"}
//
//   call        message (and shared memory)                       answer (and shared memory)
//   case        algorithm, plugin, plugin_hash (of that file, "": any),
//               isa, threads, device, parameters {},
//               answer ("pairs" | "events"),
//               memory_limit_bytes (0: none), pin,
//               counters ("processor" | "valgrind")               counters
//   start       scene {name, object_type, objects, frames,        initialize_ns, pinned
//               world, all_present, filter_changes, periodic},
//               filter (null: all pairs are wanted)
//               shared: the boxes of frame 0, then the filter's
//               tags, worlds, layers, if any
//   step        frame; changed, filter_changed: the numbers of    times_ns {}, pairs
//               bodies with another box, or another filter
//               shared: the ids and boxes of the former, then
//               ids, layers and tags of the latter
//   digest                                                        count, hash
//   answer                                                        pairs: their number
//                                                                 shared: the pairs
//   events                                                        began, ended: their numbers
//                                                                 shared: the pairs, in this order
//   counters                                                      counts {}, private_bytes (null:
//                                                                 unknown): growth since start
//   setup                                                         counts {}
//   structure                                                     boxes, lines, tests: their
//                                                                 numbers; left_out
//                                                                 shared: these, in this order
//   validate                                                      broken ("": nothing)
//   stop                                                          peak_bytes (null: unknown),
//                                                                 heap_bytes, processor {}
//
// Unknown keys are ignored. A change that an older side cannot ignore raises kProtocolVersion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/harness/shared_memory.h"
#include "broadmark/harness/worker_process.h"
#include "broadmark/json_fields.h"

namespace broadmark::worker {

inline constexpr int kProtocolVersion = 5;

// The worker's descriptors.
inline constexpr int kChannelDescriptor = 3;
inline constexpr int kFramesDescriptor = 4;   ///< written by the parent process
inline constexpr int kAnswersDescriptor = 5;  ///< written by the worker

/// One end of the channel.
class Channel {
 public:
  explicit Channel(FileDescriptor socket) : socket_(std::move(socket)) {}

  /// Returns whether the other side still exists.
  [[nodiscard]] bool send(const Json& message) const;
  /// Waits for a packet, up to `milliseconds`; without limit if negative. Returns true once a
  /// packet has arrived or the other side has hung up.
  [[nodiscard]] bool wait(int milliseconds) const;
  /// The next message; nullopt once the other side has hung up. Throws HostError if it is
  /// malformed.
  [[nodiscard]] std::optional<Json> receive();

 private:
  FileDescriptor socket_;
  std::vector<char> buffer_;
};

struct ChannelEnds {
  FileDescriptor here;
  FileDescriptor there;
};
ChannelEnds openChannel();

/// The worker's protocol loop, without any change of its process: answers calls until the other
/// side hangs up. Throws HostError for a malformed message.
void answerCalls(Channel& channel, SharedMemory frames, SharedMemory answers,
                 const AlgorithmFinder& find);

Json toJson(const Case&);
/// Throws InputError (no such algorithm) and Json::exception.
Case caseFrom(const Json&, const AlgorithmFinder& find);
/// Without the filter, which is too large for a message.
Json toJson(const SceneInfo&);
SceneInfo sceneFrom(const Json&);
/// Writes the filter's arrays, if any, from `offset` on.
Json writeFilter(const CollisionFilter&, const SharedMemory&, std::uint64_t offset);
/// As an argument of the call `start`, for its scene.
CollisionFilter readFilter(const Json&, const SharedMemory&, std::uint64_t offset,
                           const SceneInfo& scene);

/// An integer of a message. Throws HostError for other values and those out of range: the JSON
/// library's conversion of these is undefined.
template <class Integer>
Integer integerOf(const Json& value) {
  try {
    return JsonFields::integerOf<Integer>(value, "message");
  } catch (const InputError& error) {
    throw HostError(error.what());
  }
}

/// The known values of a table's names.
template <class Table, class Values>
Json namedToJson(const Table& table, const Values& values) {
  Json json = Json::object();
  for (const auto& [key, name] : table.entries) {
    if (const std::optional value = values[key]) json[std::string(name)] = *value;
  }
  return json;
}
/// The reverse. Missing values remain unchanged.
template <class Table, class Values>
void readNamed(const Json& json, const Table& table, Values& values) {
  for (const auto& [key, name] : table.entries) {
    using Value = typename decltype(std::optional(values[key]))::value_type;
    if (json.contains(name)) values[key] = integerOf<Value>(json.at(std::string(name)));
  }
}

}  // namespace broadmark::worker
