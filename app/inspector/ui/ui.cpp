#include "inspector/ui/ui.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "broadmark/statistics/statistics.h"

namespace broadmark {
namespace {

/// Width of an input as a share of its panel; the label gets the rest.
constexpr float kInputShare = 0.52F;
constexpr float kMinInputShare = 0.28F;  // beside a long label
constexpr float kTooltipDelay = 0.45F;   // seconds
constexpr std::size_t kBins = 48;        // of a histogram

/// Returns the name in a label: "Add" in "Add##popup", "speed" in "##speed" or "Pause###speed".
std::string_view nameOf(std::string_view label) {
  if (const std::size_t constant = label.find("###"); constant != label.npos) {
    return label.substr(constant + 3);
  }
  const std::size_t split = label.find("##");
  if (split == 0) return label.substr(2);
  return label.substr(0, split);
}

/// Width that an input's label leaves on the line.
float roomBeside(const char* label) {
  return ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(label, nullptr, true).x -
         ImGui::GetStyle().ItemInnerSpacing.x;
}

/// Width of an input with this label.
float usualInputWidth(const char* label) {
  const float available = ImGui::GetContentRegionAvail().x;
  return std::clamp(roomBeside(label), kMinInputShare * available, kInputShare * available);
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
  if (!copied_.empty()) ImGui::SetClipboardText(copied_.c_str());
  copied_.clear();
  former_plots_ = std::exchange(plots_, {});
  svg_of_ = std::exchange(svg_requested_, {});
  svg_.clear();
  copies_tables_ = std::exchange(copy_requested_, false);
  has_tables_ = std::exchange(begins_tables_, false);
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
  const float right = rect.Max.x;
  if (visible) rect.ClipWithFull(ImGui::GetCurrentWindowRead()->ClipRect);
  const bool disabled = (ImGui::GetItemFlags() & ImGuiItemFlags_Disabled) != 0;
  places_[name] = {.min = rect.Min,
                   .max = rect.Max,
                   .enabled = !disabled,
                   .visible = visible && rect.GetWidth() >= 1 && rect.GetHeight() >= 1,
                   .cut = visible && GImGui->CurrentTable == nullptr &&
                          right > rect.Max.x + ImGui::GetStyle().ItemSpacing.x};
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

void Ui::setInputWidth(const char* label) { ImGui::SetNextItemWidth(usualInputWidth(label)); }

void Ui::setListWidth(const char* label, const char* shown) {
  const float needed = buttonWidth(shown) + ImGui::GetFrameHeight();
  ImGui::SetNextItemWidth(std::max(usualInputWidth(label), std::min(needed, roomBeside(label))));
}

float Ui::buttonWidth(const char* label) {
  return ImGui::CalcTextSize(label, nullptr, true).x + 2 * ImGui::GetStyle().FramePadding.x;
}

bool Ui::registered(bool acted, const char* label, const char* tip) {
  note(label);
  tooltip(tip);
  return acted;
}

bool Ui::button(const char* label, const char* tip, float width, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = registered(ImGui::Button(label, {width, 0}), label, tip);
  if (buttonWidth(label) > ImGui::GetItemRectSize().x + 1) places_[fullName(label)].cut = true;
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
  const char* shown = chosen < options.size() ? options[chosen].c_str() : "";
  if (width > 0) {
    ImGui::SetNextItemWidth(width);
  } else {
    setListWidth(label, shown);
  }
  const float room =
      ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - 2 * ImGui::GetStyle().FramePadding.x;
  const std::string preview = fittingText(shown, room);
  const bool open = ImGui::BeginCombo(label, preview.c_str(), ImGuiComboFlags_HeightLarge);
  note(label);
  if (!open) {
    const bool is_whole = preview == shown || tip == nullptr;
    tooltip(is_whole ? tip : fmt::format("{}\n{}", shown, tip).c_str());
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
  copyCell(label);
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

bool Ui::menuItem(const char* label, const char* shortcut, bool selected, bool enabled) {
  return registered(ImGui::MenuItem(label, shortcut, selected, enabled), label);
}

bool Ui::beginMenu(const char* label, bool enabled) {
  const bool open = ImGui::BeginMenu(label, enabled);
  // Inside the menu, the last item is not its title.
  if (!open) note(label);
  return open;
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
  PlotCanvas draw(ui.beginPlot("histogram"));
  const auto max_count = static_cast<float>(*std::ranges::max_element(histogram.counts));
  const float width = size.x / static_cast<float>(kBins);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const float left = corner.x + width * static_cast<float>(bin);
    const float height = size.y * static_cast<float>(histogram.counts[bin]) / max_count;
    draw.filledRect({left, bottom - height}, {left + width - 1, bottom}, colour(ui.theme.accent));
  }
  if (line && histogram.low < *line && *line < histogram.high) {
    const double share = (*line - histogram.low) / (histogram.high - histogram.low);
    const float x = corner.x + size.x * static_cast<float>(share);
    draw.line({x, corner.y}, {x, bottom}, colour(ui.theme.warning), 2 * ui.scale);
  }
  const auto label = [&](double value, float share) {
    const std::string number = text(value);
    const float extent = ImGui::CalcTextSize(number.c_str()).x;
    draw.text({corner.x + share * (size.x - extent), bottom}, colour(ui.theme.faint), number);
    return extent;
  };
  const float ends = label(histogram.low, 0) + label(histogram.high, 1);
  if (size.x > 2 * ends) label((histogram.low + histogram.high) / 2, 0.5F);
  ImGui::Dummy({size.x, std::max(ImGui::GetContentRegionAvail().y, size.y)});
  ui.endPlot("histogram");
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
