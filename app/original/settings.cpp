// The original Broadmark's settings files and logs.

#include "original/settings.h"

#include <fmt/format.h>

#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

/// The margin lives in its own object {x, y, z}.
std::array<double, 3> marginFrom(const JsonFields& json, std::array<double, 3> margin) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (json.has(kAxes[axis])) margin[axis] = json.number(kAxes[axis]);
  }
  return margin;
}

/// Every integer key with the field it is kept in, for reading and writing alike.
template <class Settings, class Visit>
void eachInteger(Settings& settings, Visit&& visit) {
  visit("m_numThreads", settings.threads);
  visit("m_Grid_ObjectsPerCell", settings.grid_objects_per_cell);
  visit("m_Tracy_ObjectsPerCell", settings.tracy_objects_per_cell);
  visit("m_KD_ObjectsPerLeaf", settings.kd_objects_per_leaf);
  visit("m_GPUSap_KernelType", settings.gpu_sap_kernel_type);
}

/// The original's names of the phases, in its order.
constexpr std::pair<const char*, Phase> kLogPhases[] = {
    {"Total", Phase::total},
    {"UpdateObjects", Phase::update_objects},
    {"CleanCache", Phase::clean_cache},
    {"UpdateStructures", Phase::update_structures},
    {"SearchOverlaps", Phase::search_overlaps}};

/// Reads no further than to what tells the kind: a large file is not read twice.
class KindReader final : public JsonEvents {
 public:
  using JsonEvents::JsonEvents;

  [[nodiscard]] const std::string& kind() const { return kind_; }

  bool start_object(std::size_t) override {
    in_object_ |= depth_ == 0;
    return open();
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool key(string_t& key) override {
    if (!atTop()) return true;
    if (key == "m_inputScene") kind_ = "original-settings";
    is_schema_ = key == "schema";
    return kind_.empty();
  }
  bool string(string_t& text) override {
    if (atTop() && is_schema_) kind_ = text;
    return kind_.empty();
  }

 private:
  [[nodiscard]] bool atTop() const { return in_object_ && depth_ == 1; }
  bool open() {
    ++depth_;
    return true;
  }
  bool close() {
    --depth_;
    return true;
  }

  std::string kind_;
  std::size_t depth_ = 0;
  bool in_object_ = false;
  bool is_schema_ = false;
};

}  // namespace

std::string jsonKind(std::string_view text, std::string_view name) {
  KindReader reader(name);
  Json::sax_parse(text, &reader);
  return reader.kind();
}

OriginalSettings parseOriginalSettings(std::string_view text, std::string_view name) {
  const Json json = parseJson(text, name);
  const JsonFields fields(json, std::string(name));
  OriginalSettings settings;
  settings.input_scene = fields.text("m_inputScene");
  settings.output_log = fields.text("m_outputLog");
  settings.algorithm = fields.text("m_algorithm");
  settings.pretty_name = fields.has("m_algorithm_prettyName")
                             ? fields.text("m_algorithm_prettyName")
                             : settings.algorithm;
  if (fields.has("m_margin")) {
    settings.margin = marginFrom(fields.object("m_margin"), settings.margin);
  }
  eachInteger(settings, [&](const char* key, std::int64_t& value) {
    if (fields.has(key)) value = fields.integer<std::int64_t>(key, 0);
  });
  return settings;
}

std::string formatOriginalLog(const OriginalSettings& settings, const CaseResult& result) {
  Json header = {
      {"m_inputScene", settings.input_scene},
      {"m_outputLog", settings.output_log},
      {"m_algorithm", settings.algorithm},
      {"m_algorithm_prettyName", settings.pretty_name},
      {"m_margin",
       {{"x", settings.margin[0]}, {"y", settings.margin[1]}, {"z", settings.margin[2]}}}};
  eachInteger(settings, [&](const char* key, std::int64_t value) { header[key] = value; });
  header["m_numberOfObjects"] = result.recording.scene.objects;

  Json frames = Json::array();
  if (!result.repetitions.empty()) {
    for (const FrameTimes& times : result.repetitions.front().frames) {
      Json& frame = frames.emplace_back(Json::object());
      for (const auto& [key, phase] : kLogPhases) {
        frame[key] = static_cast<double>(times[phase]) * 1e-9;
      }
    }
  }
  const Json log = {{"Settings", std::move(header)}, {"Frames", std::move(frames)}};
  return log.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace broadmark
