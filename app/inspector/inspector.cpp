// The window's contents: menus, places for panels, transport and status bar, dialogs.

#include "inspector/inspector.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "inspector/author_dialogs.h"
#include "inspector/case_chooser.h"
#include "broadmark/files.h"
#include "broadmark/environment.h"
#include "broadmark/render/fonts.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr float kFontSize = 15;     // units
constexpr float kSplitterSize = 5;  // units
constexpr float kNarrowest = 110;   // units: of a place that is shown
constexpr double kSpeeds[] = {1, 5, 10, 15, 24, 30, 60, 120, 1000};

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

const char* placeName(Place place) {
  switch (place) {
    case Place::left:
      return "left";
    case Place::right:
      return "right";
    case Place::bottom:
      return "bottom";
  }
  return "";
}

/// Opens a window that fills a rectangle.
void beginAt(const char* id, ImVec2 position, ImVec2 size, ImGuiWindowFlags flags = 0) {
  ImGui::SetNextWindowPos(position);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin(id, nullptr, kFixed | flags);
}

}  // namespace

Inspector::Inspector(const Gl& gl, std::vector<Algorithm> algorithms, Preferences preferences,
                     float scale)
    : preferences_(std::move(preferences)),
      context_(ImGui::CreateContext()),
      renderer_(gl),
      gl_(&gl),
      session_(std::move(algorithms)),
      view_(gl),
      panels_(makePanels()) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  setKeyMap(io);
  ui_.scale = preferences_.scale > 0 ? static_cast<float>(preferences_.scale) : scale;
  loadFonts();
  for (const auto& [place, panel] : preferences_.tabs) session_.wanted_panels.push_back(panel);
  session_.on_file = [this](const fs::path& file) { preferences_.remember(file); };
  makeShortcuts();
}

Inspector::~Inspector() { ImGui::DestroyContext(context_); }

void Inspector::loadFonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  // Latin, and the dashes, arrows, dots and signs that our texts use.
  static constexpr ImWchar kRanges[] = {0x20,   0xFF,   0x2010, 0x2026, 0x2190, 0x2193, 0x2212,
                                        0x2212, 0x2248, 0x2248, 0x2264, 0x2265, 0};
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  const std::string_view font = interfaceFont();
  atlas.AddFontFromMemoryTTF(const_cast<char*>(font.data()), static_cast<int>(font.size()),
                             std::floor(kFontSize * ui_.scale), &config, kRanges);
  renderer_.uploadFonts(atlas);
}

void Inspector::draw(InputQueue& input, int width, int height, double seconds,
                     const std::function<void()>& bind) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 1.0));
  input.applyTo(io);
  if (std::exchange(restyle_, false)) applyTheme(ui_, preferences_.dark, ui_.scale);
  session_.runs.gate().beginDrawing();
  ImGui::NewFrame();
  ui_.begin();
  session_.runs.look([&](const RunProgress& progress) {
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
  session_.runs.gate().endDrawing();
  session_.commit();
}

bool Inspector::lively() {
  return session_.busy() || view_.lively() || ImGui::GetIO().WantTextInput;
}

std::optional<fs::path> Inspector::takeScreenshotRequest() {
  if (!std::exchange(screenshot_asked_, false)) return {};
  fs::path path;
  do {
    path = fmt::format("broadmark-{:03}.png", ++screenshots_);
  } while (fs::exists(path));
  session_.say(fmt::format("screenshot: {}", fs::absolute(path).string()));
  return path;
}

Panel* Inspector::panel(const std::string& name) {
  for (const auto& panel : panels_) {
    if (panel->name() == name) return panel.get();
  }
  return nullptr;
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
    extent = std::max(extent, static_cast<double>(kNarrowest));
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
  // On a small window the places make room for the view, and then give way altogether.
  const auto extent = [&](double wanted, float most) {
    const float given = std::min(static_cast<float>(wanted) * unit, most);
    return given < kNarrowest * unit ? 0.0F : given;
  };
  const float left = extent(preferences_.left, 0.30F * w);
  const float right = extent(preferences_.right, 0.30F * w);
  const float bottom = extent(preferences_.bottom, 0.40F * (status_top - top));
  const float transport_height = ImGui::GetFrameHeight() + 12 * unit;
  const float view_left = left > 0 ? left + gap : 0;
  const float view_right = right > 0 ? w - right - gap : w;
  const float view_bottom =
      std::max(status_top - (bottom > 0 ? bottom + gap : 0) - transport_height, top + 1);

  PanelContext context{ui_, session_, progress, view_, files_};
  if (left > 0) {
    drawPlace(Place::left, context, {0, top}, {left, status_top - top});
    splitter("left splitter", {left, top}, {gap, status_top - top}, preferences_.left, 1);
  }
  if (right > 0) {
    drawPlace(Place::right, context, {w - right, top}, {right, status_top - top});
    splitter("right splitter", {w - right - gap, top}, {gap, status_top - top}, preferences_.right,
             -1);
  }
  const float middle = std::max(view_right - view_left, 1.0F);
  if (bottom > 0) {
    drawPlace(Place::bottom, context, {view_left, status_top - bottom}, {middle, bottom});
    splitter("bottom splitter", {view_left, status_top - bottom - gap}, {middle, gap},
             preferences_.bottom, -1);
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  beginAt("View", {view_left, top}, {middle, view_bottom - top}, ImGuiWindowFlags_NoScrollbar);
  view_.draw(ui_, session_, progress);
  ImGui::End();
  ImGui::PopStyleVar();
  beginAt("Playback", {view_left, view_bottom}, {middle, transport_height},
          ImGuiWindowFlags_NoScrollbar);
  drawTransport(progress);
  ImGui::End();
  beginAt("Status", {0, status_top}, {w, line}, ImGuiWindowFlags_NoScrollbar);
  drawStatus(progress);
  ImGui::End();

  session_.wanted_panels.clear();
  files_.draw(ui_);
  drawLeaving(ui_, files_, session_);
  drawCaseChooser(ui_, session_);
  drawHelp();
  drawErrors();
  ImGui::PopStyleVar();
}

void Inspector::drawPlace(Place place, PanelContext& context, ImVec2 position, ImVec2 size) {
  beginAt(placeName(place), position, size);
  if (ImGui::BeginTabBar(placeName(place), ImGuiTabBarFlags_FittingPolicyScroll)) {
    for (const auto& panel : panels_) {
      if (panel->place() != place) continue;
      const bool wanted =
          std::ranges::find(session_.wanted_panels, panel->name()) != session_.wanted_panels.end();
      const bool open =
          ImGui::BeginTabItem(panel->name(), nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0);
      ui_.note(panel->name());
      ui_.tooltip(panel->tooltip());
      if (!open) continue;
      preferences_.tabs[placeName(place)] = panel->name();
      const auto scope = ui_.scope(panel->name());
      ImGui::BeginChild(panel->name());
      panel->draw(context);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void Inspector::drawMenus(const RunProgress& progress) {
  if (!ImGui::BeginMainMenuBar()) return;
  if (ui_.beginMenu("File")) {
    const auto scope = ui_.scope("File");
    if (ui_.menuItem("Open…", "Ctrl+O")) askOpen();
    if (ImGui::BeginMenu("Open recent", !preferences_.recent.empty())) {
      const auto inside = ui_.scope("Open recent");
      for (const std::string& file : std::vector(preferences_.recent)) {
        if (ui_.menuItem(file.c_str())) session_.open(file);
      }
      ImGui::EndMenu();
    } else {
      ui_.note("Open recent");
    }
    ImGui::Separator();
    if (ui_.menuItem("Save scene…", session_.authoring() ? "Ctrl+S" : nullptr)) {
      askSaveScene(files_, session_);
    }
    if (ui_.menuItem("Save recording…", session_.authoring() ? nullptr : "Ctrl+S", false,
                     progress.snapshot != nullptr)) {
      askSaveRecording();
    }
    if (ui_.menuItem("Export timings…", nullptr, false, !progress.lanes.empty())) {
      timings_ = formatFrameTable(progress);
      askExportTimings();
    }
    ImGui::Separator();
    if (ui_.menuItem("Screenshot", "F12")) screenshot_asked_ = true;
    if (movie_directory_.empty()) {
      if (ui_.menuItem("Record movie…")) askMovie();
    } else if (ui_.menuItem("End movie")) {
      session_.say(fmt::format("movie: {}", movie_directory_.string()));
      movie_directory_.clear();
    }
    ImGui::Separator();
    if (ui_.menuItem("Quit", "Ctrl+Q")) close();
    ImGui::EndMenu();
  }
  if (ui_.beginMenu("View")) {
    const auto scope = ui_.scope("View menu");
    if (ui_.menuItem("Dark", nullptr, preferences_.dark)) {
      preferences_.dark = true;
      restyle_ = true;
    }
    if (ui_.menuItem("Light", nullptr, !preferences_.dark)) {
      preferences_.dark = false;
      restyle_ = true;
    }
    ImGui::Separator();
    for (const auto& panel : panels_) {
      if (ui_.menuItem(panel->name())) session_.wanted_panels.push_back(panel->name());
    }
    ImGui::EndMenu();
  }
  if (ui_.beginMenu("Help")) {
    const auto scope = ui_.scope("Help");
    if (ui_.menuItem("Keys and mouse", "F1")) help_ = true;
    ImGui::Separator();
    ui_.faint(fmt::format("Broadmark {}", thisEnvironment().version));
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

void Inspector::drawTransport(const RunProgress& progress) {
  const auto scope = ui_.scope("Playback");
  Playback& playback = session_.playback;
  if (ui_.button("|<", "First frame (Home)")) session_.step(-static_cast<int>(session_.frame()));
  ImGui::SameLine();
  if (ui_.button("<", "One frame back (Left)")) session_.step(-1);
  ImGui::SameLine();
  bool playing = playback.playing;
  if (ui_.toggle(playing ? "Pause###Play" : "Play###Play", playing, "Play or pause (Space)",
                 52 * ui_.scale)) {
    session_.play(playing);
  }
  ImGui::SameLine();
  if (ui_.button(">", "One frame on (Right)")) session_.step(1);
  ImGui::SameLine();
  ui_.toggle("Loop", playback.loop, "Begin again after the last frame");
  ImGui::SameLine();
  std::vector<std::string> speeds;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < std::size(kSpeeds); ++i) {
    speeds.push_back(kSpeeds[i] >= 1000 ? "fastest" : fmt::format("{:g} frames/s", kSpeeds[i]));
    if (kSpeeds[i] <= playback.frames_per_second) chosen = i;
  }
  const float width = 108 * ui_.scale;
  const bool roomy = ImGui::GetContentRegionAvail().x > 330 * ui_.scale;
  if (roomy) {
    if (ui_.combo("##speed", chosen, speeds, "Frames shown per second, if all keep pace", width)) {
      playback.frames_per_second = kSpeeds[chosen];
    }
    ImGui::SameLine();
  }
  const std::string count = fmt::format("{} / {}", session_.frame(), session_.lastFrame());
  const float text = ImGui::CalcTextSize(count.c_str()).x + ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - text, 20.0F));
  int frame = static_cast<int>(session_.frame());
  if (ui_.slider("##frame", frame, 0, std::max(1, static_cast<int>(session_.lastFrame())), "")) {
    playback.playing = false;
    session_.seek(frame);
  }
  // What has been simulated so far.
  if (progress.live && progress.scene.frames > 0) {
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    const float known = min.x + (max.x - min.x) * static_cast<float>(progress.known_frames) /
                                    static_cast<float>(progress.scene.frames);
    ImGui::GetWindowDrawList()->AddRectFilled({min.x, max.y - 2 * ui_.scale}, {known, max.y},
                                              colour(ui_.theme.accent, 0.7F));
  }
  ImGui::SameLine();
  ImGui::TextUnformatted(count.c_str());
}

void Inspector::drawStatus(const RunProgress& progress) {
  const auto scope = ui_.scope("Status");
  ImGui::SetCursorPosY(4 * ui_.scale);
  if (progress.footage) {
    ImGui::TextUnformatted(progress.footage->title.c_str());
    ImGui::SameLine(0, 14 * ui_.scale);
    ui_.faint(fmt::format("{} {}, {} bodies", progress.scene.name, progress.scene.object_type,
                          progress.scene.objects));
    if (progress.snapshot) {
      ImGui::SameLine(0, 14 * ui_.scale);
      ui_.faint(fmt::format("{} pairs", progress.snapshot->pairs.size()));
    }
  } else {
    ui_.faint("Nothing is open: simulate a scene, or open or drop a recording");
  }
  if (!progress.doing.empty()) {
    ImGui::SameLine(0, 14 * ui_.scale);
    ImGui::ProgressBar(progress.fraction, {90 * ui_.scale, ImGui::GetTextLineHeight()}, "");
    ImGui::SameLine();
    ui_.faint(progress.doing);
  }
  const Message& message = session_.status;
  if (message.text.empty()) return;
  const std::string shown = message.text.substr(0, message.text.find('\n'));
  const float x = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(shown.c_str()).x;
  ImGui::SameLine(std::max(x, ImGui::GetCursorPosX() + 20 * ui_.scale));
  ui_.coloured(message.kind == Message::Kind::error     ? ui_.theme.bad
               : message.kind == Message::Kind::warning ? ui_.theme.warning
                                                        : ui_.theme.faint,
               shown);
}

void Inspector::drawErrors() {
  const auto scope = ui_.scope("Error");
  if (!session_.errors.empty() && !ImGui::IsPopupOpen("Error")) ImGui::OpenPopup("Error");
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(520 * ui_.scale, screen.x - 16), 0});
  if (!ImGui::BeginPopupModal("Error", nullptr,
                              ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
    return;
  }
  if (!session_.errors.empty()) ui_.paragraph(session_.errors.front());
  ImGui::Spacing();
  // The key that led to the error is no answer to it.
  const bool escaped = !ImGui::IsWindowAppearing() &&
                       (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false) ||
                        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false));
  if (ui_.button("OK", nullptr, 80 * ui_.scale) || escaped) {
    if (!session_.errors.empty()) session_.errors.pop_front();
    if (session_.errors.empty()) ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void Inspector::askOpen() {
  files_.ask({.title = "Open a recording, a scene or results",
              .purpose = FileDialog::Purpose::open,
              .extensions = {".aabbs", ".posrot", ".json"},
              .suggestion = preferences_.recent.empty() ? "" : preferences_.recent.front(),
              .chosen = [this](const fs::path& path) { session_.open(path); }});
}

void Inspector::askSaveRecording() {
  SceneInfo scene = session_.scene();
  files_.ask({.title = "Save the frames known so far as a recording",
              .purpose = FileDialog::Purpose::save,
              .extensions = {".aabbs"},
              .suggestion = fs::path(recordingFileName(scene)),
              .chosen = [this](const fs::path& path) { session_.saveRecording(path); }});
}

void Inspector::askExportTimings() {
  files_.ask({.title = "Export the times of all frames",
              .purpose = FileDialog::Purpose::save,
              .extensions = {".csv"},
              .suggestion = "timings.csv",
              .chosen = [this](const fs::path& path) {
                session_.attempt([&] {
                  writeTextFile(path, timings_.value_or(""));
                  session_.say(fmt::format("written: {}", path.string()));
                });
              }});
}

void Inspector::askMovie() {
  files_.ask({.title = "Directory for the movie's pictures",
              .purpose = FileDialog::Purpose::directory,
              .extensions = {},
              .suggestion = {},
              .chosen = [this](const fs::path& path) { movie_directory_ = path; }});
}

}  // namespace broadmark
