// Why a pair is missed or false: the frames and pairs in which an algorithm is wrong, the two
// boxes, what led to it, and the smallest recording that shows it.

#include <fmt/format.h>

#include <memory>

#include "broadmark/recordings/recording.h"
#include "broadmark/recordings/sub_recording.h"
#include "inspector/panels/pair_drawing.h"
#include "inspector/panels/panel.h"
#include "inspector/session/wrong_pair.h"
#include "inspector/views/view.h"
#include "support/words.h"

#include <imgui_stdlib.h>  // after imgui.h, which it lacks

namespace broadmark::panels::mismatches {
namespace {

/// Height of the lists, in rows.
constexpr float kListRows = 4.6F;

class MismatchesPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (progress->tracks.empty()) {
      ui.paragraph(
          "Add an algorithm: its answers are compared with the right ones here, frame by frame.");
    } else {
      const TrackReport& track = chooseTrack();
      drawVerdict(track);
      drawSearch();
      drawLists(track);
      drawCase(track);
    }
    drawExport();
    drawPair();
    if (!progress->tracks.empty()) drawStructure();
  }

 private:
  /// The track of the shown answer, or else the first.
  const TrackReport& chooseTrack() {
    const std::vector<TrackReport>& tracks = progress->tracks;
    std::vector<std::string> names;
    std::size_t chosen = 0;
    for (const TrackReport& track : tracks) {
      if (track.spec.number == session.tracks.shown()) chosen = names.size();
      names.push_back(caseName(track.spec.test_case));
    }
    if (ui.combo("##algorithm", chosen, names, "Algorithm to inspect",
                 ImGui::GetContentRegionAvail().x)) {
      session.tracks.show(tracks[chosen].spec.number);
    }
    return tracks[chosen];
  }

  /// Whether the snapshot is this track's answer, compared with the right one.
  bool showsAnswerOf(const TrackReport& track) {
    const auto& seen = progress->snapshot;
    return seen && seen->checked && seen->track == track.spec.number;
  }

  void drawVerdict(const TrackReport& track) {
    if (!session.mismatches.check) {
      ui.coloured(ui.theme.warning, "answers are not checked");
      ImGui::SameLine();
      if (ui.button("Check them", "Compares every answer with the oracle's")) {
        session.mismatches.check = true;
      }
      return;
    }
    if (!track.spec.test_case.algorithm.traits.finds_pairs) {
      ui.faint("it reports no pairs by design");
      return;
    }
    if (!showsAnswerOf(track)) {
      ui.faint(progress->doing.empty() ? "no answer for this frame" : progress->doing.c_str());
      return;
    }
    const Snapshot& seen = *progress->snapshot;
    const FrameDifference& difference = seen.difference;
    if (!difference.isMismatch()) {
      ui.coloured(ui.theme.good, fmt::format("right in frame {}", seen.frame));
      return;
    }
    ui.coloured(ui.theme.bad, fmt::format("frame {}: {}", seen.frame, mismatchText(difference)));
  }

  void drawSearch() {
    if (session.mismatches.searching()) {
      if (wideButton("Stop here", "Stays at the frame that has been reached")) {
        session.mismatches.endSearch(*progress);
      }
    } else if (wideButton("Next mismatch", "Goes on to the next frame with a mismatch")) {
      session.mismatches.goToNext(*progress);
    }
  }

  void drawLists(const TrackReport& track) {
    const float height = kListRows * ImGui::GetTextLineHeightWithSpacing();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild("frames", {0.38F * width, height}, true, ImGuiWindowFlags_NavFlattened);
    drawFrames(track);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("pairs", {0, height}, true, ImGuiWindowFlags_NavFlattened);
    drawPairs(track);
    ImGui::EndChild();
  }

  void drawFrames(const TrackReport& track) {
    std::vector<std::uint32_t> wrong;
    const FrameValues& marks = track.curves.mismatches;
    for (auto frame = marks.firstKnown(0, marks.size()); frame;
         frame = marks.firstKnown(*frame + 1, marks.size())) {
      wrong.push_back(*frame);
    }
    if (wrong.empty()) ui.faintParagraph("no wrong frame so far");
    clipped(wrong.size(), [&](std::size_t row) {
      const std::string name = fmt::format("frame {}", wrong[row]);
      if (ui.selectable(name.c_str(), wrong[row] == session.playback.frame())) {
        session.playback.goTo(wrong[row]);
      }
    });
  }

  void drawPairs(const TrackReport& track) {
    if (!showsAnswerOf(track)) return;
    const Snapshot& seen = *progress->snapshot;
    const std::vector<WrongPair> wrong = wrongPairs(seen.difference);
    if (wrong.empty()) ui.faint("no wrong pairs");
    clipped(wrong.size(), [&](std::size_t row) {
      const auto& [kind, pair] = wrong[row];
      const std::string name = fmt::format("{} {}", kind->name, pairName(pair));
      const std::vector<std::uint32_t> bodies = {pair.a, pair.b};
      const bool clicked =
          ui.selectable(name.c_str(), session.selection.bodies() == bodies,
                        kind == &kWrongKinds.back()
                            ? "Reported though apart, within the algorithm's margin: no mismatch"
                            : "Selects both bodies and flies there",
                        ui.theme.*kind->colour);
      if (row == 0) ui.note("first pair");
      if (clicked) session.selection.visit(pair);
    });
    std::uint64_t all = 0;
    for (const WrongKind& kind : kWrongKinds) all += seen.difference.*kind.count;
    if (all > wrong.size()) ui.faint(fmt::format("… and {} more", all - wrong.size()));
  }

  /// The button that begins an export.
  void drawCase(const TrackReport& track) {
    const bool wrong = showsAnswerOf(track) && progress->snapshot->difference.isMismatch() &&
                       !session.jobs.get<CaseExport>().running();
    if (wideButton("Export case…",
                   "Writes the smallest recording on which the algorithm is still wrong", wrong)) {
      files.ask({.title = "Export the smallest recording that fails",
                 .purpose = FileDialog::Purpose::save,
                 .extensions = boxRecordingExtensions(),
                 .suggestion = fmt::format("{}{}", partName(progress->scene),
                                           recordingExtension(progress->scene)),
                 .chosen = [this, test_case = track.spec.test_case, seen = progress->snapshot](
                               const auto& file) { session.exportCase(test_case, seen, file); }});
    }
  }

  void drawExport() {
    CaseExport& case_export = session.jobs.get<CaseExport>();
    const CaseExport::Report report = case_export.report();
    if (report.state == TaskState::idle) return;
    const auto scope = ui.scope("export");
    ImGui::PushID("export");
    if (report.state == TaskState::running) {
      const double whole = static_cast<double>(report.whole_bodies * report.whole_frames);
      const double left = static_cast<double>(report.now.bodies * report.now.frames);
      ImGui::ProgressBar(
          static_cast<float>(whole > 0 ? 1 - left / whole : 1), {-1, 0},
          fmt::format("{}, {} runs", extentText(report.now.bodies, report.now.frames),
                      report.now.trials)
              .c_str());
      if (ui.button("Cancel", "Nothing is written then")) case_export.cancel();
    } else if (report.state == TaskState::done) {
      drawExported(report);
    } else {
      const bool failed = report.state == TaskState::failed;
      ui.coloured(failed ? ui.theme.bad : ui.theme.faint,
                  fmt::format("export {}", kTaskStates.nameOf(report.state)));
    }
    ImGui::PopID();
  }

  void drawExported(const CaseExport::Report& report) {
    ui.coloured(ui.theme.good,
                fmt::format("{} of {}", extentText(report.now.bodies, report.now.frames),
                            extentText(report.whole_bodies, report.whole_frames)));
    ui.tooltip(report.file.c_str());
    std::string command = report.command;
    ImGui::SetNextItemWidth(-1);
    ImGui::InputText("##command", &command, ImGuiInputTextFlags_ReadOnly);
    ui.note("command");
    ui.tooltip(command.c_str());
    if (ui.button("Copy", "Copies the command that shows the fault")) {
      ImGui::SetClipboardText(report.command.c_str());
    }
    ImGui::SameLine();
    if (ui.button("Open it", "Looks at the exported recording instead")) {
      session.openExport(report);
    }
  }

  void drawPair() {
    const auto& bodies = session.selection.bodies();
    const auto& seen = progress->snapshot;
    ui.heading("Pair");
    if (bodies.size() != 2 || !seen || bodies[1] >= seen->boxes->size()) {
      ui.paragraph("Click a pair above, or select two bodies.");
      return;
    }
    const BoxPair pair{
        {bodies[0], bodies[1]}, (*seen->boxes)[bodies[0]], (*seen->boxes)[bodies[1]]};
    ui.paragraph(view.answer().pair);
    const std::string unwanted = unwantedText(seen->scene.filter, pair.bodies);
    if (!unwanted.empty()) ui.coloured(ui.theme.warning, unwanted);
    if (isEmpty(pair.a) || isEmpty(pair.b)) {
      for (const Trail& trail : seen->trails) {
        if (!isEmpty(trail.boxes.back())) continue;
        ui.coloured(ui.theme.bad, fmt::format("body {}: {}", trail.body, absenceText(trail)));
      }
      return;
    }
    ui.coloured(overlaps(pair.a, pair.b) ? ui.theme.good : ui.theme.bad, sentenceOn(pair));
    drawPairTable(ui, pair);
    drawIntervals(ui, pair);
    drawHistory(pair);
  }

  /// "they overlap, least on y".
  static std::string sentenceOn(const BoxPair& pair) {
    const std::size_t axis = decidingAxis(pair.a, pair.b);
    const AxisRelation relation = relationOn(axis, pair.a, pair.b);
    constexpr NameTable kSentences{
        {NamedValue{AxisRelation::Type::overlap, "they overlap, least on"},
         {AxisRelation::Type::touch, "they overlap, just touching on"},
         {AxisRelation::Type::gap, "they are apart, most on"}}};
    return fmt::format("{} {}", kSentences.nameOf(relation.type), kAxes[axis]);
  }

  void drawHistory(const BoxPair& pair) {
    const std::vector<Trail>& trails = progress->snapshot->trails;
    if (trails.size() != 2 || trails[0].body != pair.bodies.a || trails[1].body != pair.bodies.b) {
      return;
    }
    const PairTrails trail{trails[0], trails[1]};
    ui.heading("History");
    const auto began = trail.overlapBegan();
    if (!began) {
      ui.faint(fmt::format("frames {} to {}: apart at the end", trails[0].first,
                           trails[0].first + trail.size() - 1));
    } else if (*began == trails[0].first) {
      ui.faint(fmt::format("overlapping since frame {} or earlier", *began));
    } else {
      ui.faint(fmt::format("overlapping since frame {}", *began));
    }
    if (const auto clicked = drawPairHistory(ui, trail)) {
      session.playback.goTo(*clicked);
    }
  }

  void drawStructure() {
    ui.heading("Inside the algorithm");
    ui.toggle("Show structure", session.display.structure,
              "Draws its cells, nodes or planes in the view, around the pair");
    for (const TrackReport& track : progress->tracks) {
      if (track.spec.number != session.tracks.shown()) continue;
      if (track.margin > 0) ui.fact("margin", fmt::format("{}", track.margin));
      const auto& seen = progress->snapshot;
      const Counts none;
      const bool is_its = seen && seen->track == track.spec.number;
      for (const auto* counts : {&track.setup, is_its ? &seen->counters : &none}) {
        for (const auto& [name, count] : *counts) ui.fact(name.c_str(), std::to_string(count));
      }
    }
  }
};

}  // namespace

extern const PanelKind kind = {"Mismatches", DockArea::right,
                               "Pairs that are missed, false or invalid, and why",
                               make<MismatchesPanel>};

}  // namespace broadmark::panels::mismatches
