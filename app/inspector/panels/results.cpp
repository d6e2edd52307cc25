// Times and answers of the algorithms in the current frame, side by side.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "inspector/panels/panel.h"
#include "inspector/session/track_statistics.h"

namespace broadmark::panels::results {
namespace {

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
    const std::vector<std::string> columns = columnNames();
    if (!ui.beginTable("results", columns, 2)) return;
    const std::vector<Rgb> colours = trackColours();
    const auto rows = Ui::sortedRows(tracks.size(), [&](std::size_t row, std::size_t column) {
      return sortKey(tracks[row], columns.at(column));
    });
    for (const std::size_t row : rows) drawTrack(tracks[row], colours[row]);
    ui.endTable();
  }

 private:
  static std::vector<std::string> columnNames() {
    std::vector<std::string> names = {"algorithm", "status", "total",   "mean",         "pairs",
                                      "missed",    "false",  "invalid", "allowed_extra"};
    for (const auto& [phase, name] : kPhases.entries) {
      if (phase != Phase::total) names.emplace_back(name);
    }
    return names;
  }

  [[nodiscard]] Ui::SortKey sortKey(const TrackReport& track, const std::string& column) const {
    if (column == "algorithm") return caseName(track.spec.test_case);
    if (column == "status") return std::string(statusName(track.status));
    if (column == "mean") return meanSeconds(track, Phase::total).value_or(-1);
    const FrameRecord* const record = track.record(session.playback.frame());
    if (record == nullptr) return -1.0;
    if (const auto phase = kPhases.find(column)) return static_cast<double>(record->times[*phase]);
    return static_cast<double>(record->counts[*kFrameCounts.find(column)]);
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
    const std::optional<double> mean = meanSeconds(track, Phase::total);
    ui.cell(mean ? withPrefix(*mean, "s") : "–");
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
