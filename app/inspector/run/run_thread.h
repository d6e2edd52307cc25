// The thread that runs algorithms while the user interface stays free.
//
// The interface posts a request: a source, algorithms, a frame. The thread works towards it, one
// frame of one algorithm at a time, and switches to a changed request in between. Algorithms have
// state from frame to frame, so each runs all frames from the first: for an earlier frame a new
// instance starts over. Answers of shown frames are cached: such a frame is shown at once, and
// algorithms run again only for what the cache does not hold.
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

/// Content of the second view. For the same source and frame the answer comes from the first view's
/// tracks. For another frame or source the algorithm has a separate instance, which is not timed.
struct SecondViewRequest {
  std::shared_ptr<const FrameProviderRequest> source;  ///< null: that of the first view
  std::optional<std::uint32_t> frame;                  ///< nothing: that of the first view
  int track = 0;  ///< the number of the answer's trail; 0: the oracle's

  friend bool operator==(const SecondViewRequest&, const SecondViewRequest&) = default;
};

/// What the interface requests.
struct ViewRequest {
  std::shared_ptr<const FrameProviderRequest> source;
  std::vector<TrackSpec> tracks;
  std::uint32_t frame = 0;
  bool playing = false;  ///< continues from there, so cached answers are not enough
  bool check = true;     ///< compare every answer with the oracle's
  /// Stop at the first frame in which an algorithm is wrong…
  bool stop_at_mismatch = true;
  /// …after this one, up to which mismatches are known.
  std::optional<std::uint32_t> known_mismatch;
  int shown_track = 0;     ///< number of the track with the shown answer; 0: the oracle's
  bool structure = false;  ///< also show its structure
  std::vector<std::uint32_t> trail_bodies;       ///< bodies to show over the last frames
  std::optional<SecondViewRequest> second = {};  ///< nothing: no second view

  friend bool operator==(const ViewRequest&, const ViewRequest&) = default;
};

/// How far the thread has got.
struct RunProgress {
  std::shared_ptr<const FrameProviderRequest> source;  ///< what is open
  std::string failure;  ///< why it could not be opened, or not be read on
  SceneInfo scene;
  std::uint32_t known_frames = 0;  ///< that exist already
  FrameOpener frames;              ///< opens them
  bool live = false;               ///< more can be simulated
  /// Bodies present, by frame that has been read. Empty if all bodies are always present.
  FrameValues population;
  /// Overlapping pairs, by frame: the oracle's count where it was computed, else an algorithm's.
  FrameValues pairs;
  std::vector<TrackReport> tracks;
  std::shared_ptr<const Snapshot> snapshot;  ///< null: nothing has been shown yet
  std::shared_ptr<const Snapshot> second;    ///< of the second view; null: there is none
  std::string second_failure;                ///< why there is none
  /// Of the answers in both views; null: there are not two.
  std::shared_ptr<const PairComparison> comparison;
  /// The frame at which all stay, as the track of this number is wrong there.
  struct Stop {
    std::uint32_t frame = 0;
    int track = 0;
  };
  std::optional<Stop> stop;
  std::string doing;   ///< "" when all is done
  float fraction = 0;  ///< of what is being done
};

class RunThread {
 public:
  /// What the answers of seen frames may take.
  static constexpr std::size_t kCacheBytes = std::size_t{512} << 20;

  /// `make_host`: where algorithms run.
  explicit RunThread(ExecutorFactory make_host);
  /// Ends soon: waits for the frame that is being run only where its host cannot be cancelled.
  ~RunThread();
  RunThread(const RunThread&) = delete;
  RunThread& operator=(const RunThread&) = delete;

  void request(ViewRequest request);
  /// Calls `at` with the progress, which does not change meanwhile.
  void readProgress(const std::function<void(const RunProgress&)>& at);
  /// Whether everything requested has been done (or has failed).
  [[nodiscard]] bool isIdle();
  /// Waits until isIdle(); returns false after `patience`.
  bool waitUntilIdle(std::chrono::milliseconds patience);

  DrawGate& gate() { return gate_; }

 private:
  void loop();
  void takeRequest();
  bool step();
  void openSource();
  bool updateTracks();
  bool advance();
  bool advanceTrack(AlgorithmTrack& track, const Frame& frame);
  bool advanceSecond();
  Frame frameAt(std::uint32_t index);
  void notePopulation(std::uint32_t index, std::span<const Aabb> boxes);
  void show();
  void setActivity(std::string doing, float fraction);
  void report(const AlgorithmTrack& track);
  void fail(std::string reason);
  /// Whether the work of a track with this spec is to be cancelled.
  [[nodiscard]] bool isUnwanted(const TrackSpec& spec);
  /// Whether the work of the second view's instance is to be cancelled.
  [[nodiscard]] bool isUnwantedInSecond(const TrackSpec& spec);
  [[nodiscard]] std::uint32_t target() const;
  /// The track of this number, or null.
  [[nodiscard]] AlgorithmTrack* trackOf(int number) const;
  [[nodiscard]] AlgorithmTrack* shownTrack() const;
  /// Of the second view; null: it could not be opened.
  [[nodiscard]] FrameProvider* secondProvider() const;
  [[nodiscard]] std::uint32_t secondTarget() const;
  /// The track that has the second view's answer, or is to have it; null: the oracle.
  AlgorithmTrack* secondTrack();
  /// Null when the track was lost on the way.
  std::shared_ptr<const Snapshot> takeSecondSnapshot();
  /// Whether the answer of the shown track, or the oracle's, is kept for a frame.
  [[nodiscard]] bool isAnswerCached(std::uint32_t frame) const;
  /// Whether nothing is wanted of a track at the target but what is kept.
  [[nodiscard]] bool isCached(const AlgorithmTrack& track) const;
  bool showCached();

  const ExecutorFactory make_host_;
  DrawGate gate_;

  // Used by the thread alone.
  ViewRequest current_;
  std::shared_ptr<const FrameProviderRequest> opened_;
  std::unique_ptr<FrameProvider> provider_;
  std::vector<std::unique_ptr<AlgorithmTrack>> tracks_;
  Oracle oracle_{std::size_t{256} << 20};
  AnswerCache cache_{kCacheBytes};
  std::optional<RunProgress::Stop> stop_;
  struct {
    std::shared_ptr<const FrameProviderRequest> opened = {};  ///< null: that of the first view
    std::unique_ptr<FrameProvider> provider = {};             ///< of `opened`
    std::string failure = {};                                 ///< why there is none
    std::unique_ptr<AlgorithmTrack> track = {};  ///< the instance of its own, if one is needed
  } second_;                                     ///< what the second view has of its own
  Oracle second_oracle_{std::size_t{256} << 20};
  bool shown_ = false;        ///< whether the snapshots are what current_ wants
  bool looked_back_ = false;  ///< since that request came: see showCached()

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  ViewRequest requested_;
  std::uint64_t requests_ = 0;
  std::uint64_t taken_ = 0;  ///< of the requests
  bool idle_ = false;
  bool stopping_ = false;
  RunProgress progress_;

  std::thread thread_;
};

}  // namespace broadmark
