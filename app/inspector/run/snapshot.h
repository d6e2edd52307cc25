// Everything to be seen of one frame, and how it is taken.
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
enum class FootageSource { simulation, recording, import, authored, results };
inline constexpr NameTable kFootageSources{
    {NamedValue{FootageSource::simulation, "live simulation"},
     {FootageSource::recording, "recording"},
     {FootageSource::import, "imported files"},
     {FootageSource::authored, "authored scene"},
     {FootageSource::results, "case of results"}}};

/// What to look at. Compared by address: the same one is opened once.
struct FrameProviderRequest {
  FootageOpener open;  ///< called on the run thread
  FootageSource source = FootageSource::simulation;
  std::string title;
  /// Requests of the same number, unless 0, show the same scene, perhaps changed: the camera stays
  /// where it is.
  std::uint64_t scene = 0;
  std::filesystem::path recording = {};  ///< "": something else
  std::string scene_parameters = {};     ///< as formatSceneParameters() writes them; "": unknown
};

/// A body's boxes up to the shown frame.
struct Track {
  std::uint32_t body = 0;
  std::uint32_t first = 0;  ///< the frame of the first box
  std::vector<Aabb> boxes;
};

/// Everything to be seen of one frame. Immutable.
struct Snapshot {
  std::shared_ptr<const FrameProviderRequest> footage;
  SceneInfo scene;
  std::uint32_t frame = 0;
  std::shared_ptr<const std::vector<Aabb>> boxes;
  std::uint32_t present = 0;                              ///< bodies that are there
  std::shared_ptr<const std::vector<Aabb>> boxes_before;  ///< null for frame 0
  int lane = 0;                                           ///< whose answer this is; 0: the oracle's
  std::vector<Pair> pairs;                                ///< the answer
  std::vector<std::uint32_t> overlaps;  ///< per body, in how many pairs of the answer it is
  bool checked = false;
  std::uint64_t right_pairs = 0;              ///< that the oracle finds, if checked
  std::vector<std::uint32_t> right_overlaps;  ///< likewise: as `overlaps`, of the oracle's pairs
  FrameDifference difference;                 ///< from the right answer, if checked
  Counts counters;                            ///< of the lane's work
  std::shared_ptr<const RecordedDrawing> structure;  ///< null: not asked for
  std::vector<Track> tracks;
};

/// What a snapshot is to show; borrowed.
struct SnapshotWish {
  const std::shared_ptr<const FrameProviderRequest>& request;
  FrameProvider& footage;
  std::uint32_t frame = 0;  ///< that the footage knows
  AlgorithmTrack* lane =
      nullptr;  ///< whose answer; null, or neither at this frame nor kept: the oracle's
  AnswerCache* seen = nullptr;  ///< answers that are kept, and where this one is kept; null: none
  bool check = true;
  bool structure = false;
  std::span<const std::uint32_t> tracked;  ///< bodies whose last frames are wanted
};
/// Null when the lane was lost on the way.
std::shared_ptr<const Snapshot> takeSnapshot(const SnapshotWish& wish, Oracle& oracle);

/// The answer of a lane that stands at this frame, with the difference from the right one, if it
/// was compared (`judged`) and can be.
SeenAnswer answerOf(AlgorithmTrack& lane, const Frame& frame, bool judged,
                    std::optional<FrameDifference> difference, const CollisionFilter& filter,
                    Oracle& oracle);

struct PairComparison {
  std::vector<Pair> first_only;   ///< ascending
  std::vector<Pair> second_only;  ///< likewise
  std::uint64_t both = 0;
};

/// Of pairs in any order; what an answer holds twice counts once. O(n log n).
PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second);

/// How many bodies are there.
std::uint32_t presentIn(std::span<const Aabb> boxes);

}  // namespace broadmark
