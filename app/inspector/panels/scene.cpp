// The open source and its parameters; simulation of built-in scenes.

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
    const bool is_new = source_ != session.playback.source();
    source_ = session.playback.source();
    if (is_new) parameters_ = sceneParametersOf(source_.get());
    if (source_) drawOpen(draft_is_open);
    // Collapsed for other sources, to which the draft's parameters do not apply.
    if (is_new) {
      ImGui::SetNextItemOpen(!source_ || draft_is_open ||
                             source_->origin == FrameOrigin::simulation);
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
    ui.paragraph(sourceText(source_.get()));
    ui.note("open");
    if (draft_is_open) return;
    for (const auto& [name, value] : parameters_) ui.valueRow(name.c_str(), value);
    if (!parameters_.empty()) return;
    ui.faintParagraph(source_->origin == FrameOrigin::authored
                          ? "Its parameters are in the panel Author."
                          : "Parameters unknown.");
  }

  void drawDraft() {
    chooseScene();
    ImGui::Spacing();
    if (wideButton("Simulate",
                   "Restart the scene with these parameters; frames are simulated as they are "
                   "shown")) {
      session.notices.catchErrors([&] { session.draft.simulate(); });
    }
    ui.heading("Parameters");
    session.notices.catchErrors([&] { ui.parameters(session.draft.scene()); });
  }

  void chooseScene() {
    const std::vector<SceneListing> scenes = builtinScenes();
    std::vector<std::string> ids;
    for (const SceneListing& scene : scenes) ids.push_back(scene.id);
    const auto& current = session.draft.scene().listing().id;
    auto chosen = static_cast<std::size_t>(std::ranges::find(ids, current) - ids.begin());
    if (ui.combo("scene", chosen, ids, "Scene to simulate")) {
      session.notices.catchErrors([&] { session.draft.choose(ids[chosen]); });
    }
    if (chosen < scenes.size()) {
      ui.faintParagraph(scenes[chosen].summary);
    }
  }

  std::shared_ptr<const FrameProviderRequest> source_;  ///< the open source
  ParameterValues parameters_;                          ///< of the open source; empty if unknown
};

}  // namespace

extern const PanelSpec spec = {
    "Scene", DockArea::left, "Show the open source; choose, configure and simulate built-in scenes",
    make<ScenePanel>};

}  // namespace broadmark::panels::scene
