// Reading recording 2: retains the boxes, and updates the changed ones.

#include "broadmark/recordings/recording2.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "broadmark/error.h"
#include "recording2_header.h"
#include "recording_file.h"

namespace broadmark {
namespace {

/// Rows per read; their bytes fit in the cache.
constexpr std::uint64_t kPieceRows = 1 << 13;

template <class... Arguments>
[[noreturn]] void throwInputError(const std::string& name, fmt::format_string<Arguments...> text,
                                  Arguments&&... arguments) {
  throw InputError(
      fmt::format("{}: {}", name, fmt::format(text, std::forward<Arguments>(arguments)...)));
}

}  // namespace

Recording2Reader::Recording2Reader(const std::filesystem::path& path)
    : Recording2Reader(openForReading(path), path.string()) {}

Recording2Reader::Recording2Reader(FileDescriptor file, std::string name)
    : Recording(std::move(file), std::move(name)) {
  open();
  boxes_.resize(scene().objects);
  ids_.resize(alignedBytes(sizeof(std::uint32_t) * scene().objects) / sizeof(std::uint32_t));
  if (scene().filter_changes) {
    filter_ids_.resize(ids_.size());
    groups_.resize(scene().objects);
  }
  piece_.resize(
      alignedBytes(sizeof(PackedBox) * std::min<std::uint64_t>(kPieceRows, boxes_.size())));
}

void Recording2Reader::open() {
  constexpr std::uint64_t kMinBytes = sizeof(RecordingStart) + sizeof(RecordingEnd);
  if (bytes() < kMinBytes) {
    throwInputError(name(), "{} bytes is too short: a .broadmark recording has at least {}",
                    bytes(), kMinBytes);
  }
  RecordingStart start;
  read(0, std::as_writable_bytes(std::span(&start, 1)));
  if (start.magic != kRecording2Magic) {
    throwInputError(name(), "byte 0: is not '{}': not a .broadmark recording",
                    fmt::join(kRecording2Magic, ""));
  }
  const std::uint64_t last = bytes() - sizeof(RecordingEnd);
  RecordingEnd end;
  read(last, std::as_writable_bytes(std::span(&end, 1)));
  if (end.magic != kRecording2Magic) {
    throwInputError(name(),
                    "byte {}: does not end as a .broadmark recording: cut short, or not finished?",
                    last);
  }
  constexpr std::uint64_t kMaxHeaderBytes = 1 << 28;  // scene parameters may take megabytes
  if (start.header_bytes > std::min(kMaxHeaderBytes, last - sizeof start) ||
      (sizeof start + start.header_bytes) % kRecordingAlignment != 0) {
    throwInputError(
        name(), "byte 8: invalid header size of {} bytes: the header must end at a multiple of {}",
        start.header_bytes, kRecordingAlignment);
  }
  hasher_.restart();
  hasher_.add(std::as_bytes(std::span(&start, 1)));
  const std::uint64_t frames_offset = readHeader(start.header_bytes, end.index_offset);
  readIndex(end.index_offset);
  if (hasher_.value() != end.hash) {
    throwInputError(name(), "header or index: damaged: wrong checksum");
  }
  checkIndex(frames_offset, end.index_offset - filterCountBytes(scene()));
}

std::uint64_t Recording2Reader::readHeader(std::uint64_t size, std::uint64_t index_offset) {
  std::string text(size, ' ');
  read(sizeof(RecordingStart), std::as_writable_bytes(std::span(text)));
  hasher_.add(std::as_bytes(std::span(text)));
  const Recording2Header fields(text, name() + ": header");
  SceneInfo scene = fields.scene();
  origin_ = fields.origin();

  // The initial pose takes 24 bytes a body: the file's length bounds all later sizes.
  const std::uint64_t offset = sizeof(RecordingStart) + size;
  const std::uint64_t last = bytes() - sizeof(RecordingEnd);
  const std::uint64_t index_bytes = sizeof(RecordedFrame) * (std::uint64_t{1} + scene.frames);
  if (offset + sizeof(PackedBox) * std::uint64_t{scene.objects} + index_bytes +
          filterCountBytes(scene) >
      last) {
    throwInputError(name(), "{} bytes is too short for {} bodies and {} frames", bytes(),
                    scene.objects, scene.frames);
  }
  if (index_offset != last - index_bytes) {
    throwInputError(name(), "byte {}: the index of {} frames begins at byte {}, not {}", last,
                    scene.frames, last - index_bytes, index_offset);
  }
  std::vector<std::byte> groups(fields.groupBytes());
  if (groups.size() > index_offset - offset) {
    throwInputError(name(), "byte {}: ends within the groups of the bodies", index_offset);
  }
  read(offset, groups);
  hasher_.add(groups);
  scene.filter = fields.filter(groups);
  setScene(std::move(scene));
  return offset + groups.size();
}

void Recording2Reader::readIndex(std::uint64_t offset) {
  const std::uint64_t count_bytes = filterCountBytes(scene());
  filter_counts_.resize(count_bytes / sizeof(std::uint32_t));
  const auto raw_counts = std::as_writable_bytes(std::span(filter_counts_));
  read(offset - count_bytes, raw_counts);
  hasher_.add(raw_counts);
  index_.resize(std::size_t{1} + scene().frames);
  const auto raw = std::as_writable_bytes(std::span(index_));
  read(offset, raw);
  hasher_.add(raw);
}

void Recording2Reader::checkIndex(std::uint64_t begin, std::uint64_t end) const {
  std::uint64_t offset = begin;
  for (std::uint32_t i = 0; i < index_.size(); ++i) {
    const auto& [start, changed, key, hash] = index_[i];
    const bool whole = key == i;
    const std::uint32_t filter_changed = filter_counts_.empty() ? 0 : filter_counts_[i];
    const bool is_valid =
        start == offset && changed <= scene().objects && filter_changed <= scene().objects &&
        (i > 0 || (whole && changed + filter_changed == 0)) && (whole || key == index_[i - 1].key);
    if (!is_valid) {
      throw InputError(fmt::format(
          "{}: byte {}: index: frame {} cannot be at byte {} with {} changed bodies, {} changed "
          "filters and key frame {}",
          name(), end + filterCountBytes(scene()) + sizeof(RecordedFrame) * i, i, start, changed,
          filter_changed, key));
    }
    offset += layoutOf(i).bytes();
    if (offset > end) break;
  }
  if (offset != end) {
    throw InputError(fmt::format("{}: the frames end at byte {}, but the index begins at byte {}",
                                 name(), offset, end));
  }
}

FrameLayout Recording2Reader::layoutOf(std::uint32_t index) const {
  std::optional<std::uint32_t> filter_changed;
  if (index > 0 && scene().filter_changes) filter_changed = filter_counts_[index];
  return {index_[index].changed, filter_changed, index_[index].key == index, scene().objects};
}

std::span<const Aabb> Recording2Reader::readBoxes(std::uint32_t index) {
  if (current_ == index) return boxes_;
  const std::uint32_t key = index_[index].key;
  const bool is_ahead = current_ && key <= *current_ && *current_ < index;
  const bool next = current_ && *current_ + 1 == index;
  for (std::uint32_t i = is_ahead || next ? *current_ + 1 : key; i <= index; ++i) readFrame(i);
  if (scene().filter_changes && !std::exchange(filter_is_current_, true)) {
    filter_ = {groups_, scene().filter.matrix(), true};
  }
  return boxes_;
}

void Recording2Reader::readFrame(std::uint32_t index) {
  const bool follows = current_ && *current_ + 1 == index;
  current_.reset();  // invalid until the frame is complete
  hasher_.restart();
  changed_ = index_[index].changed;
  readIds(index, index_[index].offset, changed_, ids_);
  if (index_[index].key == index) {
    readAllBoxes(index, follows);
  } else {
    readChangedBoxes(index);
  }
  if (scene().filter_changes) readFilter(index, follows);
  if (hasher_.value() != index_[index].hash) fail(index, "");
  current_ = index;
}

void Recording2Reader::readIds(std::uint32_t index, std::uint64_t offset, std::uint32_t count,
                               std::vector<std::uint32_t>& ids) {
  const RowsLayout layout(count, false, scene().objects);
  const auto raw = std::as_writable_bytes(std::span(ids)).first(layout.idBytes());
  read(offset, raw);
  hasher_.add(raw);
  if (layout.ids == 0) {
    std::iota(ids.begin(), ids.begin() + count, 0U);
    return;
  }
  std::uint32_t unordered = 0;
  for (std::uint32_t i = 1; i < count; ++i) {
    unordered |= static_cast<std::uint32_t>(ids[i] <= ids[i - 1]);
  }
  if (unordered == 0 && ids[count - 1] < scene().objects) return;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (ids[i] < scene().objects && (i == 0 || ids[i - 1] < ids[i])) continue;
    fail(index, fmt::format("byte {}: body {} among the changed ones: they are "
                            "expected to ascend "
                            "and to be below {}",
                            offset + sizeof(std::uint32_t) * i, ids[i], scene().objects));
  }
}

template <class Visit>
void Recording2Reader::readRows(std::uint64_t offset, std::uint64_t count, std::uint64_t row_bytes,
                                Visit&& visit) {
  for (std::uint64_t first = 0; first < count; first += kPieceRows) {
    const std::uint64_t rows = std::min(kPieceRows, count - first);
    const auto raw = std::span(piece_).first(alignedBytes(row_bytes * rows));
    read(offset, raw);
    hasher_.add(raw);
    offset += raw.size();
    for (std::uint64_t row = 0; row < rows; ++row) visit(first + row, raw.data() + row_bytes * row);
  }
}

template <class Visit>
void Recording2Reader::readBoxRows(std::uint32_t index, Visit&& visit) {
  const FrameLayout layout = layoutOf(index);
  readRows(index_[index].offset + layout.boxes.idBytes(), layout.boxes.rows, sizeof(PackedBox),
           [&](std::uint64_t row, const std::byte* raw) {
             const Aabb box = unpacked(raw);
             if (!isRecordable(box, scene().all_present)) failAt(index, row, box);
             visit(row, box);
           });
}

void Recording2Reader::readAllBoxes(std::uint32_t index, bool follows) {
  // Consumers of `changed` would miss an unlisted change.
  if (follows && changed_ < scene().objects) {
    readBoxRows(index, [&, listed = std::uint32_t{0}](std::uint64_t body, const Aabb& box) mutable {
      if (listed < changed_ && ids_[listed] == body) {
        ++listed;
      } else if (!sameBits(box, boxes_[body])) {
        failAt(index, body,
               "differs from the frame before, but is not among the changed "
               "bodies");
      }
      boxes_[body] = box;
    });
  } else {
    readBoxRows(index, [&](std::uint64_t body, const Aabb& box) { boxes_[body] = box; });
  }
}

void Recording2Reader::readChangedBoxes(std::uint32_t index) {
  readBoxRows(index, [&](std::uint64_t row, const Aabb& box) { boxes_[ids_[row]] = box; });
}

void Recording2Reader::readFilter(std::uint32_t index, bool follows) {
  filter_changed_ = filter_counts_[index];
  if (index == 0) {
    for (std::uint32_t body = 0; body < groups_.size(); ++body) {
      groups_[body] = scene().filter.groupsOf(body);
    }
    filter_is_current_ = false;
    return;
  }
  const FrameLayout layout = layoutOf(index);
  const std::uint64_t offset = index_[index].offset + layout.boxBytes();
  readIds(index, offset, filter_changed_, filter_ids_);
  const bool whole = index_[index].key == index;
  if (filter_changed_ > 0 || (whole && !follows)) filter_is_current_ = false;
  readRows(offset + layout.groups.idBytes(), layout.groups.rows, sizeof(PackedGroups),
           [&, listed = std::uint32_t{0}](std::uint64_t row, const std::byte* raw) mutable {
             PackedGroups values;
             std::memcpy(values.data(), raw, sizeof values);
             const std::uint64_t body = whole ? row : filter_ids_[row];
             if (values[0] >= LayerMatrix::kLayers) {
               fail(index, fmt::format("body {}: is in layer {}: there are layers 0 to {}", body,
                                       values[0], LayerMatrix::kLayers - 1));
             }
             const bool is_listed = listed < filter_changed_ && filter_ids_[listed] == body;
             if (is_listed) ++listed;
             if (whole && follows && !is_listed && values != packed(groups_[body])) {
               fail(index, fmt::format("body {}: its layer or tags differ from the frame before, "
                                       "but it is not among those with changed filters",
                                       body));
             }
             groups_[body].layer = static_cast<std::uint8_t>(values[0]);
             groups_[body].tags = {values[1], values[2], values[3]};
           });
}

void Recording2Reader::failAt(std::uint32_t index, std::uint64_t row, const Aabb& box) {
  failAt(index, row, "the box " + recordingFault(box, scene().all_present));
}

void Recording2Reader::failAt(std::uint32_t index, std::uint64_t row, const std::string& what) {
  const bool whole = index_[index].key == index;
  fail(index,
       fmt::format("body {} (byte {}): {}", whole ? row : ids_[row],
                   index_[index].offset + layoutOf(index).boxes.idBytes() + sizeof(PackedBox) * row,
                   what));
}

void Recording2Reader::fail(std::uint32_t index, const std::string& what) {
  const RecordedFrame& frame = index_[index];
  const FrameLayout layout = layoutOf(index);
  hasher_.restart();
  for (std::uint64_t done = 0; done < layout.bytes(); done += piece_.size()) {
    const auto raw =
        std::span(piece_).first(std::min<std::uint64_t>(piece_.size(), layout.bytes() - done));
    read(frame.offset + done, raw);
    hasher_.add(raw);
  }
  if (hasher_.value() == frame.hash) {
    throw InputError(fmt::format("{}: frame {}, {}", name(), index, what));
  }
  throw InputError(fmt::format("{}: frame {} (bytes {} to {}): damaged: wrong checksum", name(),
                               index, frame.offset, frame.offset + layout.bytes() - 1));
}

}  // namespace broadmark
