// The values for each repetition or frame in a case's JSON.

#include <fmt/format.h>

#include <algorithm>

#include "json_case.h"

namespace broadmark {
namespace {

/// Whether any frame spent time in a phase.
bool isUsed(Phase phase, const std::vector<Repetition>& repetitions) {
  return std::ranges::any_of(repetitions, [&](const Repetition& repetition) {
    return std::ranges::any_of(repetition.frames,
                               [&](const FrameTimes& frame) { return frame[phase] != 0; });
  });
}

/// Phases of compute devices only, omitted if unused.
bool isOptional(Phase phase) { return phase == Phase::upload || phase == Phase::download; }

/// One array of nanoseconds per phase and repetition.
Json framesToJson(const std::vector<Repetition>& repetitions) {
  Json json = Json::object();
  for (const auto& [phase, name] : kPhases.entries) {
    if (isOptional(phase) && !isUsed(phase, repetitions)) continue;
    Json& arrays = json[std::string(name)] = Json::array();
    for (const Repetition& repetition : repetitions) {
      Json& times = arrays.emplace_back(Json::array());
      for (const FrameTimes& frame : repetition.frames) times.push_back(frame[phase]);
    }
  }
  return json;
}

std::vector<Repetition> framesFrom(const JsonFields& json, const Json& initialize_ns,
                                   const std::string& initialize_name) {
  std::vector<Repetition> repetitions;
  for (const Json& ns : initialize_ns) {
    // null: instructions were counted, not times.
    repetitions.push_back(
        {ns.is_null() ? 0 : JsonFields::integerOf<std::int64_t>(ns, initialize_name, 0), {}});
  }
  for (const auto& [phase, phase_name] : kPhases.entries) {
    const std::string key(phase_name);
    if (isOptional(phase) && !json.has(key.c_str())) continue;
    const Json& arrays = json.array(key.c_str());
    const std::string name = json.path(key.c_str());
    if (arrays.size() != repetitions.size()) {
      throw InputError(fmt::format("{}: {} repetitions instead of the {} initialisations", name,
                                   arrays.size(), repetitions.size()));
    }
    for (std::size_t r = 0; r < arrays.size(); ++r) {
      if (!arrays[r].is_array()) throw InputError(name + ": arrays of nanoseconds are expected");
      auto& frames = repetitions[r].frames;
      if (phase == kPhases.entries.front().value) frames.resize(arrays[r].size());
      if (frames.size() != arrays[r].size()) {
        throw InputError(name + ": all phases must have the same number of frames");
      }
      for (std::size_t f = 0; f < frames.size(); ++f) {
        frames[f][phase] = JsonFields::integerOf<std::int64_t>(arrays[r][f], name, 0);
      }
    }
  }
  return repetitions;
}

/// An array for each name of a table, with the elements get(value, index), index < count.
template <class Table, class Get>
Json arraysOf(const Table& table, std::size_t count, Get&& get) {
  Json json = Json::object();
  for (const auto& [which, name] : table.entries) {
    Json& array = json[std::string(name)] = Json::array();
    for (std::size_t index = 0; index < count; ++index) array.push_back(get(which, index));
  }
  return json;
}

/// Calls read(value, index, element, name for messages) for each element of these arrays. Each
/// array must have `count` elements; otherwise throws InputError with `complaint`.
template <class Table, class Read>
void readArrays(const JsonFields& json, const Table& table, std::size_t count,
                std::string_view complaint, Read&& read) {
  for (const auto& [which, name] : table.entries) {
    const std::string key(name);
    if (!json.has(key.c_str())) continue;
    const Json& array = json.array(key.c_str());
    const std::string path = json.path(key.c_str());
    if (array.size() != count) throw InputError(fmt::format("{}: {}", path, complaint));
    for (std::size_t index = 0; index < count; ++index) read(which, index, array[index], path);
  }
}

/// Counts of wrong pairs only if there are any.
Json frameCountsToJson(const std::vector<FrameCounts>& frames) {
  const auto get = [&](FrameCount which, std::size_t f) { return frames[f][which]; };
  Json json = arraysOf(kFrameCounts, frames.size(), get);
  for (const auto& [which, name] : kFrameCounts.entries) {
    const bool always = which == FrameCount::pairs || which == FrameCount::changed_bodies;
    const auto counted = [which](const FrameCounts& frame) { return frame[which] != 0; };
    if (!always && std::ranges::none_of(frames, counted)) json.erase(std::string(name));
  }
  return json;
}

}  // namespace

void addFrames(Json& json, const CaseResult& result) {
  const std::vector<Repetition>& repetitions = result.repetitions;
  json["initialize_ns"] = Json::array();
  for (const Repetition& repetition : repetitions) {
    json["initialize_ns"].push_back(result.timed() ? Json(repetition.initialize_ns) : Json());
  }
  json["processor"] =
      arraysOf(kProcessorCounters, repetitions.size(), [&](ProcessorCounter which, std::size_t r) {
        return orNull(repetitions[r].processor[which]);
      });
  json["frame_counts"] = frameCountsToJson(result.frames);
  json["frames"] = framesToJson(repetitions);
}

void readFrames(const JsonFields& json, CaseResult& result) {
  std::vector<Repetition>& repetitions = result.repetitions;
  repetitions =
      framesFrom(json.object("frames"), json.array("initialize_ns"), json.path("initialize_ns"));
  if (json.has("processor")) {
    readArrays(
        json.object("processor"), kProcessorCounters, repetitions.size(),
        "one count per repetition is expected",
        [&](ProcessorCounter which, std::size_t r, const Json& sum, const std::string& name) {
          if (sum.is_null()) return;
          repetitions[r].processor[which] = JsonFields::integerOf<std::uint64_t>(sum, name);
        });
  }
  if (!json.has("conditions")) return;  // results/1 ends here
  const JsonFields counts = json.object("frame_counts");
  result.frames.resize(counts.array("pairs").size());
  readArrays(counts, kFrameCounts, result.frames.size(),
             "all counts must have the same number of frames",
             [&](FrameCount which, std::size_t f, const Json& count, const std::string& name) {
               result.frames[f][which] = JsonFields::integerOf<std::uint64_t>(count, name);
             });
}

}  // namespace broadmark
