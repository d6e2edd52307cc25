// The inspector's model, without any drawing: its parts, and the operations that combine them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/render/orbit_camera.h"
#include "inspector/jobs/jobs.h"
#include "inspector/run/run_thread.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/display_options.h"
#include "inspector/session/frame_provider_requests.h"
#include "inspector/session/mismatches.h"
#include "inspector/session/notices.h"
#include "inspector/session/opened_results.h"
#include "inspector/session/playback.h"
#include "inspector/session/plugin_list.h"
#include "inspector/session/timeline.h"
#include "inspector/session/track_list.h"
#include "run/plan.h"

namespace broadmark {

/// Owns the parts, posts their combined request to the run thread, and implements operations that
/// involve several of them.
class Session {
 public:
  /// The available algorithms, the factory of the executors that run them, and where simulations
  /// run.
  explicit Session(std::vector<Algorithm> algorithms,
                   ExecutorFactory make_executor = makeInProcessExecutor,
                   SimulationHost host = simulateInProcess);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Call once per picture: processes the progress, and advances the playback.
  void advance(const RunProgress& progress, double seconds);
  /// Posts the request to the run thread if it has changed. Not inside RunThread::readProgress().
  void postRequest();
  /// Whether playback, algorithms or jobs are running.
  [[nodiscard]] bool busy();
  /// Whether a file is being read, to be shown.
  [[nodiscard]] bool isReading() const { return replaced_by_reading_.has_value(); }
  /// What the requested frame has been waiting for; "" if it has not for long.
  [[nodiscard]] std::string waitsFor(const RunProgress& progress) const;

  /// Plays or pauses; playing a document at rest simulates it.
  void play(bool on);
  /// Starts to save the available frames as a recording.
  void saveRecording(const std::filesystem::path& path);
  /// Where a case fails.
  struct FailingFrame {
    std::shared_ptr<const FrameProviderRequest> source;
    std::uint32_t frame = 0;
    std::optional<FrameDifference> difference = {};  ///< nullopt: it ends with an error
  };
  /// Starts to export a failing case; adds a missing extension to `file`.
  void exportCase(const Case& test_case, const FailingFrame& failing, std::filesystem::path file);
  /// Starts a duel of the tracks on the available frames, with this time limit.
  void startDuel(double max_seconds);

  // Opening: see opener.cpp.
  /// Opens a file of any kind that openSource() supports; reports errors. Lists the cases of a
  /// results file; makes the case named by a file the only track.
  void open(const std::filesystem::path& path);
  /// Opens the plan's first entry with its cases as tracks, or lists the cases of its results, or
  /// only adds tracks. Throws InputError.
  void open(Plan plan);
  /// Opens a case of a results file at its first frame with a wrong answer. Reports errors.
  void openCase(const std::filesystem::path& file, const std::string& id);
  /// Opens a row of the results in the same way. Stores an error in the row, and reports it.
  void openCase(OpenedResults::Row& row);
  /// Opens an exported case at the wrong frame.
  void openExport(const ExportReport& report);

  /// Opens the second view, with another algorithm's answer if there is one, or closes it.
  void showSecond(bool on);
  /// Shows a recording in the second view. Reports errors.
  void openInSecondView(const std::filesystem::path& recording);

  Notices notices;
  Playback playback;
  Timeline timeline;
  TrackList tracks;
  Jobs jobs;
  Document document{playback, notices, jobs};
  BodySelection selection{playback, document};
  DisplayOptions display;
  Mismatches mismatches{playback, tracks, selection, display, notices};
  PluginList plugins{tracks, playback, notices};
  Draft draft{playback};
  std::optional<SecondViewRequest> second;  ///< nothing: no second view
  // For the source that is being opened, reset once it is shown.
  std::optional<OrbitCamera> first_camera;
  BodySelection::Bodies first_selection;
  bool cameras_linked = true;            ///< one camera moves both views
  std::optional<OpenedResults> results;  ///< latest opened results
  RunThread runs;

 private:
  /// Initial state of an opened document.
  enum class DocumentStart { at_rest, in_motion };
  void openEntry(PlanEntry entry, DocumentStart start);
  void loadEntry(PlanEntry& entry, DocumentStart start);
  void loadSource(PlanEntry& entry, DocumentStart start);
  /// Shows the file that has been read, unless another source has been opened meanwhile.
  void showRead();
  void showResults(const std::filesystem::path& file, Results listed);
  [[nodiscard]] ViewRequest request() const;
  void reportFailure(const RunProgress& progress);
  void reportFinishedJobs();

  /// The source that the file being read will replace; nothing: no file is being read.
  std::optional<std::shared_ptr<const FrameProviderRequest>> replaced_by_reading_;
  std::string reported_failure_;
  std::uint32_t available_frames_ = 0;
  FrameOpener open_frames_;  ///< opens the playback's frames; null: nothing is open
  ViewRequest posted_request_;
  double waited_seconds_ = 0;  ///< for the requested frame
};

}  // namespace broadmark
