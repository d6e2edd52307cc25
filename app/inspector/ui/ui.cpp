#include "inspector/ui/ui.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <type_traits>

#include "broadmark/statistics/statistics.h"
#include "inspector/ui/terms.h"

namespace broadmark {
namespace {

/// Width of an input as a share of its panel; the label gets the rest.
constexpr float kInputShare = 0.52F;
constexpr float kVectorShare = 0.7F;      // of the width, for three numbers in a row
constexpr float kTooltipDelay = 0.45F;    // seconds
constexpr std::size_t kBins = 48;         // of a histogram
constexpr std::size_t kShortHeading = 9;  // characters; a longer one gets two lines

/// Returns the name in a label: "Add" in "Add##popup", "speed" in "##speed" or "Pause###speed".
std::string_view nameOf(std::string_view label) {
  if (const std::size_t constant = label.find("###"); constant != label.npos) {
    return label.substr(constant + 3);
  }
  const std::size_t split = label.find("##");
  if (split == 0) return label.substr(2);
  return label.substr(0, split);
}

/// Places the tooltip of the last item beside its window or, if that is wide, above the item: below
/// the mouse it would hide the next widget.
void placeTooltip() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const ImVec2 item = ImGui::GetItemRectMin();
  const ImRect window = ImGui::GetCurrentWindowRead()->RootWindow->Rect();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  if (window.GetWidth() > 0.45F * screen.x || window.GetWidth() < 1) {
    ImGui::SetNextWindowPos({item.x, item.y - gap}, ImGuiCond_Always, {0, 1});
  } else if (window.GetCenter().x < screen.x / 2) {
    ImGui::SetNextWindowPos({window.Max.x + gap, item.y});
  } else {
    ImGui::SetNextWindowPos({window.Min.x - gap, item.y}, ImGuiCond_Always, {1, 0});
  }
}

}  // namespace

std::string fittingText(std::string text, float max_width, ImFont* font) {
  if (font == nullptr) font = ImGui::GetFont();
  const auto width = [&](const std::string& line) {
    return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, line.c_str()).x;
  };
  if (width(text) <= max_width) return text;
  while (!text.empty() && width(text + "…") > max_width) {
    while (text.size() > 1 && (text.back() & 0xC0) == 0x80) text.pop_back();  // UTF-8
    text.pop_back();
  }
  return text + "…";
}

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

Ui::Scope::Scope(Ui& ui, std::string_view name) : ui_(&ui), length_(ui.scope_.size()) {
  ui.scope_ += name;
  ui.scope_ += '/';
}

Ui::Scope::~Scope() { ui_->scope_.resize(length_); }

bool Ui::inDialog() {
  const ImVector<ImGuiPopupData>& popups = GImGui->OpenPopupStack;
  return !popups.empty() && popups.back().Window != nullptr &&
         (popups.back().Window->Flags & ImGuiWindowFlags_Modal) != 0;
}

void Ui::beforePicture() {
  const ImVector<ImGuiPopupData>& popups = GImGui->OpenPopupStack;
  escape_consumed_ = (!popups.empty() && !inDialog()) || ImGui::GetIO().WantTextInput;
}

void Ui::begin() {
  places_.clear();
  focus_.clear();
  const bool pressed = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
  escaped_ = pressed && !escape_consumed_;
  const ImVector<ImGuiPopupData>& popups = GImGui->OpenPopupStack;
  if (pressed && escape_consumed_ && !popups.empty() && !inDialog()) {
    ImGui::ClosePopupToLevel(popups.Size - 1, true);
  }
}

bool Ui::entered() {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false) ||
         ImGui::IsKeyPressed(static_cast<ImGuiKey>(GLFW_KEY_KP_ENTER), false);
}

std::string Ui::fullName(std::string_view label) const {
  return scope_ + std::string(nameOf(label));
}

void Ui::note(std::string_view label) {
  glyphs.request(label);
  const std::string name = fullName(label);
  if (name == revealed_) {
    ImGui::SetScrollHereY();
    revealed_.clear();
  }
  if (ImGui::IsItemFocused() && !GImGui->NavDisableHighlight) focus_ = name;
  // Only the visible part of a widget can be pressed.
  ImRect rect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const bool visible = ImGui::IsItemVisible();
  if (visible) rect.ClipWithFull(ImGui::GetCurrentWindowRead()->ClipRect);
  const bool disabled = (ImGui::GetItemFlags() & ImGuiItemFlags_Disabled) != 0;
  places_[name] = {.min = rect.Min,
                   .max = rect.Max,
                   .enabled = !disabled,
                   .visible = visible && rect.GetWidth() >= 1 && rect.GetHeight() >= 1};
}

void Ui::noteAt(std::string_view name, ImVec2 min, ImVec2 max) {
  places_[fullName(name)] = {.min = min, .max = max};
}

const WidgetPlace* Ui::find(const std::string& name) const {
  const auto found = places_.find(name);
  return found == places_.end() ? nullptr : &found->second;
}

void Ui::tooltip(const char* text) {
  if (text == nullptr || *text == '\0') return;
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  if (GImGui->HoveredIdTimer < kTooltipDelay) return;
  placeTooltip();
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void Ui::setInputWidth() const {
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * kInputShare);
}

bool Ui::registered(bool acted, const char* label, const char* tip) {
  note(label);
  tooltip(tip);
  return acted;
}

bool Ui::button(const char* label, const char* tip, float width, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = registered(ImGui::Button(label, {width, 0}), label, tip);
  ImGui::EndDisabled();
  return pressed;
}

bool Ui::toggle(const char* label, bool& on, const char* tip, float width) {
  const bool was_on = on;
  if (was_on) {
    ImGui::PushStyleColor(ImGuiCol_Button, colourVector(theme.fill));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colourVector(theme.fill));
    ImGui::PushStyleColor(ImGuiCol_Text, colourVector(theme.fill_text));
  }
  const bool pressed = button(label, tip, width);
  if (was_on) ImGui::PopStyleColor(3);
  if (pressed) on = !on;
  return pressed;
}

bool Ui::checkbox(const char* label, bool& value, const char* tip, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = registered(ImGui::Checkbox(label, &value), label, tip);
  ImGui::EndDisabled();
  return pressed;
}

bool Ui::combo(const char* label, std::size_t& chosen, const std::vector<std::string>& options,
               const char* tip, float width) {
  if (width > 0) {
    ImGui::SetNextItemWidth(width);
  } else {
    setInputWidth();
  }
  const char* shown = chosen < options.size() ? options[chosen].c_str() : "";
  const bool open = ImGui::BeginCombo(label, shown, ImGuiComboFlags_HeightLarge);
  note(label);
  if (!open) {
    tooltip(tip);
    return false;
  }
  bool changed = false;
  const Scope inside = scope(nameOf(label));
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (ImGui::Selectable(options[i].c_str(), i == chosen)) {
      changed = i != chosen;
      chosen = i;
    }
    note(options[i]);
    if (i == chosen) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return changed;
}

bool Ui::selectable(const char* label, bool selected, const char* tip, std::optional<Rgb> rgb) {
  const bool in_table = GImGui->CurrentTable != nullptr;
  ImGui::PushStyleColor(ImGuiCol_Text, colourVector(rgb.value_or(theme.text)));
  const bool pressed =
      ImGui::Selectable(label, selected, in_table ? ImGuiSelectableFlags_SpanAllColumns : 0);
  ImGui::PopStyleColor();
  return registered(pressed, label, tip);
}

bool Ui::selectableLine(const char* label, bool selected, std::string_view right, Rgb right_colour,
                        const char* tip) {
  const std::string shown = fittingText(label, widthBefore(right));
  ImGui::PushID(label);
  const bool pressed = ImGui::Selectable(fmt::format("{}##row", shown).c_str(), selected,
                                         ImGuiSelectableFlags_AllowDoubleClick);
  ImGui::PopID();
  note(label);
  tooltip(tip == nullptr && shown != label ? label : tip);
  rightAligned(right, right_colour);
  return pressed;
}

bool Ui::text(const char* label, std::string& value, const char* hint) {
  setInputWidth();
  glyphs.request(value);
  ImGui::InputTextWithHint(label, hint, &value);
  note(label);
  return ImGui::IsItemDeactivatedAfterEdit();
}

template <class Number>
bool Ui::inputNumber(const char* label, std::string_view name, Number& value, Number min,
                     Number max, const char* tip) {
  constexpr bool kWhole = std::is_integral_v<Number>;
  Number entered = value;
  ImGui::InputScalar(label, kWhole ? ImGuiDataType_S64 : ImGuiDataType_Double, &entered, nullptr,
                     nullptr, kWhole ? "%lld" : "%.6g");
  note(name);
  tooltip(tip);
  // A number may be out of range while it is typed.
  if (ImGui::IsItemActive()) {
    value = entered;
    return false;
  }
  const bool in_range = value >= min && value <= max;  // false for NaN
  const bool changed = ImGui::IsItemDeactivatedAfterEdit() || !in_range;
  if (!changed) return false;
  value = entered >= min ? std::min(entered, max) : min;
  if (value != entered && on_correction) {
    on_correction(
        fmt::format("{}: {} is out of range {} to {}; using {}", name, entered, min, max, value));
  }
  return true;
}

bool Ui::integer(const char* label, std::int64_t& value, std::int64_t min, std::int64_t max,
                 const char* tip) {
  setInputWidth();
  return inputNumber(label, label, value, min, max, tip);
}

bool Ui::number(const char* label, double& value, double min, double max, const char* tip) {
  setInputWidth();
  return inputNumber(label, label, value, min, max, tip);
}

bool Ui::entry(const char* name, double& value, double min, double max, const char* tip) {
  return inputNumber(fmt::format("##{}", name).c_str(), name, value, min, max, tip);
}

bool Ui::vector(const char* label, std::array<double, 3>& value, double min, double max,
                const char* tip) {
  constexpr const char* kComponents[] = {"x", "y", "z"};
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x / 2;
  // Three numbers are wider than other inputs.
  const float width = std::floor((ImGui::GetContentRegionAvail().x * kVectorShare - 2 * gap) / 3);
  bool changed = false;
  ImGui::PushID(label);
  for (std::size_t axis = 0; axis < value.size(); ++axis) {
    if (axis > 0) ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(std::max(width, 1.0F));
    changed |=
        inputNumber(fmt::format("##{}", kComponents[axis]).c_str(),
                    fmt::format("{} {}", label, kComponents[axis]), value[axis], min, max, tip);
  }
  ImGui::PopID();
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::TextUnformatted(label);
  return changed;
}

bool Ui::slider(const char* label, int& value, int min, int max) {
  // SliderInt's grab is as wide as a step: with few steps it would fill half the slider.
  auto real = static_cast<float>(value);
  const bool changed =
      ImGui::SliderFloat(label, &real, static_cast<float>(min), static_cast<float>(max), "",
                         ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat);
  value = static_cast<int>(std::lround(real));
  note(label);
  return changed;
}

bool Ui::menuItem(const char* label, const char* shortcut, bool selected, bool enabled) {
  return registered(ImGui::MenuItem(label, shortcut, selected, enabled), label);
}

bool Ui::beginMenu(const char* label, bool enabled) {
  const bool open = ImGui::BeginMenu(label, enabled);
  // Inside the menu, the last item is not its title.
  if (!open) note(label);
  return open;
}

bool Ui::parameter(const Parameter& parameter) {
  const std::string name(parameter.name);
  const std::string tip = fmt::format("{}\n{}", parameter.doc, parameterRange(parameter));
  if (bool* const* flag = std::get_if<bool*>(&parameter.value)) {
    return checkbox(name.c_str(), **flag, tip.c_str());
  }
  const auto with_unit = [&](bool changed) {
    const std::string_view unit = parameterUnit(parameter);
    if (unit.empty()) return changed;
    ImGui::SameLine();
    // Without room for the unit, only the tooltip shows it.
    const ImVec2 extent = ImGui::CalcTextSize(unit.data(), unit.data() + unit.size());
    if (ImGui::GetContentRegionAvail().x >= extent.x) {
      faint(unit);
    } else {
      ImGui::NewLine();
    }
    return changed;
  };
  if (std::int64_t* const* whole = std::get_if<std::int64_t*>(&parameter.value)) {
    return with_unit(integer(name.c_str(), **whole, static_cast<std::int64_t>(parameter.min),
                             static_cast<std::int64_t>(std::min(parameter.max, 9.2e18)),
                             tip.c_str()));
  }
  if (double* const* real = std::get_if<double*>(&parameter.value)) {
    return with_unit(number(name.c_str(), **real, parameter.min, parameter.max, tip.c_str()));
  }
  if (Choice* const* choice = std::get_if<Choice*>(&parameter.value)) {
    const auto& options = (*choice)->options;
    auto chosen =
        static_cast<std::size_t>(std::ranges::find(options, (*choice)->value) - options.begin());
    if (!combo(name.c_str(), chosen, options, tip.c_str())) return false;
    (*choice)->value = options[chosen];
    return true;
  }
  const bool changed = text(name.c_str(), *std::get<std::string*>(parameter.value));
  tooltip(tip.c_str());
  return changed;
}

bool Ui::parameters(Parametrised& object) {
  bool changed = false;
  object.visitParameters([&](const Parameter& p) { changed |= parameter(p); });
  return changed;
}

void Ui::placeInMiddle(ImVec2 size) const {
  const float margin = 16;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSize(
      {std::min(size.x * scale, screen.x - margin), std::min(size.y * scale, screen.y - margin)});
}

bool Ui::beginDialog(const char* title, ImVec2 size, bool* open) {
  placeInMiddle(size);
  return ImGui::BeginPopupModal(title, open, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
}

std::optional<std::size_t> Ui::ask(
    const char* title, std::string_view text,
    std::initializer_list<std::pair<const char*, const char*>> answers) {
  if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  if (!beginDialog(title, {420, 0})) return {};
  paragraph(text);
  ImGui::Spacing();
  const float width = 84 * scale;
  std::optional<std::size_t> pressed;
  std::size_t index = 0;
  for (const auto& [answer, tip] : answers) {
    if (button(answer, tip, width)) pressed = index;
    ImGui::SameLine();
    ++index;
  }
  if (cancel(width)) pressed = index;
  if (pressed) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return pressed;
}

bool Ui::cancel(float width) {
  const bool pressed = button("Cancel", nullptr, width);
  return pressed || escaped();
}

void Ui::sameLineIfFits(float width) {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) {
    ImGui::SameLine();
  }
}

float Ui::widthBefore(std::string_view right) {
  return ImGui::GetContentRegionAvail().x -
         ImGui::CalcTextSize(right.data(), right.data() + right.size()).x -
         ImGui::GetStyle().ItemSpacing.x;
}

void Ui::rightAligned(std::string_view words, Rgb rgb) {
  ImGui::SameLine(ImGui::GetContentRegionMax().x -
                  ImGui::CalcTextSize(words.data(), words.data() + words.size()).x);
  coloured(rgb, words);
}

void Ui::line(std::string_view left, std::string_view right, Rgb right_colour) {
  const std::string shown = fittingText(std::string(left), widthBefore(right));
  plain(shown);
  if (shown != left) tooltip(std::string(left).c_str());
  rightAligned(right, right_colour);
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
  ImGui::TableSetupScrollFreeze(1, 1);
  for (const std::string& column : columns) ImGui::TableSetupColumn(column.c_str());
  headings(columns);
  return true;
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
  coloured(rgb, words);
}

void Ui::valueRow(const char* name, std::string_view value) {
  faint(name);
  ImGui::SameLine(ImGui::GetContentRegionMax().x * 0.45F);
  plain(value);
}

void Ui::plain(std::string_view words) {
  glyphs.request(words);
  ImGui::TextUnformatted(words.data(), words.data() + words.size());
}

void Ui::faint(std::string_view words) { coloured(theme.faint, words); }

void Ui::coloured(Rgb rgb, std::string_view words) {
  ImGui::PushStyleColor(ImGuiCol_Text, colourVector(rgb));
  plain(words);
  ImGui::PopStyleColor();
}

void Ui::heading(const char* words) {
  ImGui::Dummy({0, ImGui::GetStyle().ItemSpacing.y / 2});
  faint(words);
  ImGui::Separator();
}

void Ui::paragraph(std::string_view words, Rgb rgb) {
  ImGui::PushTextWrapPos(0);
  coloured(rgb, words);
  ImGui::PopTextWrapPos();
}

void drawHistogram(Ui& ui, std::span<const double> values,
                   const std::function<std::string(double)>& text, std::optional<double> line) {
  if (values.empty()) return;
  const Histogram histogram = histogramOf(values, kBins);
  if (histogram.counts.empty()) return;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float line_height = ImGui::GetTextLineHeight();
  const ImVec2 size = {ImGui::GetContentRegionAvail().x,
                       std::max(ImGui::GetContentRegionAvail().y - line_height, line_height)};
  const float bottom = corner.y + size.y;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto max_count = static_cast<float>(*std::ranges::max_element(histogram.counts));
  const float width = size.x / static_cast<float>(kBins);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const float left = corner.x + width * static_cast<float>(bin);
    const float height = size.y * static_cast<float>(histogram.counts[bin]) / max_count;
    draw.AddRectFilled({left, bottom - height}, {left + width - 1, bottom},
                       colour(ui.theme.accent));
  }
  if (line && histogram.low < *line && *line < histogram.high) {
    const double share = (*line - histogram.low) / (histogram.high - histogram.low);
    const float x = corner.x + size.x * static_cast<float>(share);
    draw.AddLine({x, corner.y}, {x, bottom}, colour(ui.theme.warning), 2 * ui.scale);
  }
  const auto label = [&](double value, float share) {
    const std::string number = text(value);
    const float extent = ImGui::CalcTextSize(number.c_str()).x;
    draw.AddText({corner.x + share * (size.x - extent), bottom}, colour(ui.theme.faint),
                 number.c_str());
    return extent;
  };
  const float ends = label(histogram.low, 0) + label(histogram.high, 1);
  if (size.x > 2 * ends) label((histogram.low + histogram.high) / 2, 0.5F);
  ImGui::Dummy(size);
  ui.note("histogram");
}

void beginAt(const char* id, ImVec2 position, ImVec2 size, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(position);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin(id, nullptr,
               flags | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
}

bool SplitPane::both() const { return ImGui::GetContentRegionAvail().x >= min_width; }

void SplitPane::draw(const std::function<void()>& first,
                     const std::function<void()>& second) const {
  const bool both = this->both();
  const float width = ImGui::GetContentRegionAvail().x;
  const auto part = [](const char* id, float extent, const std::function<void()>& draw_part) {
    ImGui::BeginChild(id, {extent, 0}, false, ImGuiWindowFlags_NavFlattened);
    draw_part();
    ImGui::EndChild();
  };
  if (both || !second_only) part("first", both ? share * width : 0, first);
  if (both) ImGui::SameLine();
  if (both || second_only) part("second", 0, second);
}

}  // namespace broadmark
