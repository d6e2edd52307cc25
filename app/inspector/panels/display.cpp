// Colours, display options and the second view.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "broadmark/recordings/recording.h"
#include "inspector/panels/panel.h"
#include "inspector/views/view.h"

namespace broadmark::panels::display {
namespace {

constexpr double kLargestSize = 1e9;

class DisplayPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    DisplayOptions& options = session.display;
    drawColours();
    ui.heading("Show");
    ui.checkbox("only overlapping bodies", options.hide_free,
                "Hide bodies that are in no pair (H)");
    ui.checkbox("pair lines", options.pair_lines,
                "Connect the centres of the bodies of reported pairs");
    ui.checkbox("lines of all pairs", options.all_pair_lines,
                "Draw the lines of all pairs, not only of the selection's", options.pair_lines);
    ui.checkbox("world", options.world_box);
    ui.checkbox("ground", options.ground);
    ui.checkbox("axes", options.axes);
    ui.checkbox("outline selection", options.xray,
                "Draw the outlines of selected bodies over bodies in front of them");
    drawSecond();
    drawFilter();
    drawStructure();
    drawDirections();
  }

 private:
  /// Draws a checkbox that shows or hides the bodies of a class or layer.
  template <class Bits>
  void drawToggle(const std::string& label, Bits& hidden, std::size_t bit) {
    bool shown = ((hidden >> bit) & 1U) == 0;
    ImGui::PushID(static_cast<int>(bit));  // labels may repeat
    if (ui.checkbox(label.c_str(), shown, "Draw these bodies")) {
      hidden ^= Bits{1} << bit;
    }
    ImGui::PopID();
  }

  void drawFilter() {
    BodyFilter& filter = session.display.filter;
    ui.heading("Body filter");
    const auto& legend = view.content().colouring.legend;
    for (std::size_t i = 0; i < std::min<std::size_t>(legend.size(), 64); ++i) {
      drawToggle(legend[i].label, filter.hidden_classes, i);
    }
    drawLayers();
    ui.number("smallest", filter.smallest, 0, kLargestSize,
              "Hide bodies with a longest edge below this, in world units");
    ui.number("largest", filter.largest, 0, kLargestSize,
              "Hide bodies with a longest edge above this, in world units; 0: no limit");
    std::size_t axis = static_cast<std::size_t>(filter.clip_axis) + 1;
    if (ui.combo("clip", axis, {"nothing", "along x", "along y", "along z"},
                 "Hide bodies with their centre beyond a plane")) {
      filter.clip_axis = static_cast<int>(axis) - 1;
    }
    ImGui::BeginDisabled(filter.clip_axis < 0);
    int percent = static_cast<int>(std::lround(100 * filter.clip_at));
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.52F);
    if (ui.slider(fmt::format("clip at {} %###clip at", percent).c_str(), percent, 0, 100)) {
      filter.clip_at = percent / 100.0;
    }
    ui.checkbox("clip below", filter.clip_below, "Hide bodies below the plane, not above");
    ImGui::EndDisabled();
    if (ui.button("Show all bodies", nullptr, 0, filter.hides())) filter = {};
  }

  void drawSecond() {
    ui.heading("Second view");
    bool on = session.second.has_value();
    if (ui.checkbox("second view", on,
                    "Show another algorithm, frame or recording beside the first view (V). "
                    "A selected body is selected in both")) {
      session.showSecond(on);
    }
    if (!session.second) return;
    const auto scope = ui.scope("second");
    SecondViewRequest& second = *session.second;
    drawSecondAnswer(second);
    bool fixed = second.frame.has_value();
    if (ui.checkbox("at frame", fixed, "Stay at a frame while the first view plays")) {
      second.frame.reset();
      if (fixed) second.frame = session.playback.frame();
    }
    if (second.frame) {
      std::int64_t frame = *second.frame;
      if (ui.integer("frame", frame, 0, lastFrame(), "Frame of the second view")) {
        second.frame = static_cast<std::uint32_t>(frame);
      }
    }
    if (!second.source) {
      if (wideButton("Another recording…", "Open a recording in the second view")) {
        askRecording();
      }
    } else {
      ui.faint(fittingText(second.source->title, ImGui::GetContentRegionAvail().x));
      ui.tooltip(second.source->recording.string().c_str());
      if (wideButton("The same recording", "Show the recording of the first view"))
        second.source.reset();
    }
    ui.checkbox("cameras linked", session.cameras_linked,
                "Move the cameras of both views together");
  }

  void drawSecondAnswer(SecondViewRequest& second) {
    std::vector<std::string> names = {"oracle"};
    std::size_t chosen = 0;
    for (const TrackEdit& track : session.tracks.list) {
      if (track.number == second.track) chosen = names.size();
      names.push_back(caseName(track.test_case));
    }
    if (!ui.combo("answer of", chosen, names, "Answer in the second view")) return;
    second.track = chosen == 0 ? 0 : session.tracks.list[chosen - 1].number;
  }

  std::int64_t lastFrame() {
    const auto& shown = progress->second;
    return shown ? shown->scene.frames : session.playback.lastFrame();
  }

  void askRecording() {
    files.ask({.title = "A recording for the second view",
               .extensions = recordingExtensions(),
               .suggestion = session.playback.source() ? session.playback.source()->recording
                                                       : std::filesystem::path(),
               .chosen = [&session = session](const std::filesystem::path& path) {
                 session.openInSecondView(path);
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
      drawToggle(fmt::format("layer {}", layer), session.display.filter.hidden_layers, layer);
    }
  }

  void drawColours() {
    DisplayOptions& options = session.display;
    std::size_t chosen = options.colouring;
    std::vector<std::string> titles;
    for (const ColourMode& mode : colourModes()) titles.emplace_back(mode.title);
    ui.combo("colours", chosen, titles, "Meaning of the colours (C: next)");
    options.colourBy(chosen);
    ui.faintParagraph(options.colourMode().help);
    const Snapshot* snapshot = progress->snapshot.get();
    if (options.colourMode().of_tests && snapshot != nullptr &&
        (!snapshot->structure || snapshot->structure->tests().empty())) {
      ui.faintParagraph("The shown algorithm does not report its overlap tests in this frame.");
    }
  }

  void drawStructure() {
    DisplayOptions& options = session.display;
    ui.heading("Structure of the shown algorithm");
    ui.checkbox("cells, nodes, planes", options.structure, "Draw the algorithm's data structure");
    if (!options.structure) return;
    ui.checkbox("only around the selection", options.structure_near);
    const Snapshot* const snapshot = progress->snapshot.get();
    const RecordedDrawing* const drawn = snapshot != nullptr ? snapshot->structure.get() : nullptr;
    if (const int deepest = drawn != nullptr ? maxLevel(*drawn) : 0; deepest > 0) {
      ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.52F);
      const int level = options.structure_level;
      ui.slider(fmt::format("depth {}###depth", level < 0 ? "all" : std::to_string(level)).c_str(),
                options.structure_level, -1, deepest);
    }
    ui.checkbox("coloured by population", options.structure_population,
                "Colour cells by their number of bodies, if the algorithm reports it",
                drawn != nullptr && hasPopulations(*drawn));
    if (drawn != nullptr && drawn->boxes().empty() && drawn->lines().empty()) {
      ui.faint("The algorithm draws no structure.");
    }
  }

  void drawDirections() {
    ui.heading("View from");
    int column = 0;
    for (const auto& [direction, name] : kDirections.entries) {
      if (column++ % 4 != 0) ImGui::SameLine();
      if (ui.button(std::string(name).c_str())) view.viewFrom(direction);
    }
    if (ui.button("whole scene", "Move the camera to show the whole scene")) {
      view.showWholeScene();
    }
  }
};

}  // namespace

extern const PanelSpec spec = {"Display", DockArea::right,
                               "Colours, display options, body filter and second view",
                               make<DisplayPanel>};

}  // namespace broadmark::panels::display
