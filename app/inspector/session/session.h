// What the inspector is about, without any drawing. The session holds the parts (what is played,
// the algorithms, the document, the selection) and connects them; panels show and edit them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/scenes/simulation.h"
#include "inspector/authoring/document.h"
#include "inspector/jobs/background_bake.h"
#include "inspector/jobs/background_benchmark.h"
#include "inspector/jobs/background_duel.h"
#include "inspector/jobs/background_report.h"
#include "inspector/jobs/case_export.h"
#include "inspector/run/run_thread.h"
#include "inspector/session/body_filter.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/lanes.h"
#include "inspector/session/mismatches.h"
#include "inspector/session/notices.h"
#include "inspector/session/opened_results.h"
#include "inspector/session/playback.h"
#include "inspector/session/timeline.h"
#include "run/plan.h"

namespace broadmark {

struct ColourMode;

/// How the scene is shown.
struct ViewOptions {
  std::size_t colouring = 0;  ///< which of the colour modes
  bool hide_free = false;     ///< show only what overlaps
  bool pair_lines = false;    ///< a line between the centres of overlapping bodies…
  bool lines_of_all = false;  ///< …of all pairs, not only those of the selection
  BodyFilter filter;          ///< who else is not shown
  bool xray = false;          ///< the selection is seen through what stands before it
  bool world_box = true;
  bool ground = true;
  bool axes = true;
  bool structure = false;      ///< what the shown algorithm draws of itself
  bool structure_near = true;  ///< only around the selection, if there is one
  int structure_level = -1;    ///< only this depth; -1: all
  /// Colours tell how many bodies its cells hold, where it says so.
  bool structure_population = true;

  [[nodiscard]] const ColourMode& colourMode() const;
  friend bool operator==(const ViewOptions&, const ViewOptions&) = default;
};

class Session {
 public:
  /// Algorithms that can be chosen, and where they run.
  explicit Session(std::vector<Algorithm> algorithms, HostMaker make_host = makeLocalHost);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Once per picture: takes note of the progress, and moves the playback on.
  void advance(const RunProgress& progress, double seconds);
  /// Hands the wish to the run thread if it has changed, then calls what later() has been given.
  /// Not inside RunThread::look().
  void commit();
  /// Calls `act` in the next commit().
  void later(std::function<void()> act) { put_off_.push_back(std::move(act)); }
  /// Whether anything goes on by itself.
  [[nodiscard]] bool busy();

  /// Whether work goes on in the background that closing would end.
  [[nodiscard]] bool atWork() const {
    return bake.running() || benchmark.running() || duel.running() || case_export.running() ||
           report_page.running();
  }
  /// Calls `then`, which ends all; with unsaved changes or work in the background it waits until
  /// the user has decided.
  void end(std::function<void()> then);

  /// Begins a live simulation with the draft's present parameters.
  void simulate();
  /// Whether what is open is the draft's simulation, or was baked with its parameters.
  [[nodiscard]] bool draftIsOpen() const;
  /// Of what is open, "scene" among them, as far as they are known.
  [[nodiscard]] ParameterValues openParameters() const;
  /// Takes over another built-in scene as the draft, with what both have in common.
  void chooseScene(const std::string& scene, const std::string& engine = {});

  /// Opens a file of any kind that openSource() knows. A bad one becomes an error. Of a results
  /// file all cases are listed; of a file that names a case, that becomes the only lane.
  void open(const std::filesystem::path& path);
  /// Opens a case of a results file at the first frame in which it is wrong. A bad one becomes an
  /// error.
  void openCase(const std::filesystem::path& file, const std::string& id);
  /// Likewise a row of the opened results. Why it cannot be opened is kept there, and said.
  void openCase(OpenedResults::Row& row);
  /// Opens the first entry with its cases as lanes, or lists those of results; without either
  /// there are only lanes. Throws InputError.
  void open(Plan plan);

  /// Plays or pauses; a document at rest begins to move.
  void play(bool on);
  /// Writes the frames known so far as a recording.
  void saveRecording(const std::filesystem::path& path);
  /// Begins to shrink and write the case that is wrong in this snapshot; `file` gets its extension
  /// if it has none.
  void exportCase(const Case& run, std::shared_ptr<const Snapshot> snapshot,
                  std::filesystem::path file);
  /// Begins a duel of the lanes on the frames that are known, for so many seconds at most.
  void startDuel(double most_seconds);
  /// Shows a second view, of another algorithm's answer if there is one, or none.
  void showSecond(bool on);
  /// Shows this recording in the second view. A bad one becomes an error.
  void showBeside(const std::filesystem::path& recording);
  /// Opens what has been exported, at the wrong frame.
  void openExport();

  std::unique_ptr<Simulation> draft;  ///< the scene that simulate() starts
  ViewOptions view;
  std::optional<SecondWish> second;      ///< what the second view shows, if there is one
  bool linked = true;                    ///< one camera moves both views
  double budget_ms = 16.7;               ///< that a frame may take; 0: any
  std::optional<OpenedResults> results;  ///< the latest; what is played may be of others
  std::function<void()> ending;          ///< waits for what goes on in the background
  /// Called when a file has been opened or saved.
  std::function<void(const std::filesystem::path&)> on_file;

  Notices notices;
  Playback playback;
  Timeline timeline;
  BodySelection selection;
  Lanes lanes;
  Mismatches mismatches{playback, lanes, selection, notices};
  BackgroundBake bake;
  BackgroundBenchmark benchmark;
  BackgroundDuel duel;
  BackgroundReport report_page;
  Document document{playback, selection, notices, bake};
  CaseExport case_export;
  RunThread runs;

 private:
  [[nodiscard]] Wish wish() const;
  void noticeFailure(const RunProgress& progress);
  void noticeExport();
  void noticeBake();
  void noticeBenchmark();
  void noticeDuel();
  void noticeReport();
  /// How an authored scene is shown first.
  enum class Opened { at_rest, in_motion };
  void openEntry(PlanEntry entry, Opened document_is);
  void enter(PlanEntry& entry, Opened document_is);
  /// `case_id`: of results; "": it is no case of any.
  void enterSource(Source& source, Opened document_is, const std::string& case_id);
  [[nodiscard]] FootageRequest simulationFootage() const;
  /// `hash`: what it has to be; "": whatever it is. Throws InputError.
  [[nodiscard]] FootageRequest recordingFootage(const std::filesystem::path& path,
                                                const std::string& hash) const;
  /// Throws InputError.
  [[nodiscard]] FootageRequest importFootage(const RecordingReference& reference) const;
  void listCases(const std::filesystem::path& file, Results results);
  void tellOfFile(const std::filesystem::path& path) const {
    if (on_file) on_file(path);
  }

  const HostMaker make_host_;
  std::string noticed_failure_;
  bool swept_ = false;  ///< what is open is shown as swept boxes
  std::vector<std::function<void()>> put_off_;
  Wish committed_;
};

}  // namespace broadmark
