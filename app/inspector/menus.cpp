// The menus, and the dialogs opened by them.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "broadmark/files.h"
#include "broadmark/harness/environment.h"
#include "broadmark/recordings/recording.h"
#include "inspector/authoring/author_dialogs.h"
#include "inspector/inspector.h"

namespace broadmark {

namespace fs = std::filesystem;

void Inspector::drawMenus(const RunProgress& progress) {
  if (!ImGui::BeginMainMenuBar()) return;
  if (ui_.beginMenu("File")) {
    const auto scope = ui_.scope("File");
    const std::string save = keysFor(kSave);
    if (ui_.menuItem("Open…", keysFor(kOpenFile).c_str())) askOpen();
    if (ui_.beginMenu("Open recent", !preferences_.recent.empty())) {
      const auto inside = ui_.scope("Open recent");
      for (const std::string& file : std::vector(preferences_.recent)) {
        if (ui_.menuItem(file.c_str())) session_.open(file);
      }
      ImGui::EndMenu();
    }
    if (ui_.menuItem("Load algorithms…")) askLoadAlgorithms();
    ImGui::Separator();
    if (ui_.menuItem("Save scene…", session_.document.shown() ? save.c_str() : nullptr)) {
      askSaveScene(files_, session_);
    }
    if (ui_.menuItem("Save recording…", session_.document.shown() ? nullptr : save.c_str(), false,
                     progress.snapshot != nullptr)) {
      askSaveRecording();
    }
    if (ui_.menuItem("Export timings…", nullptr, false, !progress.tracks.empty())) {
      askExportTimings(formatFrameTable(session_.playback.scene(), progress.tracks));
    }
    ImGui::Separator();
    if (ui_.menuItem("Screenshot", keysFor(kSaveScreenshot).c_str())) screenshot_requested_ = true;
    if (movie_directory_.empty()) {
      if (ui_.menuItem("Record movie…")) askMovie();
    } else if (ui_.menuItem("End movie")) {
      session_.notices.setStatus(fmt::format("movie: {}", movie_directory_.string()));
      movie_directory_.clear();
    }
    ImGui::Separator();
    if (ui_.menuItem("Quit", keysFor(kQuit).c_str())) close();
    ImGui::EndMenu();
  }
  if (ui_.beginMenu("View")) {
    const auto scope = ui_.scope("View menu");
    if (ui_.menuItem("Dark", nullptr, preferences_.dark)) {
      preferences_.dark = true;
      style_changed_ = true;
    }
    if (ui_.menuItem("Light", nullptr, !preferences_.dark)) {
      preferences_.dark = false;
      style_changed_ = true;
    }
    ImGui::Separator();
    drawScaleMenu();
    if (ui_.menuItem("Reset layout")) resetLayout();
    ImGui::Separator();
    for (const auto& panel : panels_) {
      const std::string keys = keysFor(fmt::format("show the panel {}", panel.name));
      if (ui_.menuItem(panel.name, keys.c_str()))
        session_.notices.panels_to_raise.push_back(panel.name);
    }
    ImGui::EndMenu();
  }
  if (ui_.beginMenu("Help")) {
    const auto scope = ui_.scope("Help");
    if (ui_.menuItem("Keys and mouse", keysFor(kShowHelp).c_str())) help_open_ = true;
    ImGui::Separator();
    ui_.faint(fmt::format("Broadmark {}", thisEnvironment().version));
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

void Inspector::resetLayout() {
  preferences_.resetLayout();
  for (const auto& [area, name] : kDockAreas.entries) {
    const auto first = std::ranges::find(panels_, area, &PanelTab::area);
    if (first != panels_.end()) session_.notices.raisePanel(first->name);
  }
}

void Inspector::drawScaleMenu() {
  if (!ui_.beginMenu("Scale")) return;
  const auto scope = ui_.scope("Scale");
  constexpr double kScales[] = {0, 0.75, 1, 1.25, 1.5, 2, 3};
  for (const double scale : kScales) {
    const std::string name =
        scale == 0 ? "as the screen suggests" : fmt::format("{:.0f} %", 100 * scale);
    if (ui_.menuItem(name.c_str(), nullptr, preferences_.scale == scale)) {
      preferences_.scale = scale;
      style_changed_ = true;
    }
  }
  ImGui::EndMenu();
}

void Inspector::askOpen() {
  std::vector<std::string> extensions = recordingExtensions();
  for (const char* extension : {".json", ".jsonl"}) extensions.emplace_back(extension);
  files_.ask({.title = "Open a recording, a scene or results",
              .extensions = std::move(extensions),
              .suggestion = preferences_.recent.empty() ? "" : preferences_.recent.front(),
              .chosen = [this](const fs::path& path) { session_.open(path); }});
}

void Inspector::askLoadAlgorithms() {
  files_.ask({.title = "Load algorithms: a plug-in (.so), a program or a log of pairs",
              .chosen = [this](const fs::path& path) { session_.plugins.load(path); }});
}

void Inspector::askSaveRecording() {
  SceneInfo scene = session_.playback.scene();
  files_.ask({.title = "Save the available frames as a recording",
              .purpose = FileDialog::Purpose::save,
              .extensions = boxRecordingExtensions(),
              .suggestion = fs::path(recordingFileName(scene)),
              .chosen = [this](const fs::path& path) { session_.saveRecording(path); }});
}

void Inspector::askExportTimings(const std::string& table) {
  files_.ask({.title = "Export the times of all frames",
              .purpose = FileDialog::Purpose::save,
              .extensions = {".csv"},
              .suggestion = "timings.csv",
              .chosen = [this, table](const fs::path& path) {
                session_.notices.catchErrors([&] {
                  writeTextFile(path, table);
                  session_.notices.setStatus(fmt::format("written: {}", path.string()));
                });
              }});
}

void Inspector::askMovie() {
  files_.ask({.title = "Directory for the movie's pictures",
              .purpose = FileDialog::Purpose::directory,
              .chosen = [this](const fs::path& path) { movie_directory_ = path; }});
}

}  // namespace broadmark
