// All commands, in the order of the menus and of the help page.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "inspector/authoring/author_dialogs.h"
#include "inspector/inspector.h"
#include "inspector/session/share_page.h"

namespace broadmark {

namespace {

/// The address of the program in a browser; null: unknown.
const char* pageInBrowsers() { return std::getenv("BROADMARK_PAGE"); }

}  // namespace

void Inspector::copyLink() {
  ImGui::SetClipboardText(openingLink(session_, views_.first().camera(), pageInBrowsers()).c_str());
  session_.notices.setStatus("copied: the link");
}

void Inspector::makeCommands() {
  commands_.clear();
  for (std::vector<UserCommand>& commands : std::array{
           playbackCommands(), fileCommands(), authorCommands(), viewCommands(), panelCommands()}) {
    std::ranges::move(commands, std::back_inserter(commands_));
  }
}

std::vector<UserCommand> Inspector::playbackCommands() {
  return {
      {.doc = "play or pause",
       .key = GLFW_KEY_SPACE,
       .action = [this] { session_.play(!session_.playback.playing()); }},
      {.doc = "previous frame",
       .key = GLFW_KEY_LEFT,
       .action = [this] { session_.playback.step(-1); }},
      {.doc = "next frame", .key = GLFW_KEY_RIGHT, .action = [this] { session_.playback.step(1); }},
      {.doc = "go to the first frame",
       .key = GLFW_KEY_HOME,
       .action = [this] { session_.playback.goTo(0); }},
      {.doc = "go to the last frame",
       .key = GLFW_KEY_END,
       .action = [this] { session_.playback.goTo(session_.playback.lastFrame()); }},
      {.doc = "fly to the selection, or to all",
       .key = GLFW_KEY_F,
       .action = [this] { session_.selection.flyToSelection(); }},
      {.doc = "hide or show bodies without overlaps",
       .key = GLFW_KEY_H,
       .action = [this] { session_.display.hide_free = !session_.display.hide_free; }},
      {.doc = "next colouring",
       .key = GLFW_KEY_C,
       .action = [this] { session_.display.colourBy(session_.display.colouring + 1); }},
      {.doc = "open or close the second view",
       .key = GLFW_KEY_V,
       .action = [this] { session_.showSecond(!session_.second); }},
  };
}

std::vector<UserCommand> Inspector::fileCommands() {
  const auto document = [this] { return session_.document.shown(); };
  const auto snapshot = [this] { return progress_->snapshot != nullptr; };
  std::vector<UserCommand> commands = {{.doc = "open a file",
                                        .key = GLFW_KEY_O,
                                        .ctrl = true,
                                        .menu = "File",
                                        .label = "Open…",
                                        .action = [this] { askOpen(); }}};
  for (const std::string& file : preferences_.recent) {
    commands.push_back({.doc = fmt::format("open {}", file),
                        .menu = "File/Open recent",
                        .label = file,
                        .action = [this, file] { session_.open(file); }});
  }
  const std::vector<UserCommand> others = {
      {.doc = "load the algorithms of a plug-in, a program or a log of pairs",
       .menu = "File",
       .label = "Load algorithms…",
       .action = [this] { askLoadAlgorithms(); }},
      {.doc = "save the authored scene",
       .key = GLFW_KEY_S,
       .ctrl = true,
       .menu = "File",
       .label = "Save scene",
       .action = [this] { saveScene(files_, session_); },
       .enabled = document,
       .begins_section = true},
      {.doc = "save the authored scene to another file",
       .menu = "File",
       .label = "Save scene as…",
       .action = [this] { askSaveScene(files_, session_); }},
      {.doc = "save the available frames as a recording",
       .key = GLFW_KEY_S,
       .ctrl = true,
       .menu = "File",
       .label = "Save recording…",
       .action = [this] { askSaveRecording(); },
       .enabled = snapshot},
      {.doc = "export the times of all frames",
       .menu = "File",
       .label = "Export timings…",
       .action =
           [this] {
             askExportTimings(formatFrameTable(session_.playback.scene(), progress_->tracks));
           },
       .enabled = [this] { return !progress_->tracks.empty(); }},
      {.doc = "copy the tables in view, with tabs between cells",
       .key = GLFW_KEY_C,
       .ctrl = true,
       .shift = true,
       .menu = "File",
       .label = "Copy tables",
       .action =
           [this] {
             ui_.copyTables();
             session_.notices.setStatus("copied: the tables in view");
           },
       .enabled = [this] { return ui_.hasTables(); }},
      {.doc = "save a screenshot",
       .key = GLFW_KEY_F12,
       .menu = "File",
       .label = "Screenshot",
       .action = [this] { takeScreenshot(); },
       .begins_section = true},
      {.doc = "save the plot under the mouse, or the first in view",
       .menu = "File",
       .label = "Save plot…",
       .action = [this] { askSavePlot(ui_.plotInUse()); },
       .enabled = [this] { return !ui_.plotInUse().empty(); }},
      {.doc = "share one page: the picture, its verdict and the command that opens it",
       .menu = "File",
       .label = "Share…",
       .action = [this] { askShare(); },
       .enabled = snapshot},
      {.doc = "copy a link that opens this simulation in a browser",
       .menu = "File",
       .label = "Copy link",
       .action = [this] { copyLink(); },
       .enabled =
           [this] {
             const auto source = session_.playback.source();
             return pageInBrowsers() != nullptr && source &&
                    source->origin == FrameOrigin::simulation;
           }},
      {.doc = "record a movie: a picture of every shown frame",
       .menu = "File",
       .label = "Record movie…",
       .action = [this] { askMovie(); },
       .enabled = [this] { return movie_directory_.empty(); }},
      {.doc = "end the movie",
       .menu = "File",
       .label = "End movie",
       .action =
           [this] {
             session_.notices.setStatus(fmt::format("movie: {}", movie_directory_.string()));
             movie_directory_.clear();
           },
       .enabled = [this] { return !movie_directory_.empty(); }},
      {.doc = "quit",
       .key = GLFW_KEY_Q,
       .ctrl = true,
       .menu = "File",
       .label = "Quit",
       .action = [this] { close(); },
       .begins_section = true}};
  commands.insert(commands.end(), others.begin(), others.end());
  return commands;
}

std::vector<UserCommand> Inspector::authorCommands() {
  using scenes::SceneEditor;
  std::vector<UserCommand> commands;
  const auto shown = [this] { return session_.document.shown(); };
  const auto add = [&](Key key, bool ctrl, bool shift, const char* doc,
                       std::function<void()> action) {
    commands.push_back({.doc = doc,
                        .key = key,
                        .ctrl = ctrl,
                        .shift = shift,
                        .action = std::move(action),
                        .enabled = shown});
  };
  const auto tool = [this](Tool which) {
    return [this, which] { session_.document.tools.toggle(which); };
  };
  const auto edit = [this](const std::function<void(SceneEditor&)>& change) {
    return [this, change] { session_.document.edit(change); };
  };
  add(GLFW_KEY_M, false, false, "authored scene: move gizmo on or off", tool(Tool::move));
  add(GLFW_KEY_T, false, false, "authored scene: rotation gizmo on or off", tool(Tool::turn));
  add(GLFW_KEY_R, false, false, "authored scene: scale gizmo on or off", tool(Tool::scale));
  add(GLFW_KEY_L, false, false,
      "authored scene: align the gizmo with the first body or with the world",
      [this] { session_.document.tools.local = !session_.document.tools.local; });
  add(GLFW_KEY_B, false, false, "authored scene: brush on or off", tool(Tool::brush));
  add(GLFW_KEY_Z, true, false, "undo an edit", edit(&SceneEditor::undo));
  add(GLFW_KEY_Z, true, true, "redo an edit", edit(&SceneEditor::redo));
  add(GLFW_KEY_A, true, false, "select all bodies of the authored scene",
      edit(&SceneEditor::selectAll));
  add(GLFW_KEY_D, true, false, "duplicate the selected bodies in place",
      edit([](SceneEditor& editor) { editor.duplicate({}); }));
  add(GLFW_KEY_G, true, false, "group the selected bodies: a click selects all of them",
      edit(&SceneEditor::group));
  add(GLFW_KEY_G, true, true, "ungroup the selected bodies", edit(&SceneEditor::ungroup));
  add(GLFW_KEY_DELETE, false, false, "delete the selected bodies", edit(&SceneEditor::erase));
  return commands;
}

std::vector<UserCommand> Inspector::viewCommands() {
  std::vector<UserCommand> commands;
  for (const bool dark : {true, false}) {
    commands.push_back({.doc = fmt::format("use the {} theme", dark ? "dark" : "light"),
                        .menu = "View",
                        .label = dark ? "Dark" : "Light",
                        .action =
                            [this, dark] {
                              preferences_.dark = dark;
                              style_changed_ = true;
                            },
                        .checked = [this, dark] { return preferences_.dark == dark; }});
  }
  constexpr double kScales[] = {0, 0.75, 1, 1.25, 1.5, 2, 3};
  for (const double scale : kScales) {
    const std::string name =
        scale == 0 ? "as the screen suggests" : fmt::format("{:.0f} %", 100 * scale);
    commands.push_back({.doc = "scale text and widgets: " + name,
                        .menu = "View/Scale",
                        .label = name,
                        .action =
                            [this, scale] {
                              preferences_.scale = scale;
                              style_changed_ = true;
                            },
                        .checked = [this, scale] { return preferences_.scale == scale; },
                        .begins_section = scale == 0});
  }
  const std::vector<UserCommand> others = {
      {.doc = "show the picture rate",
       .key = GLFW_KEY_F3,
       .menu = "View",
       .label = "Picture rate",
       .action = [this] { rate_.shown = !rate_.shown; },
       .checked = [this] { return rate_.shown; }},
      {.doc = "reset the layout of the panels",
       .menu = "View",
       .label = "Reset layout",
       .action = [this] { resetLayout(); },
       .begins_section = true},
      {.doc = "show the view alone, or the panels again",
       .key = GLFW_KEY_F11,
       .menu = "View",
       .label = "View alone",
       .action = [this] { maximise({}); },
       .checked = [this] { return view_alone_; }},
      {.doc = "maximise the panels in use, or restore them",
       .key = GLFW_KEY_M,
       .ctrl = true,
       .menu = "View",
       .label = "Maximise",
       .action = [this] { maximise(areaInUse()); },
       .checked = [this] { return maximised_.has_value(); }},
      {.doc = "focus the next area; then arrows move among its widgets",
       .key = GLFW_KEY_F6,
       .action = [this] { focusNextArea(1); }},
      {.doc = "focus the previous area",
       .key = GLFW_KEY_F6,
       .shift = true,
       .action = [this] { focusNextArea(-1); }},
      {.doc = "close a list, a dialog or a page; restore a maximised panel; cancel a drag; clear "
              "the brush, span or selection",
       .key = GLFW_KEY_ESCAPE,
       .action = [this] { escape(); }},
      {.doc = "find a command",
       .key = GLFW_KEY_P,
       .ctrl = true,
       .menu = "Help",
       .label = "Commands…",
       .action = [this] { palette_.open(); }},
      {.doc = "show the start page",
       .menu = "Help",
       .label = "Start page",
       .action = [this] { start_page_.show(session_); }},
      {.doc = "show all keys",
       .key = GLFW_KEY_F1,
       .menu = "Help",
       .label = "Keys and mouse",
       .action = [this] { help_open_ = !help_open_; }}};
  commands.insert(commands.end(), others.begin(), others.end());
  return commands;
}

std::vector<UserCommand> Inspector::panelCommands() {
  constexpr std::size_t kDigits = 10;  // Ctrl+1 to Ctrl+9 and Ctrl+0, then the same with Shift
  std::vector<UserCommand> commands;
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    commands.push_back(
        {.doc = fmt::format("show the panel {}", panels_[i].name),
         .key = i < 2 * kDigits ? GLFW_KEY_0 + static_cast<Key>((i + 1) % kDigits) : 0,
         .ctrl = true,
         .shift = i >= kDigits,
         .menu = "View",
         .label = panels_[i].name,
         .action = [this, i] { enterPanel(panels_[i]); },
         .begins_section = i == 0});
  }
  for (const PanelTab& panel : panels_) {
    commands.push_back({.doc = fmt::format("hide the panel {}, or show it", panel.name),
                        .menu = "View/Hide",
                        .label = panel.name,
                        .action = [this, &panel] { setHidden(panel, !isHidden(panel)); },
                        .checked = [this, &panel] { return isHidden(panel); },
                        .begins_section = &panel == &panels_.front()});
  }
  for (const auto& [area, name] : kDockAreas.entries) {
    for (const PanelTab& panel : panels_) {
      commands.push_back({.doc = fmt::format("move the panel {} to the {}", panel.name, name),
                          .menu = fmt::format("View/Move to the {}", name),
                          .label = panel.name,
                          .action = [this, &panel, to = area] { movePanel(panel, to); },
                          .checked = [this, &panel, to = area] { return areaOf(panel) == to; }});
    }
  }
  return commands;
}

}  // namespace broadmark
