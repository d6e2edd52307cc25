// The header of a recording 2: JSON, followed by the per-body arrays that it announces.

#include "recording2_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "broadmark/error.h"
#include "recording_file.h"

namespace broadmark {
namespace {

constexpr std::string_view kSchema = "broadmark-recording/2";
// With what older readers would ignore.
constexpr std::string_view kFilterChangesSchema = "broadmark-recording/2.1";
constexpr std::string_view kPeriodicSchema = "broadmark-recording/2.2";

/// A per-body array that a header may announce: its element size, and the access to a filter's
/// array and to a body's value.
struct Group {
  std::string_view key;
  std::uint64_t bytes;
  std::span<const std::byte> (*in)(const CollisionFilter&);
  void (*set)(BodyGroups&, const std::byte*);
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

/// The announced arrays, in the order of the list above.
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

std::string nameIn(const JsonFields& fields, const char* key) {
  std::string text = fields.text(key);
  if (isName(text)) return text;
  throw InputError(fmt::format("{}: at most {} printable ASCII characters are expected",
                               fields.path(key), kMaxNameLength));
}

Aabb worldIn(const JsonFields& fields) {
  PackedBox numbers{};
  const Json& corners = fields.array("world");
  bool is_valid = corners.size() == 2;
  for (std::size_t i = 0; is_valid && i < 2; ++i)
    is_valid = corners[i].is_array() && corners[i].size() == 3;
  for (std::size_t i = 0; is_valid && i < numbers.size(); ++i) {
    const Json& number = corners[i / 3][i % 3];
    is_valid = number.is_number() &&
               std::abs(number.get<double>()) <= double{std::numeric_limits<float>::max()};
    if (is_valid) numbers[i] = static_cast<float>(number.get<double>());
  }
  const Aabb world = unpacked(std::as_bytes(std::span(numbers)).data());
  if (!is_valid || !isSound(world)) {
    throw InputError(fmt::format(
        "{}: two corners of three finite numbers, min <= max, are expected", fields.path("world")));
  }
  return world;
}

PeriodicBox periodicIn(const JsonFields& fields) {
  try {
    return parsePeriodic(fields.text("periodic"));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", fields.path("periodic"), error.what()));
  }
}

LayerMatrix matrixIn(const JsonFields& fields) {
  LayerMatrix matrix;
  for (const Json& pair : fields.array("colliding_layers")) {
    const auto layer = [&](std::size_t i) {
      const bool is_valid = pair.is_array() && pair.size() == 2 && pair[i].is_number_unsigned() &&
                            pair[i].get<std::uint64_t>() < LayerMatrix::kLayers;
      if (is_valid) return pair[i].get<std::size_t>();
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

}  // namespace

std::string recordingFault(const Aabb& box, bool all_present) {
  if (box != kEmptyBox) return fault(box);
  return all_present ? "is that of an absent body, though the header says that "
                       "all are present"
                     : "";
}

std::vector<std::byte> recording2Header(const SceneInfo& scene, const RecordingOrigin& origin) {
  requireNames(scene);
  Json json;
  json["schema"] = scene.periodic.repeats() ? kPeriodicSchema
                   : scene.filter_changes   ? kFilterChangesSchema
                                            : kSchema;
  json["name"] = scene.name;
  json["object_type"] = scene.object_type;
  json["objects"] = scene.objects;
  json["frames"] = scene.frames;
  json["world"] = boxJson(scene.world);
  if (scene.periodic.repeats()) {
    json["periodic"] = periodicText(scene.periodic);
    json["filter_changes"] = scene.filter_changes;
  }
  json["all_present"] = scene.all_present;
  json["colliding_layers"] = matrixJson(scene.filter.matrix());
  Json& groups = json["groups"] = Json::array();
  for (const Group& group : kGroups) {
    if (!group.in(scene.filter).empty()) groups.push_back(group.key);
  }
  json["source"] = origin.source.empty() ? Json(nullptr) : Json(origin.source);
  if (!origin.import.empty()) json["import"] = origin.import;
  json["scene_parameters"] = origin.scene_parameters.empty()
                                 ? Json(nullptr)
                                 : parseJson(origin.scene_parameters, "scene parameters");
  std::string text = formatJson(json);
  text.insert(
      text.size() - 1,
      alignedBytes(sizeof(RecordingStart) + text.size()) - sizeof(RecordingStart) - text.size(),
      ' ');
  const RecordingStart start{.header_bytes = text.size()};
  std::vector<std::byte> bytes;
  appendBytes(bytes, std::span(&start, 1));
  appendBytes(bytes, std::span<const char>(text));
  for (const Group& group : kGroups) {
    appendBytes(bytes, group.in(scene.filter));
    bytes.resize(alignedBytes(bytes.size()));
  }
  return bytes;
}

Recording2Header::Recording2Header(std::string_view text, const std::string& name)
    : json_(parseJson(text, name)), fields_(json_, name) {
  const std::string schema = fields_.text("schema");
  is_periodic_ = schema == kPeriodicSchema;
  filter_changes_ =
      is_periodic_ ? fields_.boolean("filter_changes") : schema == kFilterChangesSchema;
  if (schema != kSchema && !filter_changes_ && !is_periodic_) {
    throw InputError(fmt::format("{}: '{}', '{}' or '{}' is expected, not '{}'",
                                 fields_.path("schema"), kSchema, kFilterChangesSchema,
                                 kPeriodicSchema, onOneLine(schema)));
  }
}

SceneInfo Recording2Header::scene() const {
  return {.name = nameIn(fields_, "name"),
          .object_type = nameIn(fields_, "object_type"),
          .objects = objects(),
          .frames = fields_.integer<std::uint32_t>("frames"),
          .world = worldIn(fields_),
          .all_present = fields_.boolean("all_present"),
          .filter_changes = filter_changes_,
          .periodic = is_periodic_ ? periodicIn(fields_) : PeriodicBox()};
}

RecordingOrigin Recording2Header::origin() const {
  RecordingOrigin origin{.source = textIn(fields_, "source"),
                         .scene_parameters = {},
                         .import = textIn(fields_, "import")};
  if (fields_.has("scene_parameters")) {
    const Json& parameters = fields_.at("scene_parameters");
    [[maybe_unused]] const JsonFields object(parameters, fields_.path("scene_parameters"));
    origin.scene_parameters = formatJson(parameters);
  }
  return origin;
}

std::uint64_t Recording2Header::groupBytes() const {
  std::uint64_t sum = 0;
  for (const Group& group : groupsIn(fields_)) sum += alignedBytes(group.bytes * objects());
  return sum;
}

CollisionFilter Recording2Header::filter(std::span<const std::byte> raw) const {
  const std::vector<Group> groups = groupsIn(fields_);
  std::vector<BodyGroups> bodies(groups.empty() ? 0 : objects());
  for (const Group& group : groups) {
    for (std::size_t i = 0; i < bodies.size(); ++i) group.set(bodies[i], &raw[group.bytes * i]);
    raw = raw.subspan(alignedBytes(group.bytes * bodies.size()));
  }
  const auto unknown = std::ranges::find_if(
      bodies, [](const BodyGroups& body) { return body.layer >= LayerMatrix::kLayers; });
  if (unknown != bodies.end()) {
    throw InputError(fmt::format("{}: body {} is in layer {}: there are layers 0 to {}",
                                 fields_.name(), unknown - bodies.begin(), unknown->layer,
                                 LayerMatrix::kLayers - 1));
  }
  return {bodies, matrixIn(fields_), filter_changes_};
}

}  // namespace broadmark
