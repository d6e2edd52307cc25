// Texts are readable, and curves are distinguishable.
#include <gtest/gtest.h>
#include <imgui.h>

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "inspector/ui/ui.h"
#include "support/colour_vision.h"

namespace broadmark::tests {
namespace {

constexpr double kReadable = 4.5;  // WCAG 2, level AA, for text of normal size

class ThemeTest : public testing::TestWithParam<bool> {
 protected:
  ThemeTest() : context(ImGui::CreateContext()) { applyTheme(ui, GetParam(), 1); }
  ~ThemeTest() override { ImGui::DestroyContext(context); }

  static Rgb styleColour(ImGuiCol_ which) {
    const ImVec4& colour = ImGui::GetStyle().Colors[which];
    const auto channel = [](float value) { return static_cast<Rgb>(std::lround(255 * value)); };
    return channel(colour.x) << 16 | channel(colour.y) << 8 | channel(colour.z);
  }

  ImGuiContext* context;
  Ui ui;
};

/// The opaque backgrounds of text.
constexpr std::array kGrounds = {
    ImGuiCol_WindowBg,       ImGuiCol_PopupBg,       ImGuiCol_MenuBarBg,     ImGuiCol_FrameBg,
    ImGuiCol_FrameBgHovered, ImGuiCol_Button,        ImGuiCol_ButtonHovered, ImGuiCol_Header,
    ImGuiCol_HeaderHovered,  ImGuiCol_Tab,           ImGuiCol_TabActive,     ImGuiCol_TabHovered,
    ImGuiCol_TitleBg,        ImGuiCol_TitleBgActive, ImGuiCol_TableHeaderBg};

TEST_P(ThemeTest, EveryTextCanBeReadOnEveryGround) {
  for (const ImGuiCol_ ground : kGrounds) {
    ASSERT_EQ(ImGui::GetStyle().Colors[ground].w, 1) << ImGui::GetStyleColorName(ground);
    for (const auto& [name, text] : {std::pair{"text", styleColour(ImGuiCol_Text)},
                                     {"faint", ui.theme.faint},
                                     {"accent", ui.theme.accent},
                                     {"good", ui.theme.good},
                                     {"bad", ui.theme.bad},
                                     {"warning", ui.theme.warning},
                                     {"missed", ui.theme.missed},
                                     {"false", ui.theme.false_pair},
                                     {"invalid", ui.theme.invalid},
                                     {"allowed extra", ui.theme.allowed_extra},
                                     {"first only", ui.theme.first_only},
                                     {"second only", ui.theme.second_only}}) {
      EXPECT_GE(contrastOf(text, styleColour(ground)), kReadable)
          << name << " on " << ImGui::GetStyleColorName(ground);
    }
  }
}

TEST_P(ThemeTest, TextOfSpecialGroundsCanBeRead) {
  const Rgb text = styleColour(ImGuiCol_Text);
  for (const Rgb shown : {text, ui.theme.faint, ui.theme.good, ui.theme.bad, ui.theme.warning}) {
    EXPECT_GE(contrastOf(shown, ui.theme.background), kReadable) << "over the view";
  }
  EXPECT_GE(contrastOf(ui.theme.fill_text, ui.theme.fill), kReadable) << "what is switched on";
  for (const ImGuiCol_ pressed : {ImGuiCol_ButtonActive, ImGuiCol_HeaderActive}) {
    EXPECT_GE(contrastOf(text, styleColour(pressed)), kReadable);
  }
  for (const Rgb body : {ui.theme.first, ui.theme.second}) {
    EXPECT_GE(contrastOf(body, styleColour(ImGuiCol_WindowBg)), kReadable) << "of two bodies";
  }
}

TEST_P(ThemeTest, CurvesAreToldApartByColourBlindEyesAndReadAsNames) {
  const auto& curves = ui.theme.curve;
  for (std::size_t a = 0; a < curves.size(); ++a) {
    for (const ImGuiCol_ ground : {ImGuiCol_WindowBg, ImGuiCol_Header, ImGuiCol_HeaderHovered}) {
      EXPECT_GE(contrastOf(curves[a], styleColour(ground)), kReadable) << "curve " << a;
    }
    for (std::size_t b = 0; b < a; ++b) {
      for (const Eye& eye : kEyes) {
        EXPECT_GT(differenceOf(curves[a], curves[b], eye), 15)
            << a << " and " << b << ", " << eye.name;
      }
    }
  }
}

TEST_P(ThemeTest, AnAlgorithmHasItsColourAndTheOthersWhatIsLeft) {
  const auto& curves = ui.theme.curve;
  const std::vector<std::string_view> algorithms = {"kd-mt", "unheard of", "kd", "grid-sap"};
  const std::vector<Rgb> colours = curveColours(algorithms, ui.theme);
  EXPECT_EQ(colours, (std::vector<Rgb>{curves[1], curves[2], curves[3], curves[0]}));
  const std::vector<Rgb> many =
      curveColours(std::vector<std::string_view>(2 * curves.size()), ui.theme);
  for (std::size_t i = 0; i < many.size(); ++i) EXPECT_EQ(many[i], curves[i % curves.size()]);
}

INSTANTIATE_TEST_SUITE_P(DarkAndLight, ThemeTest, testing::Bool());

}  // namespace
}  // namespace broadmark::tests
