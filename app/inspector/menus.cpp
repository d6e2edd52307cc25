// The menus, and the dialogs opened by them.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/environment.h"
#include "broadmark/recordings/recording.h"
#include "inspector/authoring/author_dialogs.h"
#include "inspector/inspector.h"
#include "inspector/session/share_page.h"
#include "sources/source.h"
#include "support/words.h"

namespace broadmark {

namespace fs = std::filesystem;

namespace {

/// The visible part of a widget in the picture.
Picture partOf(const Picture& whole, const WidgetPlace& place) {
  const int left = static_cast<int>(place.min.x);
  const int top = static_cast<int>(place.min.y);
  Picture part{.width = static_cast<int>(place.max.x) - left,
               .height = static_cast<int>(place.max.y) - top,
               .rgba = {}};
  for (int row = top; row < top + part.height; ++row) {
    const auto begin = whole.rgba.begin() + std::ptrdiff_t{4} * (row * whole.width + left);
    part.rgba.insert(part.rgba.end(), begin, begin + std::ptrdiff_t{4} * part.width);
  }
  return part;
}

}  // namespace

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
                requestPicture(path, [this](const fs::path& file, const Picture& picture) {
                  const View& view = views_.first();
                  writeTextFile(
                      file, sharePage(session_, view.camera(), view.answer(), encodePng(picture)));
                });
              }});
}

void Inspector::takeScreenshot() {
  fs::path file;
  int number = 0;
  do {
    file = fmt::format("broadmark-{:03}.png", ++number);
  } while (fs::exists(file));
  requestPicture(file, writePng);
}

void Inspector::askSavePlot(const std::string& plot) {
  const std::string name = fmt::format("{}.svg", fmt::join(splitAt('/', plot), " "));
  files_.ask({.title = "Save the plot as SVG or PNG",
              .purpose = FileDialog::Purpose::save,
              .extensions = {".svg", ".png"},
              .suggestion = fs::path(name),
              .chosen = [this, plot](const fs::path& path) {
                session_.notices.catchErrors([&] { savePlot(plot, path); });
              }});
}

void Inspector::savePlot(const std::string& plot, fs::path path) {
  if (!path.has_extension()) path += ".svg";
  const bool is_svg = path.extension() == ".svg";
  if (!is_svg && path.extension() != ".png") {
    throw InputError(fmt::format("{}: a plot is saved as .svg or .png", path.string()));
  }
  ui_.requestSvg(plot);
  requestPicture(path, [=, this](const fs::path& file, const Picture& picture) {
    if (ui_.svg().empty()) throw InputError("the plot is no longer in view");
    if (is_svg) {
      writeTextFile(file, ui_.svg());
    } else {
      writePng(file, partOf(picture, *ui_.find(plot)));
    }
  });
}

void Inspector::askMovie() {
  files_.ask({.title = "Folder for the movie's pictures",
              .purpose = FileDialog::Purpose::directory,
              .chosen = [this](const fs::path& path) { movie_directory_ = path; }});
}

}  // namespace broadmark
