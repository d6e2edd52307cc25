// The menus, and the dialogs opened by them.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "broadmark/files.h"
#include "broadmark/harness/environment.h"
#include "broadmark/recordings/recording.h"
#include "inspector/authoring/author_dialogs.h"
#include "inspector/inspector.h"
#include "inspector/session/share_page.h"
#include "sources/source.h"

namespace broadmark {

namespace fs = std::filesystem;

void Inspector::drawMenus() {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const char* const menu : {"File", "View", "Help"}) {
    if (!ui_.beginMenu(menu)) continue;
    // The view of the scene has the name of the menu.
    const auto scope = ui_.scope(std::string_view(menu) == "View" ? "View menu" : menu);
    drawMenuItems(ui_, commands_, menu);
    if (std::string_view(menu) == "Help") {
      ImGui::Separator();
      ui_.faint(fmt::format("Broadmark {}", thisEnvironment().version));
    }
    ImGui::EndMenu();
  }
  if (rate_.shown) ui_.rightAligned(rate_.text, ui_.theme.faint);
  ImGui::EndMainMenuBar();
}

void Inspector::askOpen() {
  files_.ask(
      {.title = "Open a recording, a scene, results, or a file to import",
       .listed = [](const fs::path& file) { return hasSourceName(file) || isLibraryFile(file); },
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

void Inspector::askShare() {
  files_.ask({.title = "Share the picture, its verdict and the command that opens it",
              .purpose = FileDialog::Purpose::save,
              .extensions = {".html"},
              .suggestion = fs::path(fmt::format("frame {}.html", session_.playback.frame())),
              .chosen = [this](const fs::path& path) {
                page_request_ = path;
                page_is_due_ = false;
              }});
}

std::optional<fs::path> Inspector::takePageRequest() {
  if (!page_request_ || !std::exchange(page_is_due_, true)) return {};
  return std::exchange(page_request_, {});
}

std::string Inspector::page(std::string_view png) {
  return sharePage(session_, views_.first().answer(), png);
}

void Inspector::askMovie() {
  files_.ask({.title = "Directory for the movie's pictures",
              .purpose = FileDialog::Purpose::directory,
              .chosen = [this](const fs::path& path) { movie_directory_ = path; }});
}

}  // namespace broadmark
