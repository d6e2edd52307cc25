// Colours and sizes of all widgets.

#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>

#include "inspector/ui/ui.h"

namespace broadmark {
namespace {

/// The palette's source of a Dear ImGui colour.
struct ColourUse {
  ImGuiCol_ target;
  Rgb Palette::* source;
  float alpha = 1;
};
constexpr ColourUse kColourUses[] = {
    {ImGuiCol_Text, &Palette::text},
    {ImGuiCol_TextDisabled, &Palette::faint},
    {ImGuiCol_WindowBg, &Palette::panel},
    {ImGuiCol_ChildBg, &Palette::panel, 0},
    {ImGuiCol_PopupBg, &Palette::panel},
    {ImGuiCol_Border, &Palette::border},
    {ImGuiCol_BorderShadow, &Palette::border, 0},
    {ImGuiCol_FrameBg, &Palette::input},
    {ImGuiCol_FrameBgHovered, &Palette::hover},
    {ImGuiCol_FrameBgActive, &Palette::hover},
    {ImGuiCol_TitleBg, &Palette::window},
    {ImGuiCol_TitleBgActive, &Palette::header},
    {ImGuiCol_TitleBgCollapsed, &Palette::window},
    {ImGuiCol_MenuBarBg, &Palette::window},
    {ImGuiCol_ScrollbarBg, &Palette::panel, 0},
    {ImGuiCol_ScrollbarGrab, &Palette::border},
    {ImGuiCol_ScrollbarGrabHovered, &Palette::faint},
    {ImGuiCol_ScrollbarGrabActive, &Palette::faint},
    {ImGuiCol_CheckMark, &Palette::accent},
    {ImGuiCol_SliderGrab, &Palette::accent},
    {ImGuiCol_SliderGrabActive, &Palette::accent},
    {ImGuiCol_Button, &Palette::input},
    {ImGuiCol_ButtonHovered, &Palette::hover},
    {ImGuiCol_ButtonActive, &Palette::pressed},
    {ImGuiCol_Header, &Palette::header},
    {ImGuiCol_HeaderHovered, &Palette::hover},
    {ImGuiCol_HeaderActive, &Palette::pressed},
    {ImGuiCol_Separator, &Palette::border},
    {ImGuiCol_SeparatorHovered, &Palette::accent},
    {ImGuiCol_SeparatorActive, &Palette::accent},
    {ImGuiCol_ResizeGrip, &Palette::border},
    {ImGuiCol_ResizeGripHovered, &Palette::accent},
    {ImGuiCol_ResizeGripActive, &Palette::accent},
    {ImGuiCol_Tab, &Palette::window},
    {ImGuiCol_TabHovered, &Palette::hover},
    {ImGuiCol_TabActive, &Palette::header},
    {ImGuiCol_TabUnfocused, &Palette::window},
    {ImGuiCol_TabUnfocusedActive, &Palette::header},
    {ImGuiCol_TableHeaderBg, &Palette::header},
    {ImGuiCol_TableBorderStrong, &Palette::border},
    {ImGuiCol_TableBorderLight, &Palette::border, 0.6F},
    {ImGuiCol_TableRowBg, &Palette::panel, 0},
    {ImGuiCol_TableRowBgAlt, &Palette::text, 0.025F},
    {ImGuiCol_TextSelectedBg, &Palette::accent, 0.4F},
    {ImGuiCol_NavHighlight, &Palette::accent},
};

void setColours(const Palette& palette) {
  ImVec4* colours = ImGui::GetStyle().Colors;
  for (const ColourUse& use : kColourUses) {
    colours[use.target] = colourVector(palette.*use.source, use.alpha);
  }
  colours[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.45F};
}

}  // namespace

ImVec4 colourVector(Rgb rgb, float alpha) {
  const std::array all = components(rgb);
  return {all[0], all[1], all[2], alpha};
}

ImU32 colour(Rgb rgb, float alpha) {
  return ImGui::ColorConvertFloat4ToU32(colourVector(rgb, alpha));
}

std::vector<Rgb> curveColours(std::span<const std::string_view> algorithms,
                              const Palette& palette) {
  std::vector<Rgb> colours(algorithms.size());
  std::vector<std::size_t> others;
  std::array<bool, std::tuple_size_v<decltype(Palette::curve)>> used{};
  for (std::size_t i = 0; i < algorithms.size(); ++i) {
    std::string_view algorithm = algorithms[i];
    if (algorithm.ends_with("-mt")) algorithm.remove_suffix(3);
    const auto* const own = std::ranges::find(kAlgorithmCurves, algorithm,
                                              [](const auto& entry) { return entry.first; });
    if (own == std::end(kAlgorithmCurves) || used[own->second]) {
      others.push_back(i);
    } else {
      used[own->second] = true;
      colours[i] = palette.curve[own->second];
    }
  }
  for (const std::size_t i : others) {
    if (std::ranges::count(used, false) == 0) used = {};  // all used: repeat them
    bool* const unused = std::ranges::find(used, false);
    *unused = true;
    colours[i] = palette.curve[static_cast<std::size_t>(unused - used.begin())];
  }
  return colours;
}

void applyTheme(Ui& ui, bool dark, float scale) {
  ImGuiStyle style;
  style.WindowPadding = {10, 8};
  style.FramePadding = {7, 3};
  style.ItemSpacing = {7, 5};
  style.ItemInnerSpacing = {6, 4};
  style.CellPadding = {6, 3};
  style.ScrollbarSize = 11;
  style.GrabMinSize = 9;
  style.WindowRounding = 0;
  style.ChildRounding = 0;
  style.FrameRounding = 4;
  style.PopupRounding = 5;
  style.ScrollbarRounding = 6;
  style.GrabRounding = 4;
  style.TabRounding = 4;
  style.WindowBorderSize = 0;
  style.PopupBorderSize = 1;
  style.FrameBorderSize = dark ? 0 : 1;
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
  ui.scale = scale;
  ui.theme = paletteOf(dark);
  setColours(ui.theme);
}

}  // namespace broadmark
