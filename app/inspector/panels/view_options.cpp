// How the scene is shown.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "broadmark/recordings/recording.h"
#include "inspector/panels/panel.h"
#include "inspector/views/view.h"

namespace broadmark::panels::view_options {
namespace {

constexpr double kLargestSize = 1e9;

class ViewPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    ViewOptions& look = session.view;
    drawColours();
    ui.heading("Show");
    ui.checkbox("only what overlaps", look.hide_free, "Hides bodies that are in no pair (H)");
    ui.checkbox("lines between pairs", look.pair_lines,
                "From middle to middle of two that are reported");
    ui.checkbox("of all, not of the selection", look.lines_of_all, nullptr, look.pair_lines);
    ui.checkbox("world", look.world_box);
    ui.checkbox("ground", look.ground);
    ui.checkbox("axes", look.axes);
    ui.checkbox("selection through others", look.xray,
                "Outlines the selected bodies over what stands before them");
    drawSecond();
    drawFilter();
    drawStructure();
    drawDirections();
  }

 private:
  /// A checkbox that shows or hides what a bit stands for.
  template <class Bits>
  void showBit(const std::string& label, Bits& hidden, std::size_t bit) {
    bool shown = ((hidden >> bit) & 1U) == 0;
    ImGui::PushID(static_cast<int>(bit));  // two may be called alike
    if (ui.checkbox(label.c_str(), shown, "Whether these bodies are drawn")) {
      hidden ^= Bits{1} << bit;
    }
    ImGui::PopID();
  }

  void drawFilter() {
    BodyFilter& filter = session.view.filter;
    ui.heading("Show of the crowd");
    const auto& legend = view.content().colouring.legend;
    for (std::size_t i = 0; i < std::min<std::size_t>(legend.size(), 64); ++i) {
      showBit(legend[i].label, filter.hidden_classes, i);
    }
    drawLayers();
    ui.number("smallest", filter.smallest, 0, kLargestSize,
              "Bodies whose longest edge is shorter are hidden, in world units");
    ui.number("largest", filter.largest, 0, kLargestSize,
              "Bodies whose longest edge is longer are hidden, in world units; 0: none");
    std::size_t axis = static_cast<std::size_t>(filter.clip_axis) + 1;
    if (ui.combo("clip", axis, {"nothing", "along x", "along y", "along z"},
                 "Hides the bodies whose centres lie beyond a plane")) {
      filter.clip_axis = static_cast<int>(axis) - 1;
    }
    ImGui::BeginDisabled(filter.clip_axis < 0);
    int percent = static_cast<int>(std::lround(100 * filter.clip_at));
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.52F);
    if (ui.slider(fmt::format("clip at {} %###clip at", percent).c_str(), percent, 0, 100)) {
      filter.clip_at = percent / 100.0;
    }
    ui.checkbox("clip below", filter.clip_below, "Hides what lies below the plane, not above");
    ImGui::EndDisabled();
    if (ui.button("Show all bodies", nullptr, 0, filter.hides())) filter = {};
  }

  /// What stands beside the view.
  void drawSecond() {
    ui.heading("Beside");
    bool on = session.second.has_value();
    if (ui.checkbox("second view", on,
                    "Another algorithm's answer, another frame or another recording beside the "
                    "first view (V); selecting a body in one selects it in both")) {
      session.showSecond(on);
    }
    if (!session.second) return;
    const auto scope = ui.scope("second");
    SecondViewRequest& second = *session.second;
    drawSecondAnswer(second);
    bool stays = second.frame.has_value();
    if (ui.checkbox("at frame", stays, "Stays at a frame while the first view plays")) {
      second.frame.reset();
      if (stays) second.frame = session.playback.frame();
    }
    if (second.frame) {
      std::int64_t frame = *second.frame;
      if (ui.integer("frame", frame, 0, lastFrameOf(), "That the second view shows")) {
        second.frame = static_cast<std::uint32_t>(frame);
      }
    }
    if (!second.footage) {
      if (wideButton("Another recording…", "Opens it in the second view")) {
        askRecording();
      }
    } else {
      ui.faint(fittingText(second.footage->title, ImGui::GetContentRegionAvail().x));
      ui.tooltip(second.footage->recording.string().c_str());
      if (wideButton("The same recording", "As in the first view")) second.footage.reset();
    }
    ui.checkbox("cameras linked", session.cameras_linked, "One camera moves both views");
  }

  void drawSecondAnswer(SecondViewRequest& second) {
    std::vector<std::string> names = {"oracle"};
    std::size_t chosen = 0;
    for (const LaneEdit& lane : session.lanes.list) {
      if (lane.number == second.lane) chosen = names.size();
      names.push_back(caseName(lane.run));
    }
    if (!ui.combo("answer of", chosen, names, "Whose pairs the second view shows")) return;
    second.lane = chosen == 0 ? 0 : session.lanes.list[chosen - 1].number;
  }

  std::int64_t lastFrameOf() {
    const auto& shown = progress->second;
    return shown ? shown->scene.frames : session.playback.lastFrame();
  }

  void askRecording() {
    files.ask({.title = "A recording for the second view",
               .extensions = recordingExtensions(),
               .suggestion = session.playback.footage() ? session.playback.footage()->recording
                                                        : std::filesystem::path(),
               .chosen = [&session = session](const std::filesystem::path& path) {
                 session.showBeside(path);
               }});
  }

  void drawLayers() {
    if (!progress->snapshot) return;
    std::uint32_t used = 0;
    for (const std::uint8_t layer : progress->snapshot->scene.filter.layers()) {
      used |= 1U << layer;
    }
    for (std::size_t layer = 0; layer < 32; ++layer) {
      if (((used >> layer) & 1U) == 0) continue;
      showBit(fmt::format("layer {}", layer), session.view.filter.hidden_layers, layer);
    }
  }

  void drawColours() {
    ViewOptions& look = session.view;
    const std::size_t before = look.colouring;
    std::vector<std::string> titles;
    for (const ColourMode& mode : colourModes()) titles.emplace_back(mode.title);
    look.colouring %= titles.size();
    ui.combo("colours", look.colouring, titles, "What the bodies' colours tell (C: the next)");
    if (look.colouring != before) look.filter.hidden_classes = 0;  // they are of the other colours
    ui.faintParagraph(look.colourMode().help);
    const Snapshot* snapshot = progress->snapshot.get();
    if (look.colourMode().of_tests && snapshot != nullptr &&
        (!snapshot->structure || snapshot->structure->tests().empty())) {
      ui.faintParagraph("The shown algorithm does not tell its tests of this frame.");
    }
  }

  void drawStructure() {
    ViewOptions& look = session.view;
    ui.heading("Structure of the shown algorithm");
    ui.checkbox("cells, nodes, planes", look.structure,
                "What the algorithm draws of its own structure");
    if (!look.structure) return;
    ui.checkbox("only around the selection", look.structure_near);
    const Snapshot* const snapshot = progress->snapshot.get();
    const RecordedDrawing* const drawn = snapshot != nullptr ? snapshot->structure.get() : nullptr;
    if (const int deepest = drawn != nullptr ? deepestLevel(*drawn) : 0; deepest > 0) {
      ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.52F);
      const int level = look.structure_level;
      ui.slider(fmt::format("depth {}###depth", level < 0 ? "all" : std::to_string(level)).c_str(),
                look.structure_level, -1, deepest);
    }
    ui.checkbox("coloured by population", look.structure_population,
                "Colours tell how many bodies a cell holds, where the algorithm says so",
                drawn != nullptr && tellsPopulations(*drawn));
    if (drawn != nullptr && drawn->boxes().empty() && drawn->lines().empty()) {
      ui.faint("It has none to show.");
    }
  }

  void drawDirections() {
    ui.heading("Look from");
    int column = 0;
    for (const auto& [direction, name] : kDirections.entries) {
      if (column++ % 4 != 0) ImGui::SameLine();
      if (ui.button(std::string(name).c_str())) view.lookFrom(direction);
    }
    if (ui.button("all of it", "Brings everything into the picture")) {
      view.lookAtAll();
    }
  }
};

}  // namespace

extern const PanelKind kind = {"Look", Place::right,
                               "Colours, and what is drawn besides the bodies", make<ViewPanel>};

}  // namespace broadmark::panels::view_options
