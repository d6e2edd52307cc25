// What the inspector is about, without any drawing: the parts, and what connects them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "inspector/jobs/jobs.h"
#include "inspector/run/run_thread.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/display_options.h"
#include "inspector/session/frame_provider_requests.h"
#include "inspector/session/mismatches.h"
#include "inspector/session/notices.h"
#include "inspector/session/opened_results.h"
#include "inspector/session/playback.h"
#include "inspector/session/timeline.h"
#include "inspector/session/track_list.h"
#include "run/plan.h"

namespace broadmark {

/// Owns the parts, hands their requests to the run thread, and does what takes several of them.
class Session {
 public:
  /// Algorithms that can be chosen, and where they run.
  explicit Session(std::vector<Algorithm> algorithms, ExecutorFactory make_host = makeLocalHost);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Once per picture: takes note of the progress, and moves the playback on.
  void advance(const RunProgress& progress, double seconds);
  /// Hands the request to the run thread if it has changed. Not inside RunThread::readProgress().
  void commit();
  /// Whether anything goes on by itself.
  [[nodiscard]] bool busy();

  /// Plays or pauses; a document at rest begins to move.
  void play(bool on);
  /// Writes the frames known so far as a recording.
  void saveRecording(const std::filesystem::path& path);
  /// Begins to shrink and write the case that is wrong in this snapshot; `file` gets its extension
  /// if it has none.
  void exportCase(const Case& test_case, std::shared_ptr<const Snapshot> snapshot,
                  std::filesystem::path file);
  /// Starts a duel of the tracks on the known frames, for at most this number of seconds.
  void startDuel(double max_seconds);

  // Opening: see opener.cpp.
  /// Opens a file of any kind that openSource() knows. A bad one becomes an error. Of a results
  /// file all cases are listed; of a file that names a case, that becomes the only track.
  void open(const std::filesystem::path& path);
  /// Opens the first entry with its cases as tracks, or lists those of results; without either
  /// there are only tracks. Throws InputError.
  void open(Plan plan);
  /// Opens a case of a results file at the first frame in which it is wrong. A bad one becomes an
  /// error.
  void openCase(const std::filesystem::path& file, const std::string& id);
  /// Opens a row of the listed results in the same way. Why it cannot be opened is kept there, and
  /// said.
  void openCase(OpenedResults::Row& row);
  /// Opens what has been exported, at the wrong frame.
  void openExport(const ExportReport& report);

  /// Shows another algorithm's answer in the second view if there is one, or closes that view.
  void showSecond(bool on);
  /// Shows a recording in the second view. A bad one becomes an error.
  void showBeside(const std::filesystem::path& recording);

  Notices notices;
  Playback playback;
  Timeline timeline;
  TrackList tracks;
  Jobs jobs;
  Document document{playback, notices, jobs.get<BackgroundBake>()};
  BodySelection selection{playback, document};
  Mismatches mismatches{playback, tracks, selection, notices};
  Draft draft{playback};
  DisplayOptions display;
  std::optional<SecondViewRequest> second;  ///< nothing: there is no second view
  bool cameras_linked = true;               ///< one camera moves both views
  std::optional<OpenedResults> results;     ///< the latest; what is played may be of others
  RunThread runs;

 private:
  /// How an authored scene is shown first.
  enum class Opened { at_rest, in_motion };
  void openEntry(PlanEntry entry, Opened document_is);
  void enter(PlanEntry& entry, Opened document_is);
  void enterSource(PlanEntry& entry, Opened document_is);
  void listCases(const std::filesystem::path& file, Results listed);
  [[nodiscard]] ViewRequest request() const;
  void noticeFailure(const RunProgress& progress);
  void noticeJobs();

  std::string noticed_failure_;
  std::uint32_t known_frames_ = 0;
  FrameOpener frames_;  ///< opens those of what is played; null: nothing is open
  ViewRequest committed_;
};

}  // namespace broadmark
