// The thread that runs algorithms while the user interface stays free.
//
// The interface states a wish: what to look at, which algorithms, up to which frame. The thread
// works towards it, one frame of one algorithm at a time, and takes up a changed wish in between.
// Algorithms keep state from frame to frame, so each goes through all frames from the first: for an
// earlier frame a fresh instance starts over. The answers of frames that have been seen are kept:
// such a frame is shown at once, and algorithms are run again only where something else of them is
// wanted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "broadmark/harness/oracle.h"
#include "inspector/run/algorithm_track.h"
#include "inspector/run/answer_cache.h"
#include "inspector/run/draw_gate.h"
#include "inspector/run/frame_provider.h"
#include "inspector/run/snapshot.h"

namespace broadmark {

/// What the second view shows. Of the open footage in the same frame the lanes have the answer
/// already. For another frame, or other footage, the algorithm has an instance of its own, whose
/// times count for nothing.
struct SecondViewRequest {
  std::shared_ptr<const FrameProviderRequest> footage;  ///< null: that of the first view
  std::optional<std::uint32_t> frame;                   ///< nothing: that of the first view
  int lane = 0;  ///< the number of the answer's track; 0: the oracle's

  friend bool operator==(const SecondViewRequest&, const SecondViewRequest&) = default;
};

/// What the interface wants.
struct ViewRequest {
  std::shared_ptr<const FrameProviderRequest> footage;
  std::vector<LaneSpec> lanes;
  std::uint32_t frame = 0;
  bool playing = false;  ///< it goes on from there: what has been seen does not do
  bool check = true;     ///< compare every answer with the oracle's
  /// Stop at the first frame in which an algorithm is wrong…
  bool stop_at_mismatch = true;
  /// …after this one, up to which mismatches are known.
  std::optional<std::uint32_t> known_mismatch;
  int shown_lane = 0;                  ///< whose answer is looked at, by number; none: the oracle's
  bool structure = false;              ///< whether its structure is looked at, too
  std::vector<std::uint32_t> tracked;  ///< bodies whose last frames are wanted
  std::optional<SecondViewRequest> second = {};  ///< what the second view shows, if there is one

  friend bool operator==(const ViewRequest&, const ViewRequest&) = default;
};

/// How far the thread has got.
struct RunProgress {
  std::shared_ptr<const FrameProviderRequest> footage;  ///< what is open
  std::string failure;  ///< why it could not be opened, or not be read on
  SceneInfo scene;
  std::uint32_t known_frames = 0;  ///< that exist already
  FrameOpener frames;              ///< opens them
  bool live = false;               ///< more can be simulated
  /// How many bodies are present in each frame that has been looked at. Empty where nobody is ever
  /// absent.
  FrameValues population;
  /// Likewise how many pairs overlap, as far as the oracle was asked; else how many an algorithm
  /// reported.
  FrameValues pairs;
  std::vector<LaneReport> lanes;
  std::shared_ptr<const Snapshot> snapshot;  ///< null: nothing has been shown yet
  std::shared_ptr<const Snapshot> second;    ///< of the second view; null: there is none
  std::string second_failure;                ///< why there is none
  /// Of the answers in both views; null: there are not two.
  std::shared_ptr<const PairComparison> comparison;
  /// The frame at which all stay, as the lane of this number is wrong there.
  struct Stop {
    std::uint32_t frame = 0;
    int lane = 0;
  };
  std::optional<Stop> stop;
  std::string doing;   ///< "" when all is done
  float fraction = 0;  ///< of what is being done
};

class RunThread {
 public:
  /// What the answers of seen frames may take.
  static constexpr std::size_t kSeenBytes = std::size_t{512} << 20;

  /// `make_host`: where algorithms run.
  explicit RunThread(ExecutorFactory make_host);
  /// Ends soon: waits for the frame that is being run only where its host cannot be cancelled.
  ~RunThread();
  RunThread(const RunThread&) = delete;
  RunThread& operator=(const RunThread&) = delete;

  void wish(ViewRequest wish);
  /// Calls `at` with the progress, which does not change meanwhile.
  void look(const std::function<void(const RunProgress&)>& at);
  /// Whether everything requested has been done (or has failed).
  [[nodiscard]] bool isIdle();
  /// Waits until isIdle(); returns false after `patience`.
  bool waitUntilIdle(std::chrono::milliseconds patience);

  DrawGate& gate() { return gate_; }

 private:
  void loop();
  void takeRequest();
  bool step();
  void openFootage();
  bool reconcileLanes();
  bool advance();
  bool advanceLane(AlgorithmTrack& lane, const Frame& frame);
  bool advanceSecond();
  Frame frameAt(std::uint32_t index);
  void notePopulation(std::uint32_t index, std::span<const Aabb> boxes);
  void show();
  void tell(std::string doing, float fraction);
  void report(const AlgorithmTrack& lane);
  void fail(std::string reason);
  /// Whether to give up what a lane of this spec is at.
  [[nodiscard]] bool isUnwanted(const LaneSpec& spec);
  /// Likewise what the second view's instance of it is at.
  [[nodiscard]] bool isUnwantedBeside(const LaneSpec& spec);
  [[nodiscard]] std::uint32_t target() const;
  /// The lane of this number, or null.
  [[nodiscard]] AlgorithmTrack* laneOf(int number) const;
  [[nodiscard]] AlgorithmTrack* shownLane() const;
  /// Of the second view; null: it could not be opened.
  [[nodiscard]] FrameProvider* footageBeside() const;
  [[nodiscard]] std::uint32_t targetBeside() const;
  /// The lane that has the second view's answer, or is to have it; null: the oracle.
  AlgorithmTrack* laneBeside();
  /// Null when the lane was lost on the way.
  std::shared_ptr<const Snapshot> takeBeside();
  /// Whether the answer of the shown lane, or the oracle's, is kept for a frame.
  [[nodiscard]] bool hasSeen(std::uint32_t frame) const;
  /// Whether nothing is wanted of a lane at the target but what is kept.
  [[nodiscard]] bool isCached(const AlgorithmTrack& lane) const;
  bool showCached();

  const ExecutorFactory make_host_;
  DrawGate gate_;

  // Used by the thread alone.
  ViewRequest current_;
  std::shared_ptr<const FrameProviderRequest> opened_;
  std::unique_ptr<FrameProvider> footage_;
  std::vector<std::unique_ptr<AlgorithmTrack>> lanes_;
  Oracle oracle_{std::size_t{256} << 20};
  AnswerCache seen_{kSeenBytes};
  std::optional<RunProgress::Stop> stop_;
  struct {
    std::shared_ptr<const FrameProviderRequest> opened = {};  ///< null: that of the first view
    std::unique_ptr<FrameProvider> footage = {};              ///< of `opened`
    std::string failure = {};                                 ///< why there is none
    std::unique_ptr<AlgorithmTrack> lane = {};  ///< the instance of its own, if one is needed
  } beside_;                                    ///< what the second view has of its own
  Oracle oracle_beside_{std::size_t{256} << 20};
  bool shown_ = false;        ///< whether the snapshots are what current_ wants
  bool looked_back_ = false;  ///< since that wish came: see showCached()

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  ViewRequest wished_;
  std::uint64_t wishes_ = 0;
  std::uint64_t taken_ = 0;  ///< of the wishes
  bool idle_ = false;
  bool stopping_ = false;
  RunProgress progress_;

  std::thread thread_;
};

}  // namespace broadmark
