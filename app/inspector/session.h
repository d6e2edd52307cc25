// What the inspector is about, without any drawing: the scene that is looked at, the algorithms,
// the playback, the selection. Panels show and edit it; advance() moves it on.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inspector/author_desk.h"
#include "inspector/background_bake.h"
#include "inspector/case_export.h"
#include "inspector/run_thread.h"
#include "broadmark/algorithm.h"
#include "broadmark/pair.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {

struct Playback {
  bool playing = false;
  bool loop = false;
  double frames_per_second = 30;  ///< no more; an algorithm may need longer
  double due = 0;                 ///< of the next frame, as a share of its time
};

/// An algorithm in the list, as it is edited. What runs is the case made from it.
struct LaneEdit {
  int number = 0;
  Algorithm algorithm;
  std::unique_ptr<BroadPhase> parameters;  ///< holds their values; never run
  Isa isa = bestIsa();
  int threads = 1;
  std::string device;

  [[nodiscard]] LaneSpec spec() const;
};

/// How the scene is shown.
struct ViewOptions {
  std::size_t colouring = 0;  ///< which of the colour modes
  bool hide_free = false;     ///< show only what overlaps
  bool pair_lines = false;    ///< a line between the centres of overlapping bodies…
  bool lines_of_all = false;  ///< …of all pairs, not only those of the selection
  bool world_box = true;
  bool ground = true;
  bool axes = true;
  bool structure = false;      ///< what the shown algorithm draws of itself
  bool structure_near = true;  ///< only around the selection, if there is one
  int structure_level = -1;    ///< only this depth; -1: all

  friend bool operator==(const ViewOptions&, const ViewOptions&) = default;
};

/// A line for the status bar.
struct Message {
  enum class Kind { note, warning, error };
  Kind kind = Kind::note;
  std::string text;
};

struct CaseReference;
struct Source;

/// A results file that has been opened, one of whose cases is to be chosen.
struct CaseChoice {
  struct Item {
    std::string id;
    Status status = Status::ok;
    std::string reason;
    bool wrong = false;  ///< gave a wrong answer
  };
  std::filesystem::path file;
  std::vector<Item> cases;  ///< as in the file
  bool all = false;         ///< show also those that were right
};

class Session {
 public:
  /// Algorithms that can be chosen.
  explicit Session(std::vector<Algorithm> algorithms);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Once per picture: takes note of what has been achieved, and moves the playback on.
  void advance(const RunProgress& progress, double seconds);
  /// Hands the wish to the run thread if it has changed, and does what was put off. Not while the
  /// progress is looked at.
  void commit();

  // Source.
  /// Begins a live simulation with the draft's present parameters.
  void simulate();
  /// Takes over another built-in scene as the draft.
  void chooseScene(const std::string& scene, const std::string& engine = {});
  /// Opens a file of any kind that can be looked at. A bad one becomes an error message. Of a
  /// results file one case is to be chosen.
  void open(const std::filesystem::path& path);
  /// Opens the source of a run. Throws InputError.
  void open(Source source);
  /// Opens a case of a results file at the first frame in which it is wrong, instead of all present
  /// algorithms. A bad one becomes an error message.
  void openCase(const std::filesystem::path& results, const std::string& id);
  /// Likewise. Throws InputError.
  void open(CaseReference reference);
  /// Shows what `open` gives, from frame 0 on; `scene`: see FootageRequest.
  void show(std::string title, std::function<std::unique_ptr<Footage>()> open,
            std::uint64_t scene = 0);
  /// Writes the frames known so far as a recording.
  void saveRecording(const std::filesystem::path& path);

  // Authoring: what is looked at is the document on the desk, at rest or in motion.
  [[nodiscard]] bool authoring() const {
    return author_footage_ && author_footage_ == wish.footage;
  }
  /// At rest: as it starts.
  [[nodiscard]] bool authoringAtRest() const { return authoring() && !author_moves_; }
  /// Takes another document and shows it. Does not ask.
  void author(scenes::AuthoredScene scene, std::filesystem::path path = {}, bool unsaved = false);
  /// Makes a document of the frame that is looked at, once its bodies are known.
  void authorFrame();
  /// Changes the document and shows it at rest. What goes wrong becomes an error message.
  void edit(const std::function<void(scenes::SceneEditor&)>& change);
  /// Shows the document at rest, or moves it on from its first frame.
  void showAuthored();
  void simulateAuthored();
  /// Returns whether it could be written.
  bool saveAuthored(const std::filesystem::path& path);
  /// Bakes the document's simulation in the background.
  void bakeAuthored(std::filesystem::path path);
  /// Does what ends the document, once nothing is lost by that: with unsaved changes it becomes
  /// `leaving`, for the user to decide.
  void leaveDocument(std::function<void()> then);
  /// Whether anything goes on by itself.
  [[nodiscard]] bool busy() {
    return playback.playing || !runs.settled() || bake.running() || case_export.running();
  }

  // Playback. Frames out of range are brought into it.
  void play(bool on);
  void seek(std::int64_t frame);
  void step(int frames);

  // Algorithms.
  LaneEdit& addLane(const std::string& algorithm_id);
  LaneEdit& addLane(const Case& run);
  void removeLane(int number);
  void showLane(int number);
  /// To be called after a lane was edited.
  void lanesChanged();
  [[nodiscard]] LaneEdit* lane(int number);

  // Mismatches.
  /// Goes on to the next frame in which an algorithm is wrong, running what has not been run yet.
  void nextMismatch(const RunProgress& progress);
  /// Whether it is on the way to one.
  [[nodiscard]] bool searching() const { return searching_; }
  /// Stays where the algorithms have got to.
  void endSearch(const RunProgress& progress);
  /// Begins to shrink and write the case that is wrong in this snapshot; `file` gets its extension
  /// if it has none.
  void exportCase(const Case& run, std::shared_ptr<const Snapshot> snapshot,
                  std::filesystem::path file);
  /// Opens what has been exported, at the wrong frame.
  void openExport();

  // Selection: bodies, ascending.
  void select(std::vector<std::uint32_t> bodies);
  void toggleSelected(std::uint32_t body);
  [[nodiscard]] bool isSelected(std::uint32_t body) const;
  /// Selects the bodies of a pair and looks at them.
  void visit(Pair pair);

  // Messages.
  void say(std::string text, Message::Kind kind = Message::Kind::note);
  /// An error that the user has to acknowledge.
  void complain(std::string text);
  /// Does something, turning what it throws into an error message. Returns whether all went well.
  bool attempt(const std::function<void()>& act);
  /// Does something once nobody looks at the progress.
  void later(std::function<void()> act) { put_off_.push_back(std::move(act)); }

  /// The frame that is wished for.
  [[nodiscard]] std::uint32_t frame() const { return wish.frame; }
  [[nodiscard]] std::uint32_t lastFrame() const { return scene_.frames; }
  [[nodiscard]] const SceneInfo& scene() const { return scene_; }

  std::vector<Algorithm> algorithms;
  std::unique_ptr<Simulation> draft;  ///< the scene that Simulate starts
  std::vector<LaneEdit> lanes;
  Playback playback;
  ViewOptions view;
  std::vector<std::uint32_t> selection;
  /// What the view has been asked to fly to; taken by whoever draws it.
  std::optional<std::vector<std::uint32_t>> fly_to;
  /// Panels that shall come to the front in the next picture, by name.
  std::vector<std::string> wanted_panels;
  Message status;
  std::deque<std::string> errors;     ///< not yet acknowledged
  std::filesystem::path source_path;  ///< of the recording that is looked at; "": none
  /// Called when a file has been opened or saved.
  std::function<void(const std::filesystem::path&)> on_file;

  AuthorDesk desk;                ///< its selection is that of the session, while authoring()
  std::function<void()> leaving;  ///< waits for unsaved changes to be saved or given up
  std::optional<CaseChoice> case_choice;  ///< to be made by the user

  Wish wish;  ///< edit it and it is committed
  RunThread runs;
  BackgroundBake bake;
  CaseExport case_export;

 private:
  void noticeStop(const RunProgress& progress);
  void noticeExport();
  /// Once the frame that was stopped at is seen: visits its first wrong pair.
  void visitStop(const RunProgress& progress);
  /// Who goes on knows of the mismatch at which it stopped.
  void acknowledgeStop();
  void openJson(const std::filesystem::path& path);
  void noticeAuthored(const RunProgress& progress);
  void noticeBake();
  void showDocument(std::function<std::unique_ptr<Footage>()> open, bool moves);
  [[nodiscard]] std::size_t bodyCount() const;
  /// `hash`: what it has to be; "": whatever it is. Throws InputError.
  void openRecording(const std::filesystem::path& path, const std::string& hash);

  SceneInfo scene_;
  bool scene_known_ = false;                              ///< what is wished for has been opened
  std::shared_ptr<const FootageRequest> author_footage_;  ///< that shows the document last
  bool author_moves_ = false;
  std::uint64_t author_scene_ = 0;  ///< see FootageRequest
  std::uint64_t last_author_scene_ = 0;
  Aabb author_world_{};
  /// A frame that becomes a document when `shown` is open.
  struct FrameToAuthor {
    std::shared_ptr<const FootageRequest> former;  ///< to return to when that fails
    std::uint32_t frame = 0;
    std::shared_ptr<const FootageRequest> shown;
    std::shared_ptr<scenes::AuthoredScene> scene;
  };
  std::optional<FrameToAuthor> frame_to_author_;
  std::optional<RunProgress::Stop> noticed_stop_;
  std::optional<RunProgress::Stop> to_visit_;  ///< stopped at, not seen yet
  bool searching_ = false;
  std::string noticed_failure_;
  std::vector<std::function<void()>> put_off_;
  Wish committed_;
  int last_lane_number_ = 0;
};

/// Of each lane every frame that has been run, as CSV: one line per lane and frame, times in
/// nanoseconds.
std::string formatFrameTable(const RunProgress& progress);

}  // namespace broadmark
