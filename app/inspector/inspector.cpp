// The window's contents: layout, panels and dialogs.

#include "inspector/inspector.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "inspector/authoring/author_dialogs.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr float kFontSize = 15;       // units
constexpr float kLargeFontSize = 20;  // units

}  // namespace

Inspector::Inspector(const Gl& gl, std::vector<Algorithm> algorithms, Preferences preferences,
                     float scale, ExecutorFactory make_executor, SimulationHost host,
                     const fs::path& autosaves)
    : preferences_(std::move(preferences)),
      context_(ImGui::CreateContext()),
      renderer_(gl),
      gl_(&gl),
      files_(preferences_.folders),
      session_(std::move(algorithms), std::move(make_executor), std::move(host)),
      views_(gl),
      panels_(makePanels({ui_, session_, views_.first(), files_})),
      start_page_(gl),
      autosave_(autosaves),
      screen_scale_(scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  setKeyMap(io);
  applyStyle();
  for (const PanelTab& panel : panels_) {
    const auto front = preferences_.tabs.find(std::string(kDockAreas.nameOf(areaOf(panel))));
    const bool is_front = front != preferences_.tabs.end() && front->second == panel.name;
    if (is_front && !isHidden(panel)) in_front_.emplace_back(panel.name);
  }
  session_.notices.on_file_used = [this](const fs::path& file) {
    preferences_.remember(file);
    commands_changed_ = true;
  };
  ui_.on_save_plot = [this](const std::string& plot) { askSavePlot(plot); };
  ui_.on_correction = [this](const std::string& text) {
    session_.notices.setStatus(text, Severity::warning);
  };
  makeCommands();
}

Inspector::~Inspector() {
  if (closing_) autosave_.discard();
  ImGui::DestroyContext(context_);
}

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
  const auto start = std::chrono::steady_clock::now();
  ImGui::SetCurrentContext(context_);
  if (std::exchange(commands_changed_, false)) makeCommands();
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
    progress_ = &progress;
    session_.advance(progress, seconds);
    start_page_.update(session_);
    handleShortcuts();
    build(progress, width, height, seconds);
    progress_ = nullptr;
  });
  session_.notices.catchErrors([&] { autosave_.update(session_.document, seconds); });
  ImGui::Render();
  bind();
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_MenuBarBg);
  gl_->Viewport(0, 0, width, height);
  gl_->ClearColor(back.x, back.y, back.z, 1);
  gl_->Clear(GL_COLOR_BUFFER_BIT);
  renderer_.draw(*ImGui::GetDrawData());
  session_.runs.drawGate().endDrawing();
  session_.postRequest();
  rate_.add(seconds,
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void Inspector::PictureRate::add(double seconds, double drawing_seconds) {
  constexpr double kWindowSeconds = 0.5;
  seconds_ += seconds;
  drawing_seconds_ += drawing_seconds;
  ++pictures_;
  if (seconds_ < kWindowSeconds) return;
  text = fmt::format("{:.0f} pictures/s, {:.1f} ms", pictures_ / seconds_,
                     1000 * drawing_seconds_ / pictures_);
  seconds_ = drawing_seconds_ = 0;
  pictures_ = 0;
}

bool Inspector::needsRedraw() {
  return session_.busy() || views_.needsRedraw() || picture_request_ ||
         ImGui::GetIO().WantTextInput;
}

std::optional<double> Inspector::animationSeconds() const {
  if (rate_.shown) return 0;
  if (start_page_.isShown(session_)) return StartPage::kFrameSeconds;
  return {};
}

void Inspector::requestPicture(fs::path file, PictureWriter write) {
  picture_is_due_ = false;
  picture_request_ = [this, file = std::move(file),
                      write = std::move(write)](const Picture& picture) {
    session_.notices.catchErrors([&] {
      write(file, picture);
      session_.notices.setStatus(fmt::format("written: {}", fs::absolute(file).string()));
    });
  };
}

std::function<void(const Picture&)> Inspector::takePictureRequest() {
  if (!picture_request_ || !std::exchange(picture_is_due_, true)) return {};
  return std::exchange(picture_request_, {});
}

void Inspector::build(const RunProgress& progress, int width, int height, double seconds) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  drawMenus();
  showRaisedPanels();
  drawn_areas_ = {};
  const float unit = ui_.scale;
  const auto w = static_cast<float>(width);
  const auto h = static_cast<float>(height);
  const float top = ImGui::GetFrameHeight();
  const float line = ImGui::GetFrameHeight() + 2 * unit;
  const float status_top = std::max(h - line, top);
  const auto draw_playback = [&](float left, float playback_width, float bottom) {
    const float playback_height = transportHeight(playback_width);
    const float playback_top = std::max(bottom - playback_height, top + 1);
    beginAt("Playback", {left, playback_top}, {playback_width, playback_height},
            ImGuiWindowFlags_NoScrollbar);
    drawn_areas_.back() = true;
    focusIfRequested(kDockAreas.entries.size());
    drawTransport(progress);
    ImGui::End();
    return playback_top;
  };

  if (maximised_ && hasVisiblePanel(*maximised_)) {
    const float bottom = draw_playback(0, w, status_top);
    drawDockArea(*maximised_, progress, {0, top}, {w, bottom - top});
  } else {
    const float gap = kSplitterSize * unit;
    // The start page has their place until they are wanted.
    const bool has_bottom = session_.playback.source() || session_.results || bottom_wanted_;
    auto [left, right, bottom] = layout(w, top, status_top);
    if (!has_bottom) bottom = 0;
    const float view_left = left > 0 ? left + gap : 0;
    const float view_right = right > 0 ? w - right - gap : w;
    const float middle = std::max(view_right - view_left, 1.0F);
    if (left > 0) {
      drawDockArea(DockArea::left, progress, {0, top}, {left, status_top - top});
      splitter("left splitter", {left, top}, {gap, status_top - top}, preferences_.left, 1);
    }
    if (right > 0) {
      drawDockArea(DockArea::right, progress, {w - right, top}, {right, status_top - top});
      splitter("right splitter", {w - right - gap, top}, {gap, status_top - top},
               preferences_.right, -1);
    }
    if (bottom > 0) {
      drawDockArea(DockArea::bottom, progress, {view_left, status_top - bottom}, {middle, bottom});
      splitter("bottom splitter", {view_left, status_top - bottom - gap}, {middle, gap},
               preferences_.bottom, -1);
    }
    const float view_bottom =
        has_bottom ? draw_playback(view_left, middle, status_top - (bottom > 0 ? bottom + gap : 0))
                   : status_top;
    drawMiddle(progress, {view_left, top}, {middle, view_bottom - top}, seconds);
  }
  beginAt("Status", {0, status_top}, {w, line}, ImGuiWindowFlags_NoScrollbar);
  drawStatus(progress);
  ImGui::End();

  files_.draw(ui_);
  drawLeaving(ui_, files_, session_);
  drawQuitDialog();
  drawHelp();
  palette_.draw(ui_, commands_);
  drawErrors();
  ImGui::PopStyleVar();
}

void Inspector::drawMiddle(const RunProgress& progress, ImVec2 position, ImVec2 size,
                           double seconds) {
  if (!start_page_.isShown(session_)) {
    views_.draw(ui_, session_, progress, position, size);
    return;
  }
  std::vector<StartPage::Entry> recovered;
  for (const Autosave::Left& left : autosave_.left()) {
    recovered.push_back({.text = left.title,
                         .tooltip = "Open this scene with its unsaved changes",
                         .open = [this, left] { recover(left); }});
  }
  std::vector<StartPage::Entry> recent;
  for (const std::string& file : preferences_.recent) {
    recent.push_back({.text = fs::path(file).filename().string(),
                      .tooltip = file,
                      .open = [this, file] { session_.open(file); }});
  }
  beginAt("Start page", position, size);
  start_page_.draw(ui_, session_, recovered, recent, seconds);
  ImGui::End();
}

void Inspector::recover(const Autosave::Left& left) {
  session_.document.closeThen([this, left] {
    session_.notices.catchErrors([&] { autosave_.recover(left, session_.document); });
  });
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
