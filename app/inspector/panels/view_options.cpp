// How the scene is shown.

#include <algorithm>

#include "inspector/panel.h"
#include "inspector/view.h"

namespace broadmark::panels::view_options {
namespace {

class ViewPanel final : public Panel {
 public:
  ViewPanel() : Panel("Look", Place::right, "Colours, and what is drawn besides the bodies") {}

  void draw(PanelContext& context) override {
    Ui& ui = context.ui;
    ViewOptions& view = context.session.view;
    drawColours(ui, view);
    ui.heading("Show");
    ui.checkbox("only what overlaps", view.hide_free, "Hides bodies that are in no pair (H)");
    ui.checkbox("lines between pairs", view.pair_lines,
                "From middle to middle of two that are reported");
    ImGui::BeginDisabled(!view.pair_lines);
    ui.checkbox("of all, not of the selection", view.lines_of_all);
    ImGui::EndDisabled();
    ui.checkbox("world", view.world_box);
    ui.checkbox("ground", view.ground);
    ui.checkbox("axes", view.axes);
    drawStructure(context);
    drawDirections(context);
  }

 private:
  static void drawColours(Ui& ui, ViewOptions& view) {
    std::vector<std::string> titles;
    for (const ColourMode& mode : colourModes()) titles.emplace_back(mode.title);
    view.colouring %= titles.size();
    ui.combo("colours", view.colouring, titles, "What the bodies' colours tell (C: the next)");
    ui.faintParagraph(colourModes()[view.colouring].help);
  }

  static void drawStructure(PanelContext& context) {
    Ui& ui = context.ui;
    ViewOptions& view = context.session.view;
    ui.heading("Structure of the shown algorithm");
    ui.checkbox("cells, nodes, planes", view.structure,
                "What the algorithm draws of its own structure");
    if (!view.structure) return;
    ui.checkbox("only around the selection", view.structure_near);
    const Snapshot* snapshot = context.progress.snapshot.get();
    const int deepest =
        snapshot != nullptr && snapshot->structure ? deepestLevel(*snapshot->structure) : 0;
    if (deepest > 0) {
      ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.52F);
      ui.slider("depth", view.structure_level, -1, deepest,
                view.structure_level < 0 ? "all" : "%.0f");
    }
    if (snapshot != nullptr && snapshot->structure && snapshot->structure->boxes().empty() &&
        snapshot->structure->lines().empty()) {
      ui.faint("It has none to show.");
    }
  }

  static void drawDirections(PanelContext& context) {
    context.ui.heading("Look from");
    int column = 0;
    for (const auto& [direction, name] : kDirections.entries) {
      if (column++ % 4 != 0) ImGui::SameLine();
      if (context.ui.button(std::string(name).c_str())) context.view.lookFrom(direction);
    }
    if (context.ui.button("all of it", "Brings everything into the picture")) {
      context.view.lookAtAll();
    }
  }
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<ViewPanel>(); }

}  // namespace broadmark::panels::view_options
