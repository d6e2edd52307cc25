// The thread that runs algorithms, so that the user interface does not block.
//
// The interface posts a request: a source, algorithms, a frame. The thread executes it in steps of
// one frame of one algorithm, and checks for a new request after each step. Algorithms are
// stateful, so each runs all frames from the first: for an earlier frame a new instance starts
// over. Answers of shown frames are cached: such a frame is shown at once, and algorithms run again
// only for answers that the cache does not hold.
//
// Where the system grants no thread, the interface calls proceed(), which executes some steps.
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

/// Content of the second view. For the source and frame of the first view, the answer comes from
/// that view's tracks. For others the algorithm has a separate instance, which is not timed.
struct SecondViewRequest {
  std::shared_ptr<const FrameProviderRequest> source;  ///< null: the first view's
  std::optional<std::uint32_t> frame;                  ///< nothing: the first view's
  int track = 0;  ///< number of the answer's track; 0: the oracle's

  friend bool operator==(const SecondViewRequest&, const SecondViewRequest&) = default;
};

/// The work that the interface requests.
struct ViewRequest {
  std::shared_ptr<const FrameProviderRequest> source;
  std::vector<TrackSpec> tracks;
  std::uint32_t frame = 0;
  bool playing = false;  ///< the playback continues from `frame`, so cached answers do not suffice
  bool check = true;     ///< compare every answer with the oracle's
  /// Stop at the first frame with a wrong answer…
  bool stop_at_mismatch = true;
  /// …after this frame, up to which the user has acknowledged mismatches.
  std::optional<std::uint32_t> acknowledged;
  int shown_track = 0;     ///< number of the track with the shown answer; 0: the oracle's
  bool structure = false;  ///< also capture the structure of this track
  std::vector<std::uint32_t> trail_bodies;       ///< bodies to show over the last frames
  std::optional<SecondViewRequest> second = {};  ///< nothing: no second view

  friend bool operator==(const ViewRequest&, const ViewRequest&) = default;
};

/// The state of the work.
struct RunProgress {
  std::shared_ptr<const FrameProviderRequest> source;  ///< the open source
  std::string failure;  ///< why the source could not be opened or read
  SceneInfo scene;
  std::uint32_t available_frames = 0;  ///< the last frame that is already available
  FrameOpener frames;                  ///< opens the available frames
  bool live = false;                   ///< further frames have to be simulated first
  /// Number of present bodies in each frame read. Empty if all bodies are always present.
  FrameValues population;
  /// Number of overlapping pairs per frame: the oracle's, else computed from an algorithm's.
  FrameValues pairs;
  std::vector<TrackReport> tracks;
  std::shared_ptr<const Snapshot> snapshot;  ///< null: none yet
  std::shared_ptr<const Snapshot> second;    ///< of the second view; null: none
  std::string second_failure;                ///< why `second` is null
  /// Compares the answers of both views; null without a second answer.
  std::shared_ptr<const PairComparison> comparison;
  /// The frame at which all tracks stop, and the track with the wrong answer.
  struct Stop {
    std::uint32_t frame = 0;
    int track = 0;
  };
  std::optional<Stop> stop;
  std::string activity;  ///< "" when idle
  float fraction = 0;    ///< completed fraction of the activity
};

class RunThread {
 public:
  /// Memory budget of the cached answers.
  static constexpr std::size_t kCacheBytes = std::size_t{512} << 20;

  /// Where algorithms and simulations run.
  RunThread(ExecutorFactory make_executor, SimulationHost host);
  /// Cancels the work; waits for the current frame only if it cannot be cancelled where it runs.
  ~RunThread();
  RunThread(const RunThread&) = delete;
  RunThread& operator=(const RunThread&) = delete;

  void request(ViewRequest request);
  /// Calls `visitor` with the progress, under its lock. While another source than the requested one
  /// is open, there is only an activity: what it waits for.
  void readProgress(const std::function<void(const RunProgress&)>& visitor);
  /// Whether the latest request has been completed or has failed.
  [[nodiscard]] bool isIdle();
  /// Waits until isIdle(); returns false after `timeout`.
  bool waitUntilIdle(std::chrono::milliseconds timeout);
  /// Without a thread: works until isIdle() or for `budget`, at least a step. Call once per
  /// picture.
  void proceed(std::chrono::milliseconds budget);

  DrawGate& drawGate() { return draw_gate_; }

 private:
  void loop();
  void work(std::unique_lock<std::mutex>& lock);
  void applyRequest();
  bool step();
  Oracle makeOracle();
  void openSource();
  void openSecondSource();
  /// Simulates the next frame of the open source or of the second view's.
  void simulateNext(FrameProvider& provider);
  bool updateTracks();
  bool advance();
  bool advanceTrack(AlgorithmTrack& track, const Frame& frame);
  bool advanceSecond();
  Frame frameAt(std::uint32_t index);
  void recordPopulation(std::uint32_t index, std::span<const Aabb> boxes);
  void publishSnapshots();
  void publishActivity(std::string activity, float fraction);
  void publishTrack(const AlgorithmTrack& track);
  void publishFailure(std::string reason);
  /// Whether the latest request has another source.
  [[nodiscard]] bool isSourceCancelled();
  /// Whether the latest request has another source in the second view.
  [[nodiscard]] bool isSecondSourceCancelled();
  /// Whether the latest request no longer includes a track with this spec.
  [[nodiscard]] bool isTrackCancelled(const TrackSpec& spec);
  /// Whether the latest request no longer needs the second view's instance.
  [[nodiscard]] bool isSecondTrackCancelled(const TrackSpec& spec);
  /// Whether the latest request has been completed. Requires mutex_.
  [[nodiscard]] bool isDone() const { return idle_ && applied_ == posted_; }
  [[nodiscard]] std::uint32_t target() const;
  /// Returns the track with this number, or null.
  [[nodiscard]] AlgorithmTrack* findTrack(int number) const;
  [[nodiscard]] AlgorithmTrack* shownTrack() const;
  /// The frames of the second view; null: they could not be opened.
  [[nodiscard]] FrameProvider* secondProvider() const;
  [[nodiscard]] std::uint32_t secondTarget() const;
  /// The track that provides the second view's answer; null: the oracle.
  AlgorithmTrack* secondTrack();
  /// Returns null if the track fails meanwhile.
  std::shared_ptr<const Snapshot> captureSecondSnapshot();
  /// Whether the cache holds the answer of the shown track, or the oracle's, for a frame.
  [[nodiscard]] bool isAnswerCached(std::uint32_t frame) const;
  /// Whether the cache satisfies the request for a track at the target, so that it need not run.
  [[nodiscard]] bool isServedFromCache(const AlgorithmTrack& track) const;
  bool publishCachedSnapshot();

  const ExecutorFactory make_executor_;
  const SimulationHost host_;
  DrawGate draw_gate_;

  // Accessed only by the thread.
  ViewRequest current_;
  std::shared_ptr<const FrameProviderRequest> open_source_;
  std::unique_ptr<FrameProvider> provider_;
  std::vector<std::unique_ptr<AlgorithmTrack>> tracks_;
  Oracle oracle_;
  AnswerCache cache_{kCacheBytes};
  std::optional<RunProgress::Stop> stop_;
  struct {
    std::shared_ptr<const FrameProviderRequest> opened = {};  ///< null: the first view's
    std::unique_ptr<FrameProvider> provider = {};             ///< of `opened`
    std::string failure = {};                                 ///< why `provider` is null
    std::unique_ptr<AlgorithmTrack> track = {};  ///< a separate instance, if one is needed
  } second_;                                     ///< state of the second view
  Oracle second_oracle_;
  bool snapshots_valid_ = false;  ///< the published snapshots match current_
  bool cache_tried_ = false;      ///< publishCachedSnapshot() was called for current_

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  ViewRequest requested_;
  std::uint64_t posted_ = 0;   ///< number of requests posted
  std::uint64_t applied_ = 0;  ///< number of them applied, or superseded
  bool idle_ = false;
  bool stopping_ = false;
  RunProgress progress_;

  std::thread thread_;
};

}  // namespace broadmark
