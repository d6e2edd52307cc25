// The cases of a results file as a table and as plots; a click opens a case.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
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

constexpr float kTableShare = 0.52F;  // of the width; the rest is the plot's
constexpr float kComparisonShare = 0.72F;
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
    SplitPane parts{
        .share = kTableShare, .min_width = kMinWidthForBoth * ui.scale, .second_only = plot_only_};
    drawControls(results, parts.both());
    const OpenedResults::Compared* const compared = results.compared();
    if (compared != nullptr) parts.share = kComparisonShare;
    parts.draw([&] { compared != nullptr ? drawComparison(*compared) : drawTable(results); },
               [&] { plots_.draw(results); });
  }

 private:
  void drawControls(OpenedResults& results, bool both) {
    const std::string summary = summaryOf(results);
    ui.faint(fittingText(summary, ImGui::GetContentRegionAvail().x));
    ui.note("summary");
    std::string tip = fmt::format("{}: {}", results.file().string(), summary);
    if (const OpenedResults::Compared* compared = results.compared()) {
      tip += fmt::format("\n{}", fmt::join(compared->comparison.notes, "\n"));
    }
    ui.tooltip(tip.c_str());
    ImGui::SetNextItemWidth(110 * ui.scale);
    ImGui::InputTextWithHint("##search", "search", &search_);
    ui.note("search");
    ui.tooltip("List only cases with this text in their id");
    ImGui::SameLine();
    ui.checkbox("wrong only", only_wrong_, "List only cases with wrong answers",
                results.compared() == nullptr);
    results.filter(search_, only_wrong_);
    if (!both) {
      ImGui::SameLine();
      ui.toggle("Plot", plot_only_, "Show the plot instead of the table");
    }
    Ui::sameLineIfFits(125 * ui.scale);
    if (results.compared() != nullptr) {
      if (ui.button("End comparison", "List the cases of the opened file again")) {
        results.endComparison();
      }
    } else if (ui.button("Compare with…", "Judge these results, B, against another file, A")) {
      askBaseline(results);
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

  void askBaseline(const OpenedResults& results) {
    files.ask({.title = "Compare with a baseline",
               .extensions = {".json", ".jsonl"},
               .suggestion = results.file(),
               .chosen = [&session = session](const std::filesystem::path& chosen) {
                 session.notices.catchErrors([&] { session.results->compareWith(chosen); });
               }});
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

  static std::string summaryOf(const OpenedResults& results) {
    if (const OpenedResults::Compared* compared = results.compared()) {
      return fmt::format("B: {}, A: {}; {}", results.file().filename().string(),
                         std::filesystem::path(compared->before.name).filename().string(),
                         summaryText(compared->comparison));
    }
    std::string text = fmt::format("{}: {}", results.file().filename().string(),
                                   counted(results.rows().size(), "case"));
    text +=
        results.wrongCount() > 0 ? fmt::format(", {} wrong", results.wrongCount()) : ", none wrong";
    return text + (results.complete() ? "" : ", not complete");
  }

  void drawTable(OpenedResults& results) {
    if (results.listed().empty()) {
      ui.faintParagraph(results.rows().empty() ? "The file has no cases." : "No case matches.");
      return;
    }
    std::vector<std::string> names = {"##mark"};
    for (const CaseColumn* column : columns_) names.push_back(column->shown.heading);
    if (!ui.beginTable("cases", names, 3)) return;
    sort(results);
    const auto curves = plots_.rowColours(ui.theme, results);
    clipped(
        results.listed().size(),
        [&](std::size_t row) {
          const std::size_t index = results.listed()[row];
          drawRow(results, index, curves[index], row == 0);
        },
        ui.copiesTables());
    ui.endTable();
  }

  void drawComparison(const OpenedResults::Compared& compared) {
    const std::span rows(compared.table);
    std::vector<std::string> headings;
    for (const std::size_t column : kComparisonColumns) headings.push_back(rows[0][column]);
    if (!ui.beginTable("comparison", headings, 2)) return;
    const std::vector<CaseComparison>& cases = compared.comparison.cases;
    std::vector<std::size_t> listed =
        Ui::sortedRows(cases.size(), [&](std::size_t row, std::size_t column) {
          return sortKey(cases[row], rows[row + 1], kComparisonColumns.at(column));
        });
    std::erase_if(
        listed, [&](std::size_t row) { return cases[row].id.find(search_) == std::string::npos; });
    clipped(
        listed.size(),
        [&](std::size_t i) {
          const std::size_t row = listed[i];
          drawCompared(compared.comparison, cases[row], rows[row + 1]);
        },
        ui.copiesTables());
    ui.endTable();
  }

  /// The number of a cell, or its text in columns of texts: the first and the last.
  static Ui::SortKey sortKey(const CaseComparison& compared, const std::vector<std::string>& cells,
                             std::size_t column) {
    const RunRatio unknown{.before = -1, .after = -1, .ratio = {-1, {-1, -1}}, .drift = {}};
    const RunRatio& ratio = compared.ratio ? *compared.ratio : unknown;
    switch (column) {
      case 1:
        return ratio.before;
      case 2:
        return ratio.after;
      case 3:
        return ratio.ratio.value;
      case 4:
        return ratio.ratio.ci95.low;
      default:
        return cells[column];
    }
  }

  void drawCompared(const Comparison& comparison, const CaseComparison& compared,
                    const std::vector<std::string>& cells) {
    const Rgb rgb = comparison.fails(compared)            ? ui.theme.bad
                    : compared.verdict == Verdict::faster ? ui.theme.good
                                                          : ui.theme.text;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    std::string tip = "Open the case: " + compared.id;
    if (compared.verdict == Verdict::missing) tip = "Only in the baseline: " + compared.id;
    for (const ConditionDifference& difference : compared.conditions) tip += '\n' + difference.what;
    const std::string label = fmt::format("{}###{}", cells.front(), compared.id);
    if (ui.selectable(label.c_str(), false, tip.c_str())) openCompared(compared.id);
    for (const std::size_t column : std::span(kComparisonColumns).subspan(1)) {
      ui.cell(cells[column], column == kVerdictColumn ? rgb : ui.theme.text);
    }
  }

  void openCompared(const std::string& id) {
    std::vector<Row>& rows = session.results->rows();
    const auto row = std::ranges::find(rows, id, [](const Row& of) { return of.result.id; });
    if (row != rows.end()) session.openCase(*row);
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
      const std::optional<Rgb> rgb = colourOf(row, column->key);
      if (column == columns_.front()) {
        ImGui::TableNextColumn();
        drawOpenCell(row, curve ? curve : rgb, first);
      } else {
        ui.cell(textOf(row, *column), rgb.value_or(ui.theme.text));
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

  /// Columns of comparisonTable(): the verdict beside the case.
  static constexpr std::size_t kVerdictColumn = 5;
  static constexpr std::array<std::size_t, 6> kComparisonColumns{0, kVerdictColumn, 3, 4, 1, 2};

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
