// Times and answers of the algorithms in the current frame, side by side.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "inspector/panels/panel.h"

namespace broadmark::panels::results {
namespace {

/// Returns the mean total of the undisturbed frames, in nanoseconds; -1 if there are none.
double meanTotal(const TrackReport& track) {
  double sum = 0;
  std::uint64_t count = 0;
  for (const FrameRecord& record : track.frames) {
    if (!record.run || record.disturbed) continue;
    sum += static_cast<double>(record.times[Phase::total]);
    ++count;
  }
  return count == 0 ? -1 : sum / static_cast<double>(count);
}

class ResultsPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    const std::vector<TrackReport>& tracks = progress->tracks;
    if (tracks.empty()) {
      ui.paragraph(
          "Add algorithms in the panel Algorithms to see their times and answers side by side.");
      return;
    }
    if (!ui.beginTable("results", columnNames(), 2)) return;
    const std::vector<Rgb> colours = trackColours();
    for (std::size_t i = 0; i < tracks.size(); ++i) drawTrack(tracks[i], colours[i]);
    ImGui::EndTable();
  }

 private:
  static std::vector<std::string> columnNames() {
    std::vector<std::string> names = {"algorithm", "status", "total",   "mean",         "pairs",
                                      "missed",    "false",  "invalid", "allowed extra"};
    for (const auto& [phase, name] : kPhases.entries) {
      if (phase != Phase::total) names.emplace_back(name);
    }
    return names;
  }

  void drawTrack(const TrackReport& track, Rgb curve) {
    const FrameRecord* const record = track.record(session.playback.frame());
    ImGui::TableNextRow();
    ImGui::PushID(track.spec.number);
    ImGui::TableNextColumn();
    const bool shown = session.tracks.shown() == track.spec.number;
    const std::string label =
        fmt::format("{}###{}", caseName(track.spec.test_case), track.spec.test_case.algorithm.id);
    if (ui.selectable(label.c_str(), shown, nullptr, curve)) {
      session.tracks.show(track.spec.number);
    }
    const auto time = [&](Phase phase, const char* mark) {
      ui.cell(record == nullptr
                  ? "–"
                  : withPrefix(static_cast<double>(record->times[phase]) * 1e-9, "s") + mark);
    };
    ui.cell(statusName(track.status), track.status == Status::ok ? ui.theme.good : ui.theme.bad);
    ui.tooltip(track.reason.c_str());
    const bool disturbed = record != nullptr && record->disturbed;
    time(Phase::total, disturbed ? " *" : "");
    if (disturbed) ui.tooltip("*: disturbed: the window was drawn while this frame was timed");
    const double mean = meanTotal(track);
    ui.cell(mean < 0 ? "–" : withPrefix(mean * 1e-9, "s"));
    ui.cell(record == nullptr ? "–" : std::to_string(record->counts[FrameCount::pairs]));
    for (const FrameCount type : {FrameCount::missed, FrameCount::false_pairs, FrameCount::invalid,
                                  FrameCount::allowed_extra}) {
      const bool checked = record != nullptr && record->checked;
      const std::uint64_t count = checked ? record->counts[type] : 0;
      const bool bad = count > 0 && type != FrameCount::allowed_extra;
      ui.cell(checked ? std::to_string(count) : "–", bad ? ui.theme.bad : ui.theme.text);
    }
    for (const auto& [phase, name] : kPhases.entries) {
      if (phase != Phase::total) time(phase, "");
    }
    ImGui::PopID();
  }
};

}  // namespace

extern const PanelSpec spec = {"Results", DockArea::bottom,
                               "Times and answers of the algorithms in this frame",
                               make<ResultsPanel>};

}  // namespace broadmark::panels::results
