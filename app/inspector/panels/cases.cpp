// The cases of a results file: their numbers, their times as plots, and the way back to each.

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "inspector/panels/case_plots.h"
#include "inspector/panels/panel.h"
#include "support/child_program.h"
#include "support/table.h"

#include <imgui_stdlib.h>  // after imgui.h, which it lacks

namespace broadmark::panels::cases {
namespace {

constexpr float kTableShare = 0.52F;  // of the width; the rest is the plot's
constexpr float kRoomForBoth = 760;   // units: narrower, it is either the one or the other

constexpr std::string_view kStatus = "status";

using Row = OpenedResults::Row;

std::string secondsText(double seconds) { return withPrefix(seconds, "s"); }

std::string textOf(const Row& row, const CaseColumn& column) {
  if (column.shown.known == Known::checked && !row.result.checked) return "not checked";
  return cellText(column, row.result, row.summary.value_or(Summary{}), secondsText);
}

class CasesPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (!session.results) {
      ui.paragraph(
          "Open or drop a results file (.json or .jsonl, whole or not yet complete) to see its "
          "cases, plot their times, and open each of them on what it ran on.");
      return;
    }
    OpenedResults& results = *session.results;
    const SplitPane parts{
        .share = kTableShare, .narrowest = kRoomForBoth * ui.scale, .second_alone = plot_alone_};
    drawControls(results, parts.both());
    parts.draw([&] { drawTable(results); }, [&] { plots_.draw(results); });
  }

 private:
  void drawControls(OpenedResults& results, bool both) {
    const std::string what = summaryText(results);
    ui.faint(fittingText(what, ImGui::GetContentRegionAvail().x));
    ui.tooltip(fmt::format("{}: {}", results.file().string(), what).c_str());
    ImGui::SetNextItemWidth(110 * ui.scale);
    ImGui::InputTextWithHint("##search", "search", &searched_);
    ui.note("search");
    ui.tooltip("Lists only cases with this text in their id");
    ImGui::SameLine();
    ui.checkbox("wrong only", only_wrong_, "Lists the cases that gave a wrong answer");
    results.filter(searched_, only_wrong_);
    if (!both) {
      ImGui::SameLine();
      ui.toggle("Plot", plot_alone_, "The plot in place of the table");
    }
    Ui::besideIfRoom(105 * ui.scale);
    drawReport(results);
  }

  /// Writes the report page of all cases, and opens it.
  void drawReport(const OpenedResults& results) {
    BackgroundReport& work = session.jobs.get<BackgroundReport>();
    const BackgroundReport::Report report = work.report();
    if (report.state == TaskState::running) {
      if (ui.button("Cancel report", "It is being written")) work.cancel();
      return;
    }
    if (ui.button("Report page…",
                  "Writes all cases as an HTML page, as python3 -m broadmark "
                  "report does")) {
      askPage(results);
    }
    static const bool opens = isProgramThere("xdg-open");
    if (report.state != TaskState::done || !opens) return;
    Ui::besideIfRoom(85 * ui.scale);
    if (ui.button("Open page", report.page.string().c_str())) {
      session.notices.attempt([&] { openByDesktop(report.page); });
    }
  }

  void askPage(const OpenedResults& results) {
    std::filesystem::path page = results.file();
    files.ask({.title = "Write the report page",
               .purpose = FileDialog::Purpose::save,
               .extensions = {".html"},
               .suggestion = page.replace_extension(".html"),
               .chosen = [&session = session,
                          file = results.file()](const std::filesystem::path& chosen) {
                 session.notices.attempt(
                     [&] { startReport(session.jobs.get<BackgroundReport>(), file, chosen); });
               }});
  }

  static std::string summaryText(const OpenedResults& results) {
    std::string text = fmt::format("{}: {}", results.file().filename().string(),
                                   counted(results.rows().size(), "case"));
    text += results.wrong() > 0 ? fmt::format(", {} wrong", results.wrong()) : ", none wrong";
    return text + (results.complete() ? "" : ", not complete");
  }

  void drawTable(OpenedResults& results) {
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                       ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                       ImGuiTableFlags_ScrollY | ImGuiTableFlags_Sortable |
                                       ImGuiTableFlags_SortTristate;
    if (results.listed().empty()) {
      ui.faintParagraph(results.rows().empty() ? "The file has no cases."
                                               : "No case is like that.");
      return;
    }
    const auto columns = static_cast<int>(columns_.size()) + 1;
    if (!ImGui::BeginTable("cases", columns, kFlags, {widthOfWholeColumns("cases", 3), 0})) return;
    ImGui::TableSetupScrollFreeze(2, 1);
    ImGui::TableSetupColumn("##mark", ImGuiTableColumnFlags_NoSort);
    for (const CaseColumn* column : columns_)
      ImGui::TableSetupColumn(column->shown.heading.c_str());
    drawHeadings();
    sort(results);
    const auto curves = plots_.rowColours(ui.theme, results);
    clipped(results.listed().size(), [&](std::size_t row) {
      const std::size_t index = results.listed()[row];
      drawRow(results, index, curves[index], row == 0);
    });
    ImGui::EndTable();
  }

  void drawHeadings() {
    const auto scope = ui.scope("by");
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (int i = 0; i < ImGui::TableGetColumnCount(); ++i) {
      if (!ImGui::TableSetColumnIndex(i)) continue;
      ImGui::TableHeader(ImGui::TableGetColumnName(i));
      ui.note(ImGui::TableGetColumnName(i));
    }
  }

  void sort(OpenedResults& results) const {
    ImGuiTableSortSpecs* const wanted = ImGui::TableGetSortSpecs();
    if (wanted == nullptr || !wanted->SpecsDirty) return;
    wanted->SpecsDirty = false;
    if (wanted->SpecsCount == 0) {
      results.sort("", false);
      return;
    }
    const ImGuiTableColumnSortSpecs& by = wanted->Specs[0];
    results.sort(columns_.at(static_cast<std::size_t>(by.ColumnIndex) - 1)->key,
                 by.SortDirection == ImGuiSortDirection_Descending);
  }

  void drawRow(OpenedResults& results, std::size_t index, std::optional<Rgb> curve, bool first) {
    Row& row = results.rows()[index];
    ImGui::PushID(static_cast<int>(index));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
    bool marked = row.marked;
    if (ui.checkbox(fmt::format("##mark {}", row.result.id).c_str(), marked,
                    "Plots its times over the frames")) {
      results.mark(index, marked);
    }
    ImGui::PopStyleVar();
    for (const CaseColumn* column : columns_) {
      ImGui::TableNextColumn();
      const std::optional<Rgb> rgb = colourOf(row, column->key);
      if (column == columns_.front()) {
        drawOpener(row, curve ? curve : rgb, first);
      } else {
        rgb ? ui.coloured(*rgb, textOf(row, *column)) : ui.plain(textOf(row, *column));
        if (column->key == kStatus) ui.tooltip(row.result.reason.c_str());
      }
    }
    ImGui::PopID();
  }

  /// The cell that opens the case, across the whole row.
  void drawOpener(Row& row, std::optional<Rgb> rgb, bool first) {
    const FrameProviderRequest* open = session.playback.source().get();
    const bool is_open =
        open != nullptr && open->origin == FrameOrigin::results && open->title == row.result.id;
    const std::string tip = row.obstacle.empty() ? "Opens the case: " + row.result.id
                                                 : "Cannot be opened: " + row.obstacle;
    const std::string label = fmt::format("{}###{}", row.algorithm, row.result.id);
    const bool pressed = ui.selectable(label.c_str(), is_open, tip.c_str(), rgb);
    if (first) ui.note("first");
    if (pressed) session.openCase(row);
  }

  /// Nothing: as all text.
  std::optional<Rgb> colourOf(const Row& row, std::string_view column) {
    if (column == kStatus) {
      return row.result.status == Status::ok ? ui.theme.good : ui.theme.bad;
    }
    if (column == "mismatches" && row.mismatches > 0) return ui.theme.bad;
    if (!row.obstacle.empty()) return ui.theme.faint;
    return {};
  }

  std::string searched_;
  bool only_wrong_ = false;
  bool plot_alone_ = false;
  CasePlots plots_{*this};
  const std::vector<const CaseColumn*> columns_ = caseColumns(&ColumnShown::inspector);
};

}  // namespace

extern const PanelKind kind = {"Cases", DockArea::bottom,
                               "The cases of a results file: their times, and each of them again",
                               make<CasesPanel>};

}  // namespace broadmark::panels::cases
