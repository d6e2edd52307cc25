// What each algorithm did in this frame, side by side.

#include <fmt/format.h>

#include <array>

#include "broadmark/render/plot.h"
#include "inspector/curve_colours.h"
#include "inspector/panel.h"

namespace broadmark::panels::results {
namespace {

constexpr std::array kColumns = {"algorithm",  "status",        "total",  "update", "clean",
                                 "structures", "search",        "mean",   "pairs",  "missed",
                                 "false",      "allowed extra", "invalid"};

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
    if (context.progress.lanes.empty()) {
      context.ui.faint("Add algorithms to see their times and answers side by side.");
      return;
    }
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                       ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                       ImGuiTableFlags_ScrollY;
    if (!ImGui::BeginTable("results", static_cast<int>(kColumns.size()), kFlags)) return;
    ImGui::TableSetupScrollFreeze(1, 1);
    for (const char* column : kColumns) ImGui::TableSetupColumn(column);
    ImGui::TableHeadersRow();
    for (const LaneReport& lane : context.progress.lanes) drawLane(context, lane);
    ImGui::EndTable();
  }

 private:
  static void drawLane(PanelContext& context, const LaneReport& lane) {
    Ui& ui = context.ui;
    ImGui::TableNextRow();
    ImGui::PushID(lane.spec.number);
    ImGui::TableNextColumn();
    const bool shown = context.session.lanes.shown() == lane.spec.number;
    ImGui::PushStyleColor(ImGuiCol_Text, colour(curveColour(lane.spec.number, ui.theme.dark)));
    if (ImGui::Selectable(caseName(lane.spec.run).c_str(), shown,
                          ImGuiSelectableFlags_SpanAllColumns)) {
      context.session.lanes.show(lane.spec.number);
    }
    ImGui::PopStyleColor();
    ui.note(lane.spec.run.algorithm.id);
    ImGui::TableNextColumn();
    const bool bad = lane.status != Status::ok;
    ui.coloured(bad ? ui.theme.bad : ui.theme.good, statusName(lane.status));
    ui.tooltip(lane.reason.c_str());
    drawTimes(ui, lane, context.session.playback.frame());
    ImGui::PopID();
  }

  static void drawTimes(Ui& ui, const LaneReport& lane, std::uint32_t frame) {
    const FrameRecord* record = lane.record(frame);
    const auto cell = [&](const std::string& text, bool bad = false) {
      ImGui::TableNextColumn();
      if (bad) {
        ui.coloured(ui.theme.bad, text);
      } else {
        ImGui::TextUnformatted(text.c_str());
      }
    };
    const auto phase = [&](Phase which) {
      cell(record == nullptr ? "–" : time(record->times[which]));
    };
    phase(Phase::total);
    if (record != nullptr && record->disturbed) {
      ImGui::SameLine(0, 3);
      ui.coloured(ui.theme.warning, "*");
      ui.tooltip("disturbed: the window was drawn while this frame was timed");
    }
    phase(Phase::update_objects);
    phase(Phase::clean_cache);
    phase(Phase::update_structures);
    phase(Phase::search_overlaps);
    const double mean = meanTotal(lane);
    cell(mean < 0 ? "–" : withPrefix(mean * 1e-9, "s"));
    cell(record == nullptr ? "–" : std::to_string(record->pairs));
    const auto wrong = [&](std::uint64_t FrameRecord::*count, bool allowed = false) {
      const bool checked = record != nullptr && record->checked;
      cell(checked ? std::to_string(record->*count) : "–",
           checked && !allowed && record->*count > 0);
    };
    wrong(&FrameRecord::missed_count);
    wrong(&FrameRecord::false_count);
    wrong(&FrameRecord::allowed_extra_count, true);
    wrong(&FrameRecord::invalid_count);
  }
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<ResultsPanel>(); }

}  // namespace broadmark::panels::results
