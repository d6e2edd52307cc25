// Minimal files for opening sessions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/files.h"
#include "broadmark/harness/runner.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"
#include "engine/helpers.h"

namespace broadmark::tests {

/// A recording of two frames with two touching unit boxes.
inline void writeRecording(const std::filesystem::path& path) {
  const SceneInfo scene{.name = "Small",
                        .object_type = "Cubes",
                        .objects = 2,
                        .frames = 1,
                        .world = {{-9, -9, -9, 0}, {9, 9, 9, 0}}};
  RecordingWriter writer(path, scene);
  for (int frame = 0; frame < 2; ++frame) writer.write(chain(2));
  writer.finish();
}

inline const std::string kAuthoredSceneText =
    R"({"schema": "broadmark-scene/1", "name": "Mine",
        "world": {"min": [-5, -5, -5], "max": [5, 5, 5]}, "parameters": {"frames": 4},
        "bodies": [{"box": [1, 1, 1], "position": [0, 0, 0]}]})";

inline const std::string kSceneParametersText =
    R"({"schema": "broadmark-scene-parameters/1", "scene": "brownian",
        "parameters": {"objects": 5, "frames": 3, "seed": 8}})";

/// A settings file of the original Broadmark for a recording.
inline std::string originalSettingsText(const std::string& recording) {
  return R"({"m_inputScene": ")" + recording +
         R"(", "m_outputLog": "log.json", "m_algorithm": "BF_SSE", "m_numThreads": 2})";
}

/// The results of a case on a recording, as written by a run; `first_mismatch`: a frame, or 0.
inline CaseResult resultOn(const std::filesystem::path& recording, const std::string& algorithm,
                           std::uint32_t first_mismatch = 0) {
  const auto opened = openRecordingFile(recording);
  for (const Algorithm& known : builtinAlgorithms()) {
    if (known.id != algorithm) continue;
    CaseResult result =
        beginCase(makeCase(known, bestIsa(), 2, {}, {}), {.scene = opened->scene(),
                                                          .seed = {},
                                                          .hash = opened->hash(),
                                                          .path = recording.string(),
                                                          .scene_parameters = {}});
    if (first_mismatch > 0) {
      result.status = Status::mismatch;
      result.reason = "wrong on purpose";
      for (const std::uint32_t frame : {first_mismatch + 2, first_mismatch}) {
        FrameDifference& difference = result.differences.emplace_back();
        difference.frame = frame;
        difference.missed_count = 1;
        difference.missed_pairs = {{0, 1}};
      }
    }
    return result;
  }
  ADD_FAILURE() << "no algorithm " << algorithm;
  return {};
}

inline void writeResults(const std::filesystem::path& path, const std::vector<CaseResult>& cases) {
  const Results results{
      .environments = {thisEnvironment()}, .options = {}, .cases = cases, .complete = true};
  writeTextFile(path, resultWriters().front().format(results));
}

}  // namespace broadmark::tests
