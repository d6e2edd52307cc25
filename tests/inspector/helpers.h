// Helpers of the session's tests.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/results/results.h"
#include "engine/helpers.h"
#include "inspector/session/session.h"
#include "support/changing_worlds.h"
#include "support/faulty_algorithm.h"
#include "support/wandering_boxes.h"

namespace broadmark::tests {

/// The built-in algorithms and the faulty ones.
inline std::vector<Algorithm> algorithmsAndFaultyOnes() {
  std::vector<Algorithm> all = builtinAlgorithms();
  for (const Algorithm& algorithm : faulty::variants()) all.push_back(algorithm);
  return all;
}

/// No timeout but the test's own.
inline constexpr std::chrono::hours kForever{24};

/// Commits, waits and advances as several drawn frames do; returns the last progress.
inline RunProgress waitUntilIdle(Session& session) {
  RunProgress seen;
  for (int picture = 0; picture < 4; ++picture) {
    session.jobs.get<BackgroundReading>().wait();
    session.postRequest();
    EXPECT_TRUE(session.runs.waitUntilIdle(kForever));
    session.runs.readProgress([&](const RunProgress& progress) {
      session.advance(progress, 0);
      seen = progress;
    });
  }
  return seen;
}

/// Saves the available frames, and waits until they are written.
inline void saveRecording(Session& session, const std::filesystem::path& path) {
  session.saveRecording(path);
  session.jobs.get<BackgroundSave>().wait();
}

/// A case with these frame times in nanoseconds, a list per repetition.
inline CaseResult caseOf(const std::string& algorithm, std::uint32_t objects,
                         const std::vector<std::vector<std::int64_t>>& repetitions) {
  CaseResult result;
  result.algorithm = algorithm;
  result.recording.scene.name = "Brownian";
  result.recording.scene.object_type = "Cubes";
  result.recording.scene.objects = objects;
  result.recording.scene.frames = 3;
  result.id = fmt::format("Brownian/Cubes/N{}/F3/{}/t2/margin=0.5", objects, algorithm);
  result.threads = 2;
  for (const auto& times : repetitions) {
    Repetition& repetition = result.repetitions.emplace_back();
    for (const std::int64_t ns : times) {
      repetition.frames.emplace_back()[Phase::total] = ns;
    }
  }
  return result;
}

/// A recording of 20 frames: in each frame the present body with the highest number vanishes.
inline std::filesystem::path vanishingBodies(const TemporaryDirectory& directory,
                                             std::uint32_t objects,
                                             const CollisionFilter& filter = {}) {
  WanderingBoxes live(objects, 20, 1);
  const auto present = [=](std::uint32_t body, std::uint32_t frame) {
    return body < objects - frame;
  };
  FrameList scene = changing(live, present, filter);
  const std::filesystem::path path = directory / "vanishing.broadmark";
  RecordingWriter writer(path, scene.scene());
  recordAll(scene, writer);
  writer.finish();
  return path;
}

/// The wrong answer in the snapshot.
inline Session::FailingFrame failingIn(const RunProgress& seen) {
  return {.source = seen.snapshot->source,
          .frame = seen.snapshot->frame,
          .difference = seen.snapshot->difference};
}

}  // namespace broadmark::tests
