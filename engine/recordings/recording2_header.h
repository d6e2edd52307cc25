// The layout of a recording 2, and its header; docs/recordings.md describes the bytes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/hasher.h"
#include "broadmark/json_fields.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/recordings/recording2.h"

namespace broadmark {

/// Boxes in file layout: six floats, min x y z, max x y z.
using PackedBox = std::array<float, 6>;

inline PackedBox packed(const Aabb& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

/// A body's layer and tags in file layout. (Its world never changes.)
using PackedGroups = std::array<std::uint32_t, 4>;

inline PackedGroups packed(const BodyGroups& groups) {
  return {groups.layer, groups.tags[0], groups.tags[1], groups.tags[2]};
}

/// Loads each corner of a packed box as a SIMD register: the subsequent checks take a third
/// of the time after scalar loads.
inline Aabb unpacked(const std::byte* raw) {
  using Corner = float __attribute__((vector_size(16)));
  Corner min;
  Corner max;  // after the last component of min
  std::memcpy(&min, raw, sizeof min);
  std::memcpy(&max, raw + 2 * sizeof(float), sizeof max);
  const Corner zero = {};
  return {std::bit_cast<std::array<float, 4>>(__builtin_shufflevector(min, zero, 0, 1, 2, 4)),
          std::bit_cast<std::array<float, 4>>(__builtin_shufflevector(max, zero, 1, 2, 3, 4))};
}

inline constexpr std::array<char, 8> kRecording2Magic = {'B', 'R', 'D', 'M', 'A', 'R', 'K', '2'};

/// Precedes the header, which is JSON.
struct RecordingStart {
  std::array<char, 8> magic = kRecording2Magic;
  std::uint64_t header_bytes = 0;
};

/// The last bytes of the file.
struct RecordingEnd {
  std::uint64_t index_offset = 0;
  HashValue hash;  ///< of all bytes before the first frame, and the index
  std::array<char, 8> magic = kRecording2Magic;
};

inline constexpr std::uint64_t kRecordingAlignment = 32;
static_assert(sizeof(RecordingStart) == 16 && sizeof(RecordedFrame) == kRecordingAlignment &&
              sizeof(RecordingEnd) == kRecordingAlignment && sizeof(PackedBox) == 24 &&
              sizeof(PackedGroups) == 16);

constexpr std::uint64_t alignedBytes(std::uint64_t bytes) {
  return (bytes + kRecordingAlignment - 1) / kRecordingAlignment * kRecordingAlignment;
}

/// The layout of ids and their rows. No ids if all bodies changed.
struct RowsLayout {
  std::uint64_t ids = 0;
  std::uint64_t rows = 0;

  RowsLayout() = default;
  RowsLayout(std::uint32_t changed, bool whole, std::uint32_t objects)
      : ids(changed < objects ? changed : 0), rows(whole ? objects : changed) {}

  [[nodiscard]] std::uint64_t idBytes() const { return alignedBytes(sizeof(std::uint32_t) * ids); }
};

/// The layout of a frame: changed boxes, then, if the filter changes, changed layers and tags.
struct FrameLayout {
  RowsLayout boxes;
  RowsLayout groups;

  /// `filter_changed`: nullopt in frame 0, which has the header's filter, and if no filter changes.
  FrameLayout(std::uint32_t changed, std::optional<std::uint32_t> filter_changed, bool whole,
              std::uint32_t objects)
      : boxes(changed, whole, objects) {
    if (filter_changed) groups = {*filter_changed, whole, objects};
  }

  [[nodiscard]] std::uint64_t boxBytes() const {
    return boxes.idBytes() + alignedBytes(sizeof(PackedBox) * boxes.rows);
  }
  [[nodiscard]] std::uint64_t bytes() const {
    return boxBytes() + groups.idBytes() + alignedBytes(sizeof(PackedGroups) * groups.rows);
  }
};

/// Bytes of the number of filter changes in each frame, which precede the index if filters change.
constexpr std::uint64_t filterCountBytes(const SceneInfo& scene) {
  if (!scene.filter_changes) return 0;
  return alignedBytes(sizeof(std::uint32_t) * (std::uint64_t{1} + scene.frames));
}

/// The fault of a box; "": none.
std::string recordingFault(const Aabb& box, bool all_present);

template <class T>
void appendBytes(std::vector<std::byte>& bytes, std::span<const T> values) {
  if (values.empty()) return;
  const std::size_t begin = bytes.size();
  bytes.resize(begin + values.size_bytes());
  std::memcpy(bytes.data() + begin, values.data(), values.size_bytes());
}

/// All bytes before the first frame. Throws InputError for invalid names.
std::vector<std::byte> recording2Header(const SceneInfo&, const RecordingOrigin&);

/// A header's JSON. All functions throw InputError with the key and the expected value.
class Recording2Header {
 public:
  /// `name` is used in messages.
  Recording2Header(std::string_view text, const std::string& name);

  /// Without the filter.
  [[nodiscard]] SceneInfo scene() const;
  [[nodiscard]] RecordingOrigin origin() const;
  /// Size of the per-body arrays between header and first frame.
  [[nodiscard]] std::uint64_t groupBytes() const;
  /// Decodes these arrays.
  [[nodiscard]] CollisionFilter filter(std::span<const std::byte> groups) const;

 private:
  [[nodiscard]] std::uint32_t objects() const { return fields_.integer<std::uint32_t>("objects"); }

  Json json_;
  JsonFields fields_;
  bool is_periodic_ = false;
  bool filter_changes_ = false;
};

}  // namespace broadmark
