// The original Broadmark's settings files and logs.

#include "original/settings.h"

#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

/// Reads the margin from its object {x, y, z}.
std::array<double, 3> marginFrom(const JsonFields& json, std::array<double, 3> margin) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (json.has(kAxes[axis])) margin[axis] = json.number(kAxes[axis]);
  }
  return margin;
}

/// Visits every integer key with its field, for both reading and writing.
template <class Settings, class Visit>
void visitIntegers(Settings& settings, Visit&& visit) {
  visit("m_numThreads", settings.threads);
  visit("m_Grid_ObjectsPerCell", settings.grid_objects_per_cell);
  visit("m_Tracy_ObjectsPerCell", settings.tracy_objects_per_cell);
  visit("m_KD_ObjectsPerLeaf", settings.kd_objects_per_leaf);
  visit("m_GPUSap_KernelType", settings.gpu_sap_kernel_type);
}

/// The original's names of phases, in its order.
constexpr std::pair<const char*, Phase> kLogPhases[] = {
    {"Total", Phase::total},
    {"UpdateObjects", Phase::update_objects},
    {"CleanCache", Phase::clean_cache},
    {"UpdateStructures", Phase::update_structures},
    {"SearchOverlaps", Phase::search_overlaps}};

}  // namespace

bool isOriginalSettings(std::string_view json, std::string_view name) {
  return jsonHasKey(json, "m_inputScene", name);
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
  visitIntegers(settings, [&](const char* key, std::int64_t& value) {
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
  visitIntegers(settings, [&](const char* key, std::int64_t value) { header[key] = value; });
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
  return formatJson(log);
}

}  // namespace broadmark
