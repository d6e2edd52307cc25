// The cases of a results file as a table and as plots; a click opens a case.

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "inspector/panels/case_plots.h"
#include "inspector/panels/panel.h"
#include "support/child_program.h"
#include "support/table.h"

#include <imgui_stdlib.h>  // requires imgui.h

namespace broadmark::panels::cases {
namespace {

constexpr float kTableShare = 0.52F;     // of the width; the rest is the plot's
constexpr float kMinWidthForBoth = 760;  // units; a narrower panel shows one of both

constexpr std::string_view kStatus = "status";

using Row = OpenedResults::Row;

std::string secondsText(double seconds) { return withPrefix(seconds, "s"); }

std::string textOf(const Row& row, const CaseColumn& column) {
  if (column.shown.known == Availability::checked && !row.result.checked) return "not checked";
  return cellText(column, row.result, row.summary.value_or(Summary{}), secondsText);
}

class CasesPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (!session.results) {
      ui.paragraph(
          "Open or drop a results file (.json or .jsonl, complete or partial) to list its cases, "
          "plot their times, and open a case on its recording.");
      return;
    }
    OpenedResults& results = *session.results;
    const SplitPane parts{
        .share = kTableShare, .min_width = kMinWidthForBoth * ui.scale, .second_only = plot_only_};
    drawControls(results, parts.both());
    parts.draw([&] { drawTable(results); }, [&] { plots_.draw(results); });
  }

 private:
  void drawControls(OpenedResults& results, bool both) {
    const std::string summary = summaryText(results);
    ui.faint(fittingText(summary, ImGui::GetContentRegionAvail().x));
    ui.tooltip(fmt::format("{}: {}", results.file().string(), summary).c_str());
    ImGui::SetNextItemWidth(110 * ui.scale);
    ImGui::InputTextWithHint("##search", "search", &search_);
    ui.note("search");
    ui.tooltip("List only cases with this text in their id");
    ImGui::SameLine();
    ui.checkbox("wrong only", only_wrong_, "List only cases with wrong answers");
    results.filter(search_, only_wrong_);
    if (!both) {
      ImGui::SameLine();
      ui.toggle("Plot", plot_only_, "Show the plot instead of the table");
    }
    Ui::sameLineIfFits(105 * ui.scale);
    drawReport(results);
  }

  /// Draws the buttons that write and open the report page of all cases.
  void drawReport(const OpenedResults& results) {
    BackgroundReport& work = session.jobs.get<BackgroundReport>();
    const BackgroundReport::Report report = work.report();
    if (report.state == TaskState::running) {
      if (ui.button("Cancel report", "Stop writing the report page")) work.cancel();
      return;
    }
    if (ui.button("Report page…",
                  "Write all cases to an HTML page, like python3 -m broadmark report")) {
      askPage(results);
    }
    static const bool opens = isProgramInPath("xdg-open");
    if (report.state != TaskState::done || !opens) return;
    Ui::sameLineIfFits(85 * ui.scale);
    if (ui.button("Open page", report.page.string().c_str())) {
      session.notices.catchErrors([&] { openWithDesktop(report.page); });
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
                 session.notices.catchErrors(
                     [&] { startReport(session.jobs.get<BackgroundReport>(), file, chosen); });
               }});
  }

  static std::string summaryText(const OpenedResults& results) {
    std::string text = fmt::format("{}: {}", results.file().filename().string(),
                                   counted(results.rows().size(), "case"));
    text +=
        results.wrongCount() > 0 ? fmt::format(", {} wrong", results.wrongCount()) : ", none wrong";
    return text + (results.complete() ? "" : ", not complete");
  }

  void drawTable(OpenedResults& results) {
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                       ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                       ImGuiTableFlags_ScrollY | ImGuiTableFlags_Sortable |
                                       ImGuiTableFlags_SortTristate;
    if (results.listed().empty()) {
      ui.faintParagraph(results.rows().empty() ? "The file has no cases." : "No case matches.");
      return;
    }
    const auto columns = static_cast<int>(columns_.size()) + 1;
    if (!ImGui::BeginTable("cases", columns, kFlags, {widthOfWholeColumns("cases", 3), 0})) return;
    ImGui::TableSetupScrollFreeze(2, 1);
    ImGui::TableSetupColumn("##mark", ImGuiTableColumnFlags_NoSort);
    std::vector<std::string> names = {"##mark"};
    for (const CaseColumn* column : columns_) {
      names.push_back(column->shown.heading);
      ImGui::TableSetupColumn(names.back().c_str());
    }
    ui.headings(names);
    sort(results);
    const auto curves = plots_.rowColours(ui.theme, results);
    clipped(results.listed().size(), [&](std::size_t row) {
      const std::size_t index = results.listed()[row];
      drawRow(results, index, curves[index], row == 0);
    });
    ImGui::EndTable();
  }

  void sort(OpenedResults& results) const {
    ImGuiTableSortSpecs* const specs = ImGui::TableGetSortSpecs();
    if (specs == nullptr || !specs->SpecsDirty) return;
    specs->SpecsDirty = false;
    if (specs->SpecsCount == 0) {
      results.sort("", false);
      return;
    }
    const ImGuiTableColumnSortSpecs& by = specs->Specs[0];
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
                    "Plot its times over its frames")) {
      results.mark(index, marked);
    }
    ImGui::PopStyleVar();
    for (const CaseColumn* column : columns_) {
      ImGui::TableNextColumn();
      const std::optional<Rgb> rgb = colourOf(row, column->key);
      if (column == columns_.front()) {
        drawOpenCell(row, curve ? curve : rgb, first);
      } else {
        rgb ? ui.coloured(*rgb, textOf(row, *column)) : ui.plain(textOf(row, *column));
        if (column->key == kStatus) ui.tooltip(row.result.reason.c_str());
      }
    }
    ImGui::PopID();
  }

  /// Draws a cell across the whole row that opens the case.
  void drawOpenCell(Row& row, std::optional<Rgb> rgb, bool first) {
    const FrameProviderRequest* open = session.playback.source().get();
    const bool is_open =
        open != nullptr && open->origin == FrameOrigin::results && open->title == row.result.id;
    const std::string tip = row.obstacle.empty() ? "Open the case: " + row.result.id
                                                 : "Cannot be opened: " + row.obstacle;
    const std::string label = fmt::format("{}###{}", row.algorithm, row.result.id);
    const bool pressed = ui.selectable(label.c_str(), is_open, tip.c_str(), rgb);
    if (first) ui.note("first");
    if (pressed) session.openCase(row);
  }

  /// Returns nothing for the default text colour.
  std::optional<Rgb> colourOf(const Row& row, std::string_view column) {
    if (column == kStatus) {
      return row.result.status == Status::ok ? ui.theme.good : ui.theme.bad;
    }
    if (column == "mismatches" && row.mismatches > 0) return ui.theme.bad;
    if (!row.obstacle.empty()) return ui.theme.faint;
    return {};
  }

  std::string search_;
  bool only_wrong_ = false;
  bool plot_only_ = false;
  CasePlots plots_{*this};
  const std::vector<const CaseColumn*> columns_ = caseColumns(&ColumnDisplay::inspector);
};

}  // namespace

extern const PanelSpec spec = {"Cases", DockArea::bottom,
                               "List, plot and open the cases of a results file", make<CasesPanel>};

}  // namespace broadmark::panels::cases
