// Choosing a built-in scene and its parameters, and simulating it.

#include <algorithm>

#include "inspector/panel.h"

namespace broadmark::panels::scene {
namespace {

class ScenePanel final : public Panel {
 public:
  ScenePanel() : Panel("Scene", Place::left, "Built-in scenes: choose, adjust, simulate") {}

  void draw(PanelContext& context) override {
    Ui& ui = context.ui;
    Session& session = context.session;
    chooseScene(ui, session);
    ImGui::Spacing();
    if (ui.button("Simulate",
                  "Starts the scene anew with these parameters; frames are simulated "
                  "as they are watched",
                  ImGui::GetContentRegionAvail().x)) {
      session.notices.attempt([&] { session.simulate(); });
    }
    ui.heading("Parameters");
    session.notices.attempt([&] { ui.parameters(*session.draft); });
  }

 private:
  static void chooseScene(Ui& ui, Session& session) {
    const std::vector<SceneListing> scenes = builtinScenes();
    std::vector<std::string> ids;
    for (const SceneListing& scene : scenes) ids.push_back(scene.id);
    const auto& present = session.draft->listing().id;
    auto chosen = static_cast<std::size_t>(std::ranges::find(ids, present) - ids.begin());
    if (ui.combo("scene", chosen, ids, "What happens")) {
      session.notices.attempt([&] { session.chooseScene(ids[chosen]); });
    }
    if (chosen < scenes.size()) {
      ui.faintParagraph(scenes[chosen].summary);
    }
  }
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<ScenePanel>(); }

}  // namespace broadmark::panels::scene
