// Tables with headings that explain and sort.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "inspector/ui/terms.h"
#include "inspector/ui/ui.h"

namespace broadmark {
namespace {

constexpr std::size_t kShortHeading = 9;  // characters; a longer one gets two lines

/// Whether a column has marks instead of values; such columns come first.
bool isMark(std::string_view column) { return column.starts_with("##"); }

}  // namespace

float widthOfWholeColumns(const char* table, int always) {
  const float available = ImGui::GetContentRegionAvail().x;
  const ImGuiTable* const last = ImGui::TableFindByID(ImGui::GetID(table));
  if (last == nullptr) return available;
  float whole = last->InnerWindow->ScrollbarY ? ImGui::GetStyle().ScrollbarSize : 0;
  for (int column = 0; column < last->ColumnsCount; ++column) {
    const float width = last->Columns[column].MaxX - last->Columns[column].MinX;
    if (column >= always && whole + width > available) return whole;
    whole += width;
  }
  return available;
}

bool Ui::beginTable(const char* name, const std::vector<std::string>& columns, int always,
                    float height) {
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                     ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                     ImGuiTableFlags_ScrollY | ImGuiTableFlags_Sortable |
                                     ImGuiTableFlags_SortTristate;
  if (!ImGui::BeginTable(name, static_cast<int>(columns.size()), kFlags,
                         {widthOfWholeColumns(name, always), height})) {
    return false;
  }
  const auto marks = static_cast<int>(std::ranges::count_if(columns, isMark));
  ImGui::TableSetupScrollFreeze(marks + 1, 1);
  for (const std::string& column : columns) {
    ImGui::TableSetupColumn(column.c_str(), isMark(column) ? ImGuiTableColumnFlags_NoSort : 0);
  }
  headings(columns);
  begins_tables_ = in_table_ = true;
  copied_row_ = 0;
  if (copies_tables_) {
    const auto named = std::span(columns).subspan(static_cast<std::size_t>(marks));
    copied_ += fmt::format("{}{}", copied_.empty() ? "" : "\n", fmt::join(named, "\t"));
  }
  return true;
}

void Ui::endTable() {
  ImGui::EndTable();
  in_table_ = false;
  if (copies_tables_) copied_ += '\n';
}

void Ui::copyCell(std::string_view text) {
  if (!copies_tables_ || !in_table_) return;
  const int row = ImGui::TableGetRowIndex();
  copied_ += std::exchange(copied_row_, row) == row ? '\t' : '\n';
  copied_ += text.substr(0, text.find("##"));
}

void Ui::headings(const std::vector<std::string>& names) {
  const auto inside = scope("by");
  // In two lines, because the numbers below are shorter.
  std::vector<std::string> labels = names;
  float height = 0;
  for (std::string& label : labels) {
    const std::size_t gap = label.size() < kShortHeading ? label.npos : label.find_last_of(" _");
    if (gap != label.npos) label[gap] = '\n';
    height = std::max(height, ImGui::CalcTextSize(label.c_str()).y);
  }
  // The same height whichever columns are visible: the rows must not move when one is scrolled.
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers, height + 2 * ImGui::GetStyle().CellPadding.y);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!ImGui::TableSetColumnIndex(static_cast<int>(i))) continue;
    ImGui::TableHeader(fmt::format("{}###{}", labels[i], names[i]).c_str());
    note(names[i]);
    tooltip(termDoc(names[i]));
  }
}

std::vector<std::size_t> Ui::sortedRows(
    std::size_t count, const std::function<SortKey(std::size_t row, std::size_t column)>& key) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  const ImGuiTableSortSpecs* const specs = ImGui::TableGetSortSpecs();
  if (specs == nullptr || specs->SpecsCount == 0) return rows;
  const ImGuiTableColumnSortSpecs& by = specs->Specs[0];
  const auto key_of = [&](std::size_t row) {
    return key(row, static_cast<std::size_t>(by.ColumnIndex));
  };
  if (by.SortDirection == ImGuiSortDirection_Descending) {
    std::ranges::stable_sort(rows, std::ranges::greater(), key_of);
  } else {
    std::ranges::stable_sort(rows, {}, key_of);
  }
  return rows;
}

void Ui::cell(std::string_view words) { cell(words, theme.text); }

void Ui::cell(std::string_view words, Rgb rgb) {
  ImGui::TableNextColumn();
  copyCell(words);
  coloured(rgb, words);
}

void Ui::valueRow(const char* name, std::string_view value) {
  faint(name);
  ImGui::SameLine(ImGui::GetContentRegionMax().x * 0.45F);
  plain(value);
}

}  // namespace broadmark
