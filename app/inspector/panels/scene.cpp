// What is open and with which parameters, and simulating a built-in scene.

#include <algorithm>
#include <memory>
#include <string>

#include "inspector/panels/panel.h"
#include "inspector/session/answer_text.h"

namespace broadmark::panels::scene {
namespace {

class ScenePanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    const bool draft_is_open = session.draft.isOpen();
    const bool is_new = seen_ != session.playback.source();
    seen_ = session.playback.source();
    if (is_new) parameters_ = sceneParametersOf(session.playback.source().get());
    if (seen_) drawOpen(draft_is_open);
    // The parameters of a simulation that might be are not to be taken for those of what is open.
    if (is_new) {
      ImGui::SetNextItemOpen(!seen_ || draft_is_open || seen_->origin == FrameOrigin::simulation);
    }
    const bool open =
        ImGui::CollapsingHeader(draft_is_open ? "Its parameters###draft" : "New simulation###draft",
                                ImGuiTreeNodeFlags_DefaultOpen);
    ui.note("draft");
    if (!open) return;
    drawDraft();
  }

 private:
  void drawOpen(bool draft_is_open) const {
    ui.heading("Open");
    ui.paragraph(sourceText(seen_.get()));
    ui.note("open");
    if (draft_is_open) return;
    for (const auto& [name, value] : parameters_) ui.fact(name.c_str(), value);
    if (!parameters_.empty()) return;
    ui.faintParagraph(seen_->origin == FrameOrigin::authored
                          ? "Its parameters stand in the panel Author."
                          : "With which parameters it was made is not known.");
  }

  void drawDraft() {
    chooseScene();
    ImGui::Spacing();
    if (wideButton("Simulate",
                   "Restarts the scene with these parameters; frames are simulated as they are "
                   "shown")) {
      session.notices.attempt([&] { session.draft.simulate(); });
    }
    ui.heading("Parameters");
    session.notices.attempt([&] { ui.parameters(session.draft.scene()); });
  }

  void chooseScene() {
    const std::vector<SceneListing> scenes = builtinScenes();
    std::vector<std::string> ids;
    for (const SceneListing& scene : scenes) ids.push_back(scene.id);
    const auto& present = session.draft.scene().listing().id;
    auto chosen = static_cast<std::size_t>(std::ranges::find(ids, present) - ids.begin());
    if (ui.combo("scene", chosen, ids, "What happens")) {
      session.notices.attempt([&] { session.draft.choose(ids[chosen]); });
    }
    if (chosen < scenes.size()) {
      ui.faintParagraph(scenes[chosen].summary);
    }
  }

  std::shared_ptr<const FrameProviderRequest> seen_;  ///< what was open in the last picture
  ParameterValues parameters_;                        ///< of the open scene; empty if unknown
};

}  // namespace

extern const PanelKind kind = {"Scene", DockArea::left,
                               "What is open; built-in scenes: choose, adjust, simulate",
                               make<ScenePanel>};

}  // namespace broadmark::panels::scene
