// The window's contents: layout, panels and dialogs.

#include "inspector/inspector.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "inspector/authoring/author_dialogs.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr float kFontSize = 15;        // units
constexpr float kLargeFontSize = 20;   // units
constexpr float kMinAreaExtent = 110;  // units: of a visible dock area

}  // namespace

Inspector::Inspector(const Gl& gl, std::vector<Algorithm> algorithms, Preferences preferences,
                     float scale, ExecutorFactory make_executor, SimulationHost host)
    : preferences_(std::move(preferences)),
      context_(ImGui::CreateContext()),
      renderer_(gl),
      gl_(&gl),
      session_(std::move(algorithms), std::move(make_executor), std::move(host)),
      views_(gl),
      panels_(makePanels({ui_, session_, views_.first(), files_})),
      screen_scale_(scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  setKeyMap(io);
  applyStyle();
  for (const auto& [area, panel] : preferences_.tabs)
    session_.notices.panels_to_raise.push_back(panel);
  session_.notices.on_file_used = [this](const fs::path& file) { preferences_.remember(file); };
  ui_.on_correction = [this](const std::string& text) {
    session_.notices.setStatus(text, Severity::warning);
  };
  makeShortcuts();
}

Inspector::~Inspector() { ImGui::DestroyContext(context_); }

void Inspector::applyStyle() {
  const float scale =
      preferences_.scale > 0 ? static_cast<float>(preferences_.scale) : screen_scale_;
  const bool same_fonts = scale == ui_.scale && ui_.large != nullptr;
  applyTheme(ui_, preferences_.dark, scale);
  if (!same_fonts) loadFonts();
}

void Inspector::loadFonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ui_.large = ui_.glyphs.load(atlas, std::floor(kFontSize * ui_.scale),
                              std::floor(kLargeFontSize * ui_.scale));
  renderer_.uploadFonts(atlas);
}

void Inspector::draw(InputQueue& input, int width, int height, double seconds,
                     const std::function<void()>& bind) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 1.0));
  input.applyTo(io);
  if (std::exchange(style_changed_, false)) applyStyle();
  if (ui_.glyphs.dirty()) loadFonts();
  session_.runs.drawGate().beginDrawing();
  ui_.beforePicture();
  prepareNavigation();
  ImGui::NewFrame();
  ui_.begin();
  session_.runs.readProgress([&](const RunProgress& progress) {
    session_.advance(progress, seconds);
    handleShortcuts();
    build(progress, width, height);
  });
  ImGui::Render();
  bind();
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_MenuBarBg);
  gl_->Viewport(0, 0, width, height);
  gl_->ClearColor(back.x, back.y, back.z, 1);
  gl_->Clear(GL_COLOR_BUFFER_BIT);
  renderer_.draw(*ImGui::GetDrawData());
  session_.runs.drawGate().endDrawing();
  session_.postRequest();
}

bool Inspector::needsRedraw() {
  return session_.busy() || views_.needsRedraw() || ImGui::GetIO().WantTextInput;
}

std::optional<fs::path> Inspector::takeScreenshotRequest() {
  if (!std::exchange(screenshot_requested_, false)) return {};
  fs::path path;
  do {
    path = fmt::format("broadmark-{:03}.png", ++screenshots_);
  } while (fs::exists(path));
  session_.notices.setStatus(fmt::format("screenshot: {}", fs::absolute(path).string()));
  return path;
}

void Inspector::splitter(const char* id, ImVec2 position, ImVec2 size, double& extent, float sign) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  beginAt(id, position, size, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground);
  ImGui::InvisibleButton(id, {std::max(size.x, 1.0F), std::max(size.y, 1.0F)});
  ui_.note(id);
  const bool vertical = size.y > size.x;
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    ImGui::GetWindowDrawList()->AddRectFilled(position, {position.x + size.x, position.y + size.y},
                                              colour(ui_.theme.accent, 0.5F));
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    extent += static_cast<double>(sign * (vertical ? moved.x : moved.y) / ui_.scale);
    extent = std::max(extent, static_cast<double>(kMinAreaExtent));
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void Inspector::build(const RunProgress& progress, int width, int height) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  drawMenus(progress);
  const float unit = ui_.scale;
  const auto w = static_cast<float>(width);
  const auto h = static_cast<float>(height);
  const float top = ImGui::GetFrameHeight();
  const float line = ImGui::GetFrameHeight() + 2 * unit;
  const float status_top = std::max(h - line, top);
  const float gap = kSplitterSize * unit;
  // In a small window the dock areas shrink, then vanish, to make room for the view.
  const auto extent = [&](double preferred, float max) {
    const float actual = std::min(static_cast<float>(preferred) * unit, max);
    return actual < kMinAreaExtent * unit ? 0.0F : actual;
  };
  const float left = extent(preferences_.left, 0.30F * w);
  const float right = extent(preferences_.right, 0.30F * w);
  const float bottom = extent(preferences_.bottom, 0.40F * (status_top - top));
  const float view_left = left > 0 ? left + gap : 0;
  const float view_right = right > 0 ? w - right - gap : w;
  const float middle = std::max(view_right - view_left, 1.0F);
  const float transport_height = transportHeight(middle);
  const float view_bottom =
      std::max(status_top - (bottom > 0 ? bottom + gap : 0) - transport_height, top + 1);

  if (left > 0) {
    drawDockArea(DockArea::left, progress, {0, top}, {left, status_top - top});
    splitter("left splitter", {left, top}, {gap, status_top - top}, preferences_.left, 1);
  }
  if (right > 0) {
    drawDockArea(DockArea::right, progress, {w - right, top}, {right, status_top - top});
    splitter("right splitter", {w - right - gap, top}, {gap, status_top - top}, preferences_.right,
             -1);
  }
  if (bottom > 0) {
    drawDockArea(DockArea::bottom, progress, {view_left, status_top - bottom}, {middle, bottom});
    splitter("bottom splitter", {view_left, status_top - bottom - gap}, {middle, gap},
             preferences_.bottom, -1);
  }
  views_.draw(ui_, session_, progress, {view_left, top}, {middle, view_bottom - top});
  beginAt("Playback", {view_left, view_bottom}, {middle, transport_height},
          ImGuiWindowFlags_NoScrollbar);
  focusIfRequested(kDockAreas.entries.size());
  drawTransport(progress);
  ImGui::End();
  beginAt("Status", {0, status_top}, {w, line}, ImGuiWindowFlags_NoScrollbar);
  drawStatus(progress);
  ImGui::End();

  session_.notices.panels_to_raise.clear();
  files_.draw(ui_);
  drawLeaving(ui_, files_, session_);
  drawQuitDialog();
  drawHelp();
  drawErrors();
  ImGui::PopStyleVar();
}

void Inspector::drawDockArea(DockArea area, const RunProgress& progress, ImVec2 position,
                             ImVec2 size) {
  const std::string name(kDockAreas.nameOf(area));
  beginAt(name.c_str(), position, size);
  focusIfRequested(static_cast<std::size_t>(area));
  if (ImGui::BeginTabBar(name.c_str(), ImGuiTabBarFlags_FittingPolicyScroll)) {
    for (const auto& panel : panels_) {
      if (panel.area != area) continue;
      const bool raised = std::ranges::find(session_.notices.panels_to_raise, panel.name) !=
                          session_.notices.panels_to_raise.end();
      const bool open =
          ImGui::BeginTabItem(panel.name, nullptr, raised ? ImGuiTabItemFlags_SetSelected : 0);
      ui_.note(panel.name);
      ui_.tooltip(panel.tooltip);
      if (!open) continue;
      preferences_.tabs[name] = panel.name;
      const auto scope = ui_.scope(panel.name);
      ImGui::BeginChild(panel.name, {0, 0}, false, ImGuiWindowFlags_NavFlattened);
      panel.panel->drawOf(progress);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void Inspector::drawErrors() {
  const auto scope = ui_.scope("Error");
  if (!session_.notices.errors.empty() && !ImGui::IsPopupOpen("Error")) ImGui::OpenPopup("Error");
  if (!ui_.beginDialog("Error", {520, 0})) return;
  if (!session_.notices.errors.empty()) ui_.paragraph(session_.notices.errors.front());
  ImGui::Spacing();
  // The key press that caused the error must not acknowledge it.
  const bool acknowledged = !ImGui::IsWindowAppearing() && (ui_.escaped() || Ui::entered());
  if (ui_.button("OK", nullptr, 80 * ui_.scale) || acknowledged) {
    if (!session_.notices.errors.empty()) session_.notices.errors.pop_front();
    if (session_.notices.errors.empty()) ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void Inspector::closeDocument() {
  quit_requested_ = false;
  session_.document.closeThen([this] { closing_ = true; });
}

void Inspector::drawQuitDialog() {
  if (!quit_requested_ || !session_.notices.errors.empty()) return;
  if (!session_.jobs.running()) return closeDocument();  // finished meanwhile
  const auto scope = ui_.scope("Quit");
  std::string text;
  for (const Job* const job : session_.jobs.all()) {
    if (job->running()) text += job->status().activity + '\n';
  }
  const auto answer = ui_.ask("Work in progress", text + "Finished work is kept.",
                              {{"Quit anyway", "Discard unfinished work"}});
  if (!answer) return;
  quit_requested_ = false;
  if (*answer == 0) closeDocument();
}

}  // namespace broadmark
