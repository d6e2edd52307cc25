// Recording 2: frames as what changed. Key frames are set so that what lies between two of them
// takes no more than a whole frame: the file is at most twice as large as without them, and a frame
// is at most two whole frames away.

#include "broadmark/recording2.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "broadmark/changed_bodies.h"
#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "packed_box.h"
#include "recording_file.h"

namespace broadmark {
namespace {

constexpr std::string_view kSchema = "broadmark-recording/2";
constexpr std::array<char, 8> kMagic = {'B', 'R', 'D', 'M', 'A', 'R', 'K', '2'};

/// Before the header, which is JSON.
struct Start {
  std::array<char, 8> magic = kMagic;
  std::uint64_t header_bytes = 0;
};

/// The last bytes of the file.
struct End {
  std::uint64_t index_offset = 0;
  HashValue hash;  ///< of the index, after all that comes before the first frame
  std::array<char, 8> magic = kMagic;
};

constexpr std::uint64_t kAlignment = 32;
static_assert(sizeof(Start) == 16 && sizeof(RecordedFrame) == kAlignment &&
              sizeof(End) == kAlignment && sizeof(PackedBox) == 24);

/// Most frames from one key frame to the next: a frame in which little changed takes its time, too.
constexpr std::uint32_t kMostBetweenKeys = 256;
/// Rows that are read at once: their bytes fit in the cache.
constexpr std::uint64_t kPieceRows = 1 << 13;
/// Parameters of scenes are stated in a few thousand bytes, authored ones in some millions.
constexpr std::uint64_t kMostHeaderBytes = 1 << 28;

constexpr std::uint64_t aligned(std::uint64_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

/// What lies where in a frame: its ids, then its boxes. Where all changed, no ids.
struct Layout {
  std::uint64_t ids;
  std::uint64_t rows;

  Layout(std::uint32_t changed, bool whole, std::uint32_t objects)
      : ids(changed < objects ? changed : 0), rows(whole ? objects : changed) {}

  [[nodiscard]] std::uint64_t idBytes() const { return aligned(sizeof(std::uint32_t) * ids); }
  [[nodiscard]] std::uint64_t bytes() const {
    return idBytes() + aligned(sizeof(PackedBox) * rows);
  }
};

bool isRecordable(const Aabb& box, bool all_present) {
  return isSound(box) || (!all_present && box == kEmptyBox);
}

std::string faultOf(const Aabb& box, bool all_present) {
  if (box != kEmptyBox) return fault(box);
  return all_present ? "is that of an absent body, though the header says that all are present"
                     : "";
}

template <class T>
void add(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void align(std::vector<std::byte>& bytes) { bytes.resize(aligned(bytes.size())); }

// The header. After the JSON come the numbers of each body that it announces, aligned.

/// Numbers of bodies that a header may announce: bytes of each, where they are in a filter, and how
/// a body gets its own.
struct Group {
  std::string_view key;
  std::uint64_t bytes;
  std::span<const std::byte> (*in)(const CollisionFilter&);
  void (*put)(BodyGroups&, const std::byte*);
};

constexpr Group kGroups[] = {
    {"layers", sizeof(BodyGroups::layer),
     [](const CollisionFilter& filter) { return std::as_bytes(filter.layers()); },
     [](BodyGroups& body, const std::byte* raw) {
       std::memcpy(&body.layer, raw, sizeof body.layer);
     }},
    {"worlds", sizeof(BodyGroups::world),
     [](const CollisionFilter& filter) { return std::as_bytes(filter.worlds()); },
     [](BodyGroups& body, const std::byte* raw) {
       std::memcpy(&body.world, raw, sizeof body.world);
     }},
    {"tags", sizeof(BodyGroups::tags),
     [](const CollisionFilter& filter) { return std::as_bytes(filter.tags()); },
     [](BodyGroups& body, const std::byte* raw) {
       std::memcpy(&body.tags, raw, sizeof body.tags);
     }},
};

/// Those that a header announces, in the order of the list above.
std::vector<Group> groupsIn(const JsonFields& fields) {
  std::vector<Group> groups;
  const Json& keys = fields.array("groups");
  for (const Group& group : kGroups) {
    if (groups.size() < keys.size() && keys[groups.size()] == group.key) groups.push_back(group);
  }
  if (groups.size() == keys.size()) return groups;
  throw InputError(
      fmt::format("{}: some of 'layers', 'worlds', 'tags', in this order, are expected",
                  fields.path("groups")));
}

std::uint64_t groupBytes(const JsonFields& fields, std::uint64_t objects) {
  std::uint64_t sum = 0;
  for (const Group& group : groupsIn(fields)) sum += aligned(group.bytes * objects);
  return sum;
}

Json boxJson(const Aabb& box) {
  const auto corner = [](const std::array<float, 4>& c) { return Json{c[0], c[1], c[2]}; };
  return Json{corner(box.min), corner(box.max)};
}

/// Pairs of layers that collide, as a list.
Json matrixJson(const LayerMatrix& matrix) {
  Json pairs = Json::array();
  for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
    for (std::size_t b = a; b < LayerMatrix::kLayers; ++b) {
      if (matrix.collide(a, b)) pairs.push_back(Json{a, b});
    }
  }
  return pairs;
}

std::vector<std::byte> headerBytes(const SceneInfo& scene, const RecordingOrigin& origin) {
  Json json;
  json["schema"] = kSchema;
  json["name"] = scene.name;
  json["object_type"] = scene.object_type;
  json["objects"] = scene.objects;
  json["frames"] = scene.frames;
  json["world"] = boxJson(scene.world);
  json["all_present"] = scene.all_present;
  json["colliding_layers"] = matrixJson(scene.filter.matrix());
  Json& groups = json["groups"] = Json::array();
  for (const Group& group : kGroups) {
    if (!group.in(scene.filter).empty()) groups.push_back(group.key);
  }
  json["source"] = origin.source.empty() ? Json(nullptr) : Json(origin.source);
  json["scene_parameters"] = origin.scene_parameters.empty()
                                 ? Json(nullptr)
                                 : parseJson(origin.scene_parameters, "scene parameters");
  std::string text = formatJson(json);
  text.insert(text.size() - 1, aligned(sizeof(Start) + text.size()) - sizeof(Start) - text.size(),
              ' ');
  const Start start{.header_bytes = text.size()};
  std::vector<std::byte> bytes;
  add(bytes, std::span(&start, 1));
  add(bytes, std::span<const char>(text));
  for (const Group& group : kGroups) {
    add(bytes, group.in(scene.filter));
    align(bytes);
  }
  return bytes;
}

std::string nameIn(const JsonFields& fields, const char* key) {
  std::string text = fields.text(key);
  if (isName(text)) return text;
  throw InputError(fmt::format("{}: at most {} printable ASCII characters are expected",
                               fields.path(key), kLongestName));
}

Aabb worldIn(const JsonFields& fields) {
  PackedBox numbers{};
  const Json& corners = fields.array("world");
  bool right = corners.size() == 2;
  for (std::size_t i = 0; right && i < 2; ++i)
    right = corners[i].is_array() && corners[i].size() == 3;
  for (std::size_t i = 0; right && i < numbers.size(); ++i) {
    const Json& number = corners[i / 3][i % 3];
    right = number.is_number();
    if (right) numbers[i] = static_cast<float>(number.get<double>());
  }
  Aabb world;
  BoxCorners(std::as_bytes(std::span(numbers)).data()).put(world);
  if (!right || !isSound(world)) {
    throw InputError(fmt::format(
        "{}: two corners of three finite numbers, min <= max, are expected", fields.path("world")));
  }
  return world;
}

LayerMatrix matrixIn(const JsonFields& fields) {
  LayerMatrix matrix;
  for (const Json& pair : fields.array("colliding_layers")) {
    const auto layer = [&](std::size_t i) {
      const bool right = pair.is_array() && pair.size() == 2 && pair[i].is_number_unsigned() &&
                         pair[i].get<std::uint64_t>() < LayerMatrix::kLayers;
      if (right) return pair[i].get<std::size_t>();
      throw InputError(fmt::format("{}: pairs of layers from 0 to {} are expected",
                                   fields.path("colliding_layers"), LayerMatrix::kLayers - 1));
    };
    matrix.set(layer(0), layer(1));
  }
  return matrix;
}

/// `raw` holds the numbers of all bodies, one group after the other.
CollisionFilter filterIn(const JsonFields& fields, std::span<const std::byte> raw,
                         std::uint32_t objects) {
  const std::vector<Group> groups = groupsIn(fields);
  std::vector<BodyGroups> bodies(groups.empty() ? 0 : objects);
  for (const Group& group : groups) {
    for (std::size_t i = 0; i < bodies.size(); ++i) group.put(bodies[i], &raw[group.bytes * i]);
    raw = raw.subspan(aligned(group.bytes * objects));
  }
  const auto unknown = std::ranges::find_if(
      bodies, [](const BodyGroups& body) { return body.layer >= LayerMatrix::kLayers; });
  if (unknown != bodies.end()) {
    throw InputError(fmt::format("{}: body {} is in layer {}: there are layers 0 to {}",
                                 fields.name(), unknown - bodies.begin(), unknown->layer,
                                 LayerMatrix::kLayers - 1));
  }
  return {bodies, matrixIn(fields)};
}

/// A text that may be null.
std::string textIn(const JsonFields& fields, const char* key) {
  return fields.has(key) ? fields.text(key) : std::string();
}

RecordingOrigin originIn(const JsonFields& fields) {
  RecordingOrigin origin{.source = textIn(fields, "source"), .scene_parameters = {}};
  if (fields.has("scene_parameters")) {
    const Json& parameters = fields.at("scene_parameters");
    JsonFields(parameters, fields.path("scene_parameters"));
    origin.scene_parameters = formatJson(parameters);
  }
  return origin;
}

/// The scene but for its filter.
SceneInfo sceneIn(const JsonFields& fields) {
  return {.name = nameIn(fields, "name"),
          .object_type = nameIn(fields, "object_type"),
          .objects = fields.integer<std::uint32_t>("objects"),
          .frames = fields.integer<std::uint32_t>("frames"),
          .world = worldIn(fields),
          .all_present = fields.boolean("all_present")};
}

class Recording2File final : public BoxRecordingFile {
 public:
  Recording2File(const std::filesystem::path& path, const SceneInfo& scene,
                 const RecordingOrigin& origin)
      : scene_(scene) {
    requireNames(scene);
    block_ = headerBytes(scene, origin);
    file_ = growingFile(path, scene);
    hasher_.add(block_);
    appendBlock();
  }

  void write(std::span<const Aabb> boxes) override {
    requireBodies(boxes.size(), scene_, file_->name());
    requireRecordable(boxes);
    const Frame frame = changes_.complete({static_cast<std::uint32_t>(index_.size()), boxes});
    const auto ids = frame.changed.value_or(std::span<const std::uint32_t>());
    const std::uint32_t key = keyOf(frame.index, ids.size());
    const bool whole = key == frame.index;
    const Layout layout(static_cast<std::uint32_t>(ids.size()), whole, scene_.objects);

    block_.clear();
    add(block_, ids.first(layout.ids));
    block_.resize(layout.bytes());
    std::byte* place = block_.data() + layout.idBytes();
    for (std::uint64_t row = 0; row < layout.rows; ++row, place += sizeof(PackedBox)) {
      const PackedBox box = packed(boxes[whole ? row : ids[row]]);
      std::memcpy(place, box.data(), sizeof box);
    }
    index_.push_back({offset_, static_cast<std::uint32_t>(ids.size()), key, hashOf(block_)});
    appendBlock();
  }

  std::string finish() override {
    complete();
    return file_->finish();
  }
  std::unique_ptr<Recording> finishTemporary() override {
    complete();
    return std::make_unique<Recording2Reader>(file_->finishTemporary(), file_->name());
  }

 private:
  void requireRecordable(std::span<const Aabb> boxes) const {
    bool sound = true;
    for (const Aabb& box : boxes) sound &= isRecordable(box, scene_.all_present);
    if (sound) return;
    const auto broken = std::ranges::find_if_not(
        boxes, [&](const Aabb& box) { return isRecordable(box, scene_.all_present); });
    throw InputError(fmt::format("{}: frame {}, body {}: the box {}", file_->name(), index_.size(),
                                 broken - boxes.begin(), faultOf(*broken, scene_.all_present)));
  }

  /// The key frame of the next frame, in which so many bodies changed.
  std::uint32_t keyOf(std::uint32_t index, std::uint64_t changed) {
    since_key_ += changed * (sizeof(std::uint32_t) + sizeof(PackedBox));
    const std::uint64_t whole = sizeof(PackedBox) * std::uint64_t{scene_.objects};
    const std::uint32_t last = index == 0 ? 0 : index_.back().key;
    if (index > 0 && since_key_ < whole && index - last < kMostBetweenKeys) return last;
    since_key_ = 0;
    return index;
  }

  void appendBlock() {
    offset_ += block_.size();
    file_->append(block_);
  }

  /// Writes index and end.
  void complete() {
    requireWhole(index_.size(), scene_, file_->name());
    block_.clear();
    add(block_, std::span<const RecordedFrame>(index_));
    hasher_.add(block_);
    const End end{.index_offset = offset_, .hash = hasher_.value()};
    add(block_, std::span(&end, 1));
    appendBlock();
  }

  SceneInfo scene_;
  std::unique_ptr<GrowingFile> file_;
  ChangedBodies changes_;
  std::vector<RecordedFrame> index_;
  std::vector<std::byte> block_;  ///< what is written next
  std::uint64_t offset_ = 0;      ///< where that begins
  std::uint64_t since_key_ = 0;   ///< bytes of what changed since the last key frame
  Hasher hasher_;                 ///< of all but the frames
};

}  // namespace

std::unique_ptr<BoxRecordingFile> makeRecording2File(const std::filesystem::path& path,
                                                     const SceneInfo& scene,
                                                     const RecordingOrigin& origin) {
  return std::make_unique<Recording2File>(path, scene, origin);
}

Recording2Reader::Recording2Reader(const std::filesystem::path& path)
    : Recording2Reader(openForReading(path), path.string()) {}

Recording2Reader::Recording2Reader(FileDescriptor file, std::string name)
    : Recording(std::move(file), std::move(name)) {
  open();
  boxes_.resize(scene().objects);
  ids_.resize(aligned(sizeof(std::uint32_t) * scene().objects) / sizeof(std::uint32_t));
  piece_.resize(aligned(sizeof(PackedBox) * std::min<std::uint64_t>(kPieceRows, boxes_.size())));
}

namespace {

template <class... Arguments>
[[noreturn]] void refuse(const std::string& name, fmt::format_string<Arguments...> text,
                         Arguments&&... arguments) {
  throw InputError(
      fmt::format("{}: {}", name, fmt::format(text, std::forward<Arguments>(arguments)...)));
}

}  // namespace

void Recording2Reader::open() {
  constexpr std::uint64_t kLeast = sizeof(Start) + sizeof(End);
  if (bytes() < kLeast) {
    refuse(name(), "{} bytes is too short: a recording 2 has at least {}", bytes(), kLeast);
  }
  Start start;
  read(0, std::as_writable_bytes(std::span(&start, 1)));
  if (start.magic != kMagic) {
    refuse(name(), "byte 0: is not '{}': not a recording 2", fmt::join(kMagic, ""));
  }
  const std::uint64_t last = bytes() - sizeof(End);
  End end;
  read(last, std::as_writable_bytes(std::span(&end, 1)));
  if (end.magic != kMagic) {
    refuse(name(), "byte {}: does not end as a recording 2: cut short, or not finished?", last);
  }
  if (start.header_bytes > std::min(kMostHeaderBytes, last - sizeof start) ||
      (sizeof start + start.header_bytes) % kAlignment != 0) {
    refuse(name(), "byte 8: a header of {} bytes cannot be: it ends at a multiple of {}",
           start.header_bytes, kAlignment);
  }
  hasher_.restart();
  hasher_.add(std::as_bytes(std::span(&start, 1)));
  const std::uint64_t frames_offset = readHeader(start.header_bytes, end.index_offset);
  readIndex(end.index_offset);
  if (hasher_.value() != end.hash) {
    refuse(name(), "header or index: damaged: their checksum is another");
  }
  checkIndex(frames_offset, end.index_offset);
}

std::uint64_t Recording2Reader::readHeader(std::uint64_t size, std::uint64_t index_offset) {
  std::string text(size, ' ');
  read(sizeof(Start), std::as_writable_bytes(std::span(text)));
  hasher_.add(std::as_bytes(std::span(text)));
  const std::string header = name() + ": header";
  const Json json = parseJson(text, header);
  const JsonFields fields(json, header);
  if (const std::string schema = fields.text("schema"); schema != kSchema) {
    refuse(header, "schema: '{}' is expected, not '{}'", kSchema, onOneLine(schema));
  }
  SceneInfo scene = sceneIn(fields);
  origin_ = originIn(fields);

  // The initial pose takes 24 bytes a body: the file's length bounds all that follows.
  const std::uint64_t offset = sizeof(Start) + size;
  const std::uint64_t last = bytes() - sizeof(End);
  const std::uint64_t index_bytes = sizeof(RecordedFrame) * (std::uint64_t{1} + scene.frames);
  if (offset + sizeof(PackedBox) * std::uint64_t{scene.objects} + index_bytes > last) {
    refuse(name(), "{} bytes is too short for {} objects and {} frames", bytes(), scene.objects,
           scene.frames);
  }
  if (index_offset != last - index_bytes) {
    refuse(name(), "byte {}: the index of {} frames begins at byte {}, not {}", last, scene.frames,
           last - index_bytes, index_offset);
  }
  std::vector<std::byte> groups(groupBytes(fields, scene.objects));
  if (groups.size() > index_offset - offset) {
    refuse(name(), "byte {}: ends within the groups of the bodies", index_offset);
  }
  read(offset, groups);
  hasher_.add(groups);
  scene.filter = filterIn(fields, groups, scene.objects);
  setScene(std::move(scene));
  return offset + groups.size();
}

void Recording2Reader::readIndex(std::uint64_t offset) {
  index_.resize(std::size_t{1} + scene().frames);
  const auto raw = std::as_writable_bytes(std::span(index_));
  read(offset, raw);
  hasher_.add(raw);
}

void Recording2Reader::checkIndex(std::uint64_t begin, std::uint64_t end) const {
  std::uint64_t offset = begin;
  for (std::uint32_t i = 0; i < index_.size(); ++i) {
    const auto& [place, changed, key, hash] = index_[i];
    const bool whole = key == i;
    const bool right = place == offset && changed <= scene().objects &&
                       (i > 0 || (whole && changed == 0)) && (whole || key == index_[i - 1].key);
    if (!right) {
      throw InputError(fmt::format(
          "{}: byte {}: index: frame {} cannot be at byte {} with {} changed bodies and "
          "key frame {}",
          name(), end + sizeof(RecordedFrame) * i, i, place, changed, key));
    }
    offset += Layout(changed, whole, scene().objects).bytes();
    if (offset > end) break;
  }
  if (offset != end) {
    throw InputError(fmt::format("{}: the frames end at byte {}, but the index begins at byte {}",
                                 name(), offset, end));
  }
}

std::span<const Aabb> Recording2Reader::readBoxes(std::uint32_t index) {
  if (current_ == index) return boxes_;
  const std::uint32_t key = index_[index].key;
  const bool onward = current_ && key <= *current_ && *current_ < index;
  const bool next = current_ && *current_ + 1 == index;
  for (std::uint32_t i = onward || next ? *current_ + 1 : key; i <= index; ++i) readFrame(i);
  return boxes_;
}

void Recording2Reader::readFrame(std::uint32_t index) {
  const bool follows = current_ && *current_ + 1 == index;
  current_.reset();  // until all is read
  hasher_.restart();
  readIds(index);
  if (index_[index].key == index) {
    readAllBoxes(index, follows);
  } else {
    readChangedBoxes(index);
  }
  if (hasher_.value() != index_[index].hash) fail(index, "");
  current_ = index;
}

void Recording2Reader::readIds(std::uint32_t index) {
  const RecordedFrame& frame = index_[index];
  const Layout layout(frame.changed, frame.key == index, scene().objects);
  changed_ = frame.changed;
  const auto raw = std::as_writable_bytes(std::span(ids_)).first(layout.idBytes());
  read(frame.offset, raw);
  hasher_.add(raw);
  if (layout.ids == 0) {
    std::iota(ids_.begin(), ids_.begin() + changed_, 0U);
    return;
  }
  std::uint32_t unordered = 0;
  for (std::uint32_t i = 1; i < changed_; ++i) {
    unordered |= static_cast<std::uint32_t>(ids_[i] <= ids_[i - 1]);
  }
  if (unordered == 0 && ids_[changed_ - 1] < scene().objects) return;
  for (std::uint32_t i = 0; i < changed_; ++i) {
    if (ids_[i] < scene().objects && (i == 0 || ids_[i - 1] < ids_[i])) continue;
    fail(index, fmt::format("byte {}: body {} among the changed ones: they are expected to ascend "
                            "and to be below {}",
                            frame.offset + sizeof(std::uint32_t) * i, ids_[i], scene().objects));
  }
}

template <class Take>
void Recording2Reader::readRows(std::uint32_t index, Take&& take) {
  const RecordedFrame& frame = index_[index];
  const Layout layout(frame.changed, frame.key == index, scene().objects);
  const bool may_be_empty = !scene().all_present;
  std::uint64_t offset = frame.offset + layout.idBytes();
  for (std::uint64_t first = 0; first < layout.rows; first += kPieceRows) {
    const std::uint64_t rows = std::min(kPieceRows, layout.rows - first);
    const auto raw = std::span(piece_).first(aligned(sizeof(PackedBox) * rows));
    read(offset, raw);
    hasher_.add(raw);
    offset += raw.size();
    for (std::uint64_t row = 0; row < rows; ++row) {
      const BoxCorners box(raw.data() + sizeof(PackedBox) * row);
      if (!box.isRight(may_be_empty)) failAt(index, first + row, box);
      take(first + row, box);
    }
  }
}

void Recording2Reader::readAllBoxes(std::uint32_t index, bool follows) {
  // Who relies on `changed` misses what changed without being named.
  if (follows && changed_ < scene().objects) {
    readRows(index, [&, listed = std::uint32_t{0}](std::uint64_t body,
                                                   const BoxCorners& box) mutable {
      if (listed < changed_ && ids_[listed] == body) {
        ++listed;
      } else if (!box.is(boxes_[body])) {
        failAt(index, body, "differs from the frame before, but is not among the changed bodies");
      }
      box.put(boxes_[body]);
    });
  } else {
    readRows(index, [&](std::uint64_t body, const BoxCorners& box) { box.put(boxes_[body]); });
  }
}

void Recording2Reader::readChangedBoxes(std::uint32_t index) {
  readRows(index, [&](std::uint64_t row, const BoxCorners& box) { box.put(boxes_[ids_[row]]); });
}

void Recording2Reader::failAt(std::uint32_t index, std::uint64_t row, const BoxCorners& box) {
  Aabb unpacked;
  box.put(unpacked);
  failAt(index, row, "the box " + faultOf(unpacked, scene().all_present));
}

void Recording2Reader::failAt(std::uint32_t index, std::uint64_t row, const std::string& what) {
  const RecordedFrame& frame = index_[index];
  const bool whole = frame.key == index;
  const Layout layout(frame.changed, whole, scene().objects);
  fail(index, fmt::format("body {} (byte {}): {}", whole ? row : ids_[row],
                          frame.offset + layout.idBytes() + sizeof(PackedBox) * row, what));
}

void Recording2Reader::fail(std::uint32_t index, const std::string& what) {
  const RecordedFrame& frame = index_[index];
  const Layout layout(frame.changed, frame.key == index, scene().objects);
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
  throw InputError(fmt::format("{}: frame {} (bytes {} to {}): damaged: its checksum is another",
                               name(), index, frame.offset, frame.offset + layout.bytes() - 1));
}

}  // namespace broadmark
