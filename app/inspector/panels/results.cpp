// What each algorithm did in this frame, side by side.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "broadmark/render/plot.h"
#include "inspector/panels/panel.h"

namespace broadmark::panels::results {
namespace {

std::string time(std::int64_t ns) { return withPrefix(static_cast<double>(ns) * 1e-9, "s"); }

/// Mean total of the undisturbed frames, in nanoseconds; below 0: none.
double meanTotal(const LaneReport& lane) {
  double sum = 0;
  std::uint64_t count = 0;
  for (const FrameRecord& record : lane.frames) {
    if (!record.run || record.disturbed) continue;
    sum += static_cast<double>(record.times[Phase::total]);
    ++count;
  }
  return count == 0 ? -1 : sum / static_cast<double>(count);
}

class ResultsPanel final : public Panel {
 public:
  ResultsPanel() : Panel("Results", Place::bottom, "What each algorithm did in this frame") {}

  void draw(PanelContext& context) override {
    const std::vector<LaneReport>& lanes = context.progress.lanes;
    if (lanes.empty()) {
      context.ui.paragraph(
          "Add algorithms in the panel Algorithms to see their times and answers side by side.");
      return;
    }
    std::vector<Row> rows;
    for (const LaneReport& lane : lanes) {
      rows.push_back(rowOf(lane, context.session.playback.frame()));
    }
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                       ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                       ImGuiTableFlags_ScrollY;
    const std::vector<std::string> columns = columnNames();
    if (!ImGui::BeginTable("results", static_cast<int>(columns.size()), kFlags,
                           {widthOfWholeColumns("results", 2), 0})) {
      return;
    }
    ImGui::TableSetupScrollFreeze(1, 1);
    for (const std::string& column : columns) ImGui::TableSetupColumn(column.c_str());
    ImGui::TableHeadersRow();
    const std::vector<Rgb> colours = context.laneColours();
    for (std::size_t i = 0; i < lanes.size(); ++i) drawLane(context, lanes[i], rows[i], colours[i]);
    ImGui::EndTable();
  }

 private:
  struct Cell {
    std::string text;
    bool bad = false;
  };
  /// The cells beside name and status.
  struct Row {
    std::string name;
    std::string status;
    std::vector<Cell> cells;
    bool disturbed = false;
  };

  /// The phases are called as everywhere.
  static std::vector<std::string> columnNames() {
    std::vector<std::string> names = {"algorithm", "status", "total",   "mean",         "pairs",
                                      "missed",    "false",  "invalid", "allowed extra"};
    for (const auto& [phase, name] : kPhases.entries) {
      if (phase != Phase::total) names.emplace_back(name);
    }
    return names;
  }

  static Row rowOf(const LaneReport& lane, std::uint32_t frame) {
    const FrameRecord* record = lane.record(frame);
    Row row{.name = caseName(lane.spec.run),
            .status = std::string(statusName(lane.status)),
            .disturbed = record != nullptr && record->disturbed};
    const auto phase = [&](Phase which) {
      row.cells.push_back({record == nullptr ? "–" : time(record->times[which])});
    };
    phase(Phase::total);
    if (row.disturbed) row.cells.back().text += " *";
    const double mean = meanTotal(lane);
    row.cells.push_back({mean < 0 ? "–" : withPrefix(mean * 1e-9, "s")});
    row.cells.push_back({record == nullptr ? "–" : std::to_string(record->pairs)});
    const auto wrong = [&](std::uint64_t FrameRecord::*count, bool allowed = false) {
      const bool checked = record != nullptr && record->checked;
      row.cells.push_back({checked ? std::to_string(record->*count) : "–",
                           checked && !allowed && record->*count > 0});
    };
    wrong(&FrameRecord::missed_count);
    wrong(&FrameRecord::false_count);
    wrong(&FrameRecord::invalid_count);
    wrong(&FrameRecord::allowed_extra_count, true);
    for (const auto& [which, name] : kPhases.entries) {
      if (which != Phase::total) phase(which);
    }
    return row;
  }

  static void drawLane(PanelContext& context, const LaneReport& lane, const Row& row, Rgb curve) {
    Ui& ui = context.ui;
    ImGui::TableNextRow();
    ImGui::PushID(lane.spec.number);
    ImGui::TableNextColumn();
    const bool shown = context.session.lanes.shown() == lane.spec.number;
    ImGui::PushStyleColor(ImGuiCol_Text, colour(curve));
    if (ImGui::Selectable(row.name.c_str(), shown, ImGuiSelectableFlags_SpanAllColumns)) {
      context.session.lanes.show(lane.spec.number);
    }
    ImGui::PopStyleColor();
    ui.note(lane.spec.run.algorithm.id);
    ImGui::TableNextColumn();
    const bool bad = lane.status != Status::ok;
    ui.coloured(bad ? ui.theme.bad : ui.theme.good, row.status);
    ui.tooltip(lane.reason.c_str());
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      ImGui::TableNextColumn();
      if (row.cells[i].bad) {
        ui.coloured(ui.theme.bad, row.cells[i].text);
      } else {
        ImGui::TextUnformatted(row.cells[i].text.c_str());
      }
      if (i == 0 && row.disturbed) {
        ui.tooltip("*: disturbed: the window was drawn while this frame was timed");
      }
    }
    ImGui::PopID();
  }
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<ResultsPanel>(); }

}  // namespace broadmark::panels::results
