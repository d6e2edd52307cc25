// Snapshots: the visible state of a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/harness/oracle.h"
#include "broadmark/names.h"
#include "broadmark/pair.h"
#include "broadmark/recorded_drawing.h"
#include "inspector/run/algorithm_track.h"
#include "inspector/run/answer_cache.h"
#include "inspector/run/frame_provider.h"

namespace broadmark {

/// Origin of the inspected frames.
enum class FrameOrigin { simulation, recording, import, authored, results };
inline constexpr NameTable kFrameOrigins{{NamedValue{FrameOrigin::simulation, "live simulation"},
                                          {FrameOrigin::recording, "recording"},
                                          {FrameOrigin::import, "imported files"},
                                          {FrameOrigin::authored, "authored scene"},
                                          {FrameOrigin::results, "case of results"}}};

/// A source of frames to open. Requests are compared by address: the same one is opened once.
struct FrameProviderRequest {
  FrameProviderOpener open;  ///< called on the run thread
  FrameOrigin origin = FrameOrigin::simulation;
  std::string title;
  /// Requests with the same nonzero number show versions of the same scene: the camera does not
  /// move.
  std::uint64_t scene = 0;
  std::filesystem::path recording = {};  ///< "" for other origins
  std::string scene_parameters = {};     ///< from formatSceneParameters(); "": unknown
};

/// A body's boxes up to the shown frame.
struct Trail {
  std::uint32_t body = 0;
  std::uint32_t first = 0;  ///< frame of the first box
  std::vector<Aabb> boxes;
};

/// The visible state of a frame. Immutable.
struct Snapshot {
  std::shared_ptr<const FrameProviderRequest> source;
  SceneInfo scene;
  std::uint32_t frame = 0;
  std::shared_ptr<const std::vector<Aabb>> boxes;
  std::uint32_t present = 0;                              ///< number of present bodies
  std::shared_ptr<const std::vector<Aabb>> boxes_before;  ///< null for frame 0
  int track = 0;                        ///< number of the answer's track; 0: the oracle's
  std::vector<Pair> pairs;              ///< the answer
  std::vector<std::uint32_t> overlaps;  ///< per body: number of the answer's pairs with it
  bool checked = false;
  std::uint64_t oracle_pair_count = 0;         ///< number of the oracle's pairs, if checked
  std::vector<std::uint32_t> oracle_overlaps;  ///< `overlaps` for the oracle's pairs, if checked
  FrameDifference difference;                  ///< from the oracle's answer, if checked
  Counts counters;                             ///< the track's work counters
  std::shared_ptr<const RecordedDrawing> structure;  ///< null: not requested
  std::vector<Trail> trails;
};

/// Content of a snapshot. Holds references.
struct SnapshotRequest {
  const std::shared_ptr<const FrameProviderRequest>& source;
  FrameProvider& provider;
  std::uint32_t frame = 0;  ///< must be available
  AlgorithmTrack* track =
      nullptr;  ///< provides the answer; if null, or neither at this frame nor cached: the oracle
  AnswerCache* cache = nullptr;  ///< null: no cache
  bool check = true;
  bool structure = false;
  std::span<const std::uint32_t> trail_bodies;  ///< bodies to show over the last frames
};
/// Captures a snapshot. Returns null if the track fails meanwhile.
std::shared_ptr<const Snapshot> captureSnapshot(const SnapshotRequest& request, Oracle& oracle);

/// Reads the answer of a track that is at this frame. `checked`: it was compared with the oracle's,
/// with this difference if the algorithm can be checked.
CachedAnswer answerOf(AlgorithmTrack& track, const Frame& frame, bool checked,
                      std::optional<FrameDifference> difference, const SceneInfo&, Oracle& oracle);

struct PairComparison {
  std::vector<Pair> first_only;   ///< ascending
  std::vector<Pair> second_only;  ///< ascending
  std::uint64_t both = 0;
};

/// Compares pairs in any order; duplicates count once. O(n log n).
PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second);

/// Number of bodies that are present.
std::uint32_t countPresent(std::span<const Aabb> boxes);

}  // namespace broadmark
