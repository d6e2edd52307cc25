// Writing recording 2. Key frames are placed so that the changes between two of them take no more
// than a whole frame: the file is at most twice as large as without key frames, and a frame is at
// most two whole frames away from a key frame.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "broadmark/change_detector.h"
#include "broadmark/error.h"
#include "recording2_header.h"
#include "recording_file.h"

namespace broadmark {
namespace {

/// Maximum distance of key frames: even frames with few changes take time.
constexpr std::uint32_t kMaxBetweenKeys = 256;

class Recording2File final : public RecordingFile {
 public:
  Recording2File(const std::filesystem::path& path, const SceneInfo& scene,
                 const std::vector<std::byte>& header)
      : RecordingFile(path, scene, header) {
    hasher_.add(header);
  }

  void write(const Frame& input) override {
    const std::span<const Aabb> boxes = input.boxes;
    requireBodies(boxes.size());
    const auto index = static_cast<std::uint32_t>(index_.size());
    const Frame frame = changes_.complete(
        {index, boxes, input.changed, &input.filterIn(scene()), input.filter_changed});
    requireRecordable(frame);
    requireAnnounced(frame);
    const auto ids = frame.changed.value_or(std::span<const std::uint32_t>());
    const std::uint32_t key = keyOf(frame.index, ids.size(), frame.filter_changed.size());
    const bool whole = key == frame.index;
    std::optional<std::uint32_t> filter_changed;
    if (scene().filter_changes && index > 0) {
      filter_changed = static_cast<std::uint32_t>(frame.filter_changed.size());
    }
    const FrameLayout layout(static_cast<std::uint32_t>(ids.size()), filter_changed, whole,
                             scene().objects);
    block_.clear();
    appendRows(layout.boxes, ids, whole, [&](std::size_t body) { return packed(boxes[body]); });
    appendRows(layout.groups, frame.filter_changed, whole,
               [&](std::uint32_t body) { return packed(frame.filter->groupsOf(body)); });
    index_.push_back({size(), static_cast<std::uint32_t>(ids.size()), key, hashOf(block_)});
    filter_counts_.push_back(filter_changed.value_or(0));
    append(block_);
  }

 private:
  /// Appends the ids, and the row of each, or of all bodies if `whole`.
  template <class PackedRow>
  void appendRows(const RowsLayout& layout, std::span<const std::uint32_t> ids, bool whole,
                  PackedRow packed_row) {
    appendBytes(block_, ids.first(layout.ids));
    block_.resize(alignedBytes(block_.size()));
    const std::size_t begin = block_.size();
    constexpr std::size_t kRowBytes = sizeof(packed_row(0U));
    block_.resize(begin + alignedBytes(kRowBytes * layout.rows));
    std::byte* target = block_.data() + begin;
    for (std::uint32_t row = 0; row < layout.rows; ++row, target += kRowBytes) {
      const auto values = packed_row(whole ? row : ids[row]);
      std::memcpy(target, values.data(), kRowBytes);
    }
  }

  void requireAnnounced(const Frame& frame) const {
    const CollisionFilter& known = scene().filter;
    const CollisionFilter& now = *frame.filter;
    const bool is_announced = now == known || (frame.index > 0 && scene().filter_changes &&
                                               now.matrix() == known.matrix() &&
                                               std::ranges::equal(now.worlds(), known.worlds()));
    if (is_announced) return;
    throw std::logic_error(
        fmt::format("{}: frame {}: the scene does not announce this filter", name(), frame.index));
  }

  /// Checks the changes since the frame before, which was recordable.
  void requireRecordable(const Frame& frame) const {
    const auto require = [&](std::size_t body) {
      if (isRecordable(frame.boxes[body], scene().all_present)) return;
      throw InputError(fmt::format("{}: frame {}, body {}: the box {}", name(), frame.index, body,
                                   recordingFault(frame.boxes[body], scene().all_present)));
    };
    if (frame.index == 0) {
      for (std::size_t body = 0; body < frame.boxes.size(); ++body) require(body);
    } else {
      for (const std::uint32_t body : *frame.changed) require(body);
    }
  }

  /// The key frame of the next frame, with the numbers of changed bodies.
  std::uint32_t keyOf(std::uint32_t index, std::uint64_t changed, std::uint64_t filter_changed) {
    since_key_ += changed * (sizeof(std::uint32_t) + sizeof(PackedBox));
    since_key_ += filter_changed * (sizeof(std::uint32_t) + sizeof(PackedGroups));
    const std::uint64_t row_bytes =
        sizeof(PackedBox) + (scene().filter_changes ? sizeof(PackedGroups) : 0);
    const std::uint64_t whole = row_bytes * scene().objects;
    const std::uint32_t last = index == 0 ? 0 : index_.back().key;
    if (index > 0 && since_key_ < whole && index - last < kMaxBetweenKeys) return last;
    since_key_ = 0;
    return index;
  }

  /// Writes index and trailer.
  void complete() override {
    requireComplete(index_.size());
    block_.clear();
    if (scene().filter_changes) appendBytes(block_, std::span<const std::uint32_t>(filter_counts_));
    block_.resize(alignedBytes(block_.size()));
    const std::uint64_t index_offset = size() + block_.size();
    appendBytes(block_, std::span<const RecordedFrame>(index_));
    hasher_.add(block_);
    const RecordingEnd end{.index_offset = index_offset, .hash = hasher_.value()};
    appendBytes(block_, std::span(&end, 1));
    append(block_);
  }

  ChangeDetector changes_;
  std::vector<RecordedFrame> index_;
  std::vector<std::uint32_t> filter_counts_;  ///< by frame
  std::vector<std::byte> block_;              ///< the next block to write
  std::uint64_t since_key_ = 0;               ///< bytes of changes since the last key frame
  Hasher hasher_;                             ///< over all but the frames
};

}  // namespace

std::unique_ptr<RecordingFile> makeRecording2File(const std::filesystem::path& path,
                                                  const SceneInfo& scene,
                                                  const RecordingOrigin& origin) {
  return std::make_unique<Recording2File>(path, scene, recording2Header(scene, origin));
}

}  // namespace broadmark
