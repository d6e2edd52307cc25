// Colours and sizes of all widgets.

#include "inspector/ui/ui.h"

namespace broadmark {
namespace {

/// The colours that differ between light and dark.
struct Palette {
  Rgb window, panel, input, hover, border, text, faint, accent, header;
  Rgb pressed;  ///< behind text
  Rgb fill;     ///< behind white text
};
constexpr Palette kDark = {0x17191D, 0x1E2126, 0x2A2E35, 0x363C46, 0x343941, 0xE4E7EB,
                           0xA3ACB8, 0x7FB2FF, 0x2C313A, 0x29549B, 0x2F6BD0};
constexpr Palette kLight = {0xE9ECF0, 0xF7F8FA, 0xFFFFFF, 0xDCE4EE, 0xCBD2DA, 0x1C232B,
                            0x565F6A, 0x1558C0, 0xDDE3EA, 0xA9C8FA, 0x1F6FEB};

/// What each of Dear ImGui's colours is.
struct ColourUse {
  ImGuiCol_ which;
  Rgb Palette::*source;
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
    colours[use.which] = colourVector(palette.*use.source, use.alpha);
  }
  colours[ImGuiCol_ModalWindowDimBg] = colourVector(0x000000, 0.45F);
}

}  // namespace

ImVec4 colourVector(Rgb rgb, float alpha) {
  const auto component = [&](int shift) {
    return static_cast<float>((rgb >> shift) & 0xFFU) / 255.0F;
  };
  return {component(16), component(8), component(0), alpha};
}

ImU32 colour(Rgb rgb, float alpha) {
  return ImGui::ColorConvertFloat4ToU32(colourVector(rgb, alpha));
}

void applyTheme(Ui& ui, bool dark, float scale) {
  const Palette& palette = dark ? kDark : kLight;
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
  setColours(palette);
  ui.scale = scale;
  ui.theme = {.dark = dark,
              .accent = palette.accent,
              .fill = palette.fill,
              .good = dark ? 0x5BC77AU : 0x146B2EU,
              .bad = dark ? 0xFF8080U : 0xB4232CU,
              .warning = dark ? 0xF2B84BU : 0x7A5200U,
              .first = dark ? 0x6FB4F5U : 0x1B5FA8U,
              .second = dark ? 0xC79BEEU : 0x7D3FB0U,
              .faint = palette.faint,
              .background = dark ? 0x202329U : 0xF5F6F8U};
}

}  // namespace broadmark
