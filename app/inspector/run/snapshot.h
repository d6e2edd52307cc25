// The visible state of a frame, and how it is captured.
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

/// Where what is looked at comes from.
enum class FrameOrigin { simulation, recording, import, authored, results };
inline constexpr NameTable kFrameOrigins{{NamedValue{FrameOrigin::simulation, "live simulation"},
                                          {FrameOrigin::recording, "recording"},
                                          {FrameOrigin::import, "imported files"},
                                          {FrameOrigin::authored, "authored scene"},
                                          {FrameOrigin::results, "case of results"}}};

/// What to look at. Compared by address: the same one is opened once.
struct FrameProviderRequest {
  FrameProviderOpener open;  ///< called on the run thread
  FrameOrigin origin = FrameOrigin::simulation;
  std::string title;
  /// Requests of the same number, unless 0, show the same scene, perhaps changed: the camera stays
  /// where it is.
  std::uint64_t scene = 0;
  std::filesystem::path recording = {};  ///< "": something else
  std::string scene_parameters = {};     ///< as formatSceneParameters() writes them; "": unknown
};

/// A body's boxes up to the shown frame.
struct Trail {
  std::uint32_t body = 0;
  std::uint32_t first = 0;  ///< the frame of the first box
  std::vector<Aabb> boxes;
};

/// The visible state of a frame. Immutable.
struct Snapshot {
  std::shared_ptr<const FrameProviderRequest> source;
  SceneInfo scene;
  std::uint32_t frame = 0;
  std::shared_ptr<const std::vector<Aabb>> boxes;
  std::uint32_t present = 0;                              ///< bodies that are there
  std::shared_ptr<const std::vector<Aabb>> boxes_before;  ///< null for frame 0
  int track = 0;                        ///< number of the answer's track; 0: the oracle's
  std::vector<Pair> pairs;              ///< the answer
  std::vector<std::uint32_t> overlaps;  ///< per body, in how many pairs of the answer it is
  bool checked = false;
  std::uint64_t right_pairs = 0;              ///< that the oracle finds, if checked
  std::vector<std::uint32_t> right_overlaps;  ///< as `overlaps`, of the oracle's pairs, if checked
  FrameDifference difference;                 ///< from the right answer, if checked
  Counts counters;                            ///< of the track's work
  std::shared_ptr<const RecordedDrawing> structure;  ///< null: not asked for
  std::vector<Trail> trails;
};

/// What a snapshot is to show; borrowed.
struct SnapshotRequest {
  const std::shared_ptr<const FrameProviderRequest>& source;
  FrameProvider& provider;
  std::uint32_t frame = 0;  ///< that the source knows
  AlgorithmTrack* track =
      nullptr;  ///< source of the answer; null, or neither at this frame nor cached: the oracle
  AnswerCache* seen = nullptr;  ///< reads cached answers and stores this one; null: no cache
  bool check = true;
  bool structure = false;
  std::span<const std::uint32_t> trail_bodies;  ///< bodies to show over the last frames
};
/// Null when the track was lost on the way.
std::shared_ptr<const Snapshot> takeSnapshot(const SnapshotRequest& request, Oracle& oracle);

/// The answer of a track that stands at this frame, with the difference from the right one, if it
/// was compared (`judged`) and can be.
CachedAnswer answerOf(AlgorithmTrack& track, const Frame& frame, bool judged,
                      std::optional<FrameDifference> difference, const CollisionFilter& filter,
                      Oracle& oracle);

struct PairComparison {
  std::vector<Pair> first_only;   ///< ascending
  std::vector<Pair> second_only;  ///< ascending
  std::uint64_t both = 0;
};

/// Of pairs in any order; what an answer holds twice counts once. O(n log n).
PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second);

/// How many bodies are there.
std::uint32_t presentIn(std::span<const Aabb> boxes);

}  // namespace broadmark
