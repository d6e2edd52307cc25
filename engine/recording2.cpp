// Recording 2: frames as what changed. Key frames are set so that what lies between two of them
// takes no more than a whole frame: the file is at most twice as large as without them, and a frame
// is at most two whole frames away.

#include "broadmark/recording2.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "broadmark/changed_bodies.h"
#include "broadmark/error.h"
#include "broadmark/json_fields.h"
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

/// A box in the file: min x y z, max x y z.
using PackedBox = std::array<float, 6>;

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

PackedBox packed(const Aabb& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

Aabb unpacked(const PackedBox& box) {
  return {{box[0], box[1], box[2], 0}, {box[3], box[4], box[5], 0}};
}

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

/// The numbers of bodies in a filter: visit(key, those of all bodies or none).
template <class Filter, class Visit>
void visitGroups(Filter&& filter, Visit&& visit) {
  visit("layers", filter.layers());
  visit("worlds", filter.worlds());
  visit("tags", filter.tags());
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
  visitGroups(scene.filter, [&](const char* key, auto numbers) {
    if (!numbers.empty()) groups.push_back(key);
  });
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
  visitGroups(scene.filter, [&](const char*, auto numbers) {
    add(bytes, numbers);
    align(bytes);
  });
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
  const Aabb world = unpacked(numbers);
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

void Recording2Reader::open() {
  const auto refuse = [&](std::string what) { throw InputError(name() + ": " + std::move(what)); };
  Start start;
  End end;
  if (bytes() < sizeof start + sizeof end) {
    refuse(fmt::format("{} bytes is too short: a recording 2 has at least {}", bytes(),
                       sizeof start + sizeof end));
  }
  read(0, std::as_writable_bytes(std::span(&start, 1)));
  if (start.magic != kMagic) {
    refuse(fmt::format("byte 0: is not '{}': not a recording 2",
                       std::string_view(kMagic.data(), kMagic.size())));
  }
  const std::uint64_t last = bytes() - sizeof end;
  read(last, std::as_writable_bytes(std::span(&end, 1)));
  if (end.magic != kMagic) {
    refuse(
        fmt::format("byte {}: does not end as a recording 2: cut short, or not finished?", last));
  }
  if (start.header_bytes > kMostHeaderBytes || start.header_bytes > last - sizeof start ||
      (sizeof start + start.header_bytes) % kAlignment != 0) {
    refuse(
        fmt::format("byte 8: a header of {} bytes is expected to end at a multiple of {} within "
                    "the file of {} bytes",
                    start.header_bytes, kAlignment, bytes()));
  }
  std::string text(start.header_bytes, ' ');
  read(sizeof start, std::as_writable_bytes(std::span(text)));
  const Json json = parseJson(text, name() + ": header");
  const JsonFields fields(json, name() + ": header");
  if (const std::string schema = fields.text("schema"); schema != kSchema) {
    refuse(fmt::format("header: schema: '{}' is expected, not '{}'", kSchema, onOneLine(schema)));
  }
  SceneInfo scene = sceneIn(fields);
  origin_ = originIn(fields);

  hasher_.restart();
  hasher_.add(std::as_bytes(std::span(&start, 1)));
  hasher_.add(std::as_bytes(std::span(text)));

  // The initial pose takes 24 bytes per body: a file that is long enough bounds all that follows.
  std::uint64_t offset = sizeof start + start.header_bytes;
  const std::uint64_t least = offset + sizeof(PackedBox) * std::uint64_t{scene.objects} +
                              sizeof(RecordedFrame) * (std::uint64_t{1} + scene.frames);
  if (least > last) {
    refuse(fmt::format("{} bytes is too short for {} objects and {} frames", bytes(), scene.objects,
                       scene.frames));
  }
  const std::uint64_t index_bytes = sizeof(RecordedFrame) * (std::uint64_t{1} + scene.frames);
  if (end.index_offset != last - index_bytes) {
    refuse(fmt::format("byte {}: the index of {} frames begins at byte {}, not {}", last,
                       scene.frames, last - index_bytes, end.index_offset));
  }

  std::vector<std::uint8_t> layers;
  std::vector<std::uint32_t> worlds;
  std::vector<BodyGroups::Tags> tags;
  const auto take = [&](auto& numbers) {
    using Number = typename std::remove_reference_t<decltype(numbers)>::value_type;
    numbers.resize(aligned(sizeof(Number) * scene.objects) / sizeof(Number) + 1);
    const auto raw =
        std::as_writable_bytes(std::span(numbers)).first(aligned(sizeof(Number) * scene.objects));
    if (raw.size() > end.index_offset - offset) {
      refuse(fmt::format("byte {}: ends within the groups of the bodies", end.index_offset));
    }
    read(offset, raw);
    hasher_.add(raw);
    offset += raw.size();
    numbers.resize(scene.objects);
  };
  for (const Json& group : fields.array("groups")) {
    if (group == "layers" && layers.empty() && worlds.empty() && tags.empty()) {
      take(layers);
    } else if (group == "worlds" && worlds.empty() && tags.empty()) {
      take(worlds);
    } else if (group == "tags" && tags.empty()) {
      take(tags);
    } else {
      refuse("header: groups: some of 'layers', 'worlds', 'tags', in this order, are expected");
    }
  }
  std::vector<BodyGroups> groups(fields.array("groups").empty() ? 0 : scene.objects);
  for (std::uint32_t body = 0; body < groups.size(); ++body) {
    if (!layers.empty()) groups[body].layer = layers[body];
    if (!worlds.empty()) groups[body].world = worlds[body];
    if (!tags.empty()) groups[body].tags = tags[body];
    if (groups[body].layer >= LayerMatrix::kLayers) {
      refuse(fmt::format("body {}: layer {}: there are layers 0 to {}", body, groups[body].layer,
                         LayerMatrix::kLayers - 1));
    }
  }
  scene.filter = CollisionFilter(groups, matrixIn(fields));

  index_.resize(std::size_t{1} + scene.frames);
  const auto raw = std::as_writable_bytes(std::span(index_));
  read(end.index_offset, raw);
  hasher_.add(raw);
  if (hasher_.value() != end.hash) {
    refuse("header or index: damaged: their checksum is another");
  }
  setScene(std::move(scene));
  checkIndex(offset, end.index_offset);
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
  std::uint64_t offset = frame.offset + layout.idBytes();
  for (std::uint64_t first = 0; first < layout.rows; first += kPieceRows) {
    const std::uint64_t rows = std::min(kPieceRows, layout.rows - first);
    const auto raw = std::span(piece_).first(aligned(sizeof(PackedBox) * rows));
    read(offset, raw);
    hasher_.add(raw);
    offset += raw.size();
    for (std::uint64_t row = 0; row < rows; ++row) {
      PackedBox box;
      std::memcpy(box.data(), raw.data() + sizeof box * row, sizeof box);
      take(first + row, unpacked(box));
    }
  }
}

void Recording2Reader::readAllBoxes(std::uint32_t index, bool follows) {
  // Who relies on `changed` misses what changed without being named.
  const bool check_others = follows && changed_ < scene().objects;
  const bool all_present = scene().all_present;
  std::uint32_t listed = 0;
  readRows(index, [&](std::uint64_t body, const Aabb& box) {
    if (!isRecordable(box, all_present)) {
      failAt(index, static_cast<std::uint32_t>(body), body, "the box " + faultOf(box, all_present));
    }
    if (check_others) {
      if (listed < changed_ && ids_[listed] == body) {
        ++listed;
      } else if (box != boxes_[body]) {
        failAt(index, static_cast<std::uint32_t>(body), body,
               "differs from the frame before, but is not among the changed bodies");
      }
    }
    boxes_[body] = box;
  });
}

void Recording2Reader::readChangedBoxes(std::uint32_t index) {
  const bool all_present = scene().all_present;
  readRows(index, [&](std::uint64_t row, const Aabb& box) {
    if (!isRecordable(box, all_present)) {
      failAt(index, ids_[row], row, "the box " + faultOf(box, all_present));
    }
    boxes_[ids_[row]] = box;
  });
}

void Recording2Reader::failAt(std::uint32_t index, std::uint32_t body, std::uint64_t row,
                              const std::string& what) {
  const RecordedFrame& frame = index_[index];
  const Layout layout(frame.changed, frame.key == index, scene().objects);
  fail(index, fmt::format("body {} (byte {}): {}", body,
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
