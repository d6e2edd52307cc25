#include "inspector/views/views.h"

#include <vector>

namespace broadmark {

void Views::draw(Ui& ui, Session& session, const RunProgress& progress, ImVec2 position,
                 ImVec2 size) {
  std::vector<View::Shown> shown = {{.name = "View",
                                     .snapshot = progress.snapshot,
                                     .hint = "Simulate a scene, or drop a recording here",
                                     .lane = session.lanes.shown(),
                                     .has_hands = true}};
  if (session.second.wish) {
    const std::string& failure = progress.second_failure;
    shown.push_back({.name = "Second view",
                     .snapshot = progress.second,
                     .hint = failure.empty() ? "Nothing is shown yet" : failure,
                     .lane = session.second.wish->lane,
                     .leader = session.second.linked ? &first() : nullptr});
  }
  const auto count = static_cast<float>(shown.size());
  const float gap = kSplitterSize * ui.scale;
  const float width = std::max((size.x - (count - 1) * gap) / count, 1.0F);
  // Each view with a camera of its own flies there.
  const std::optional<BodySelection::Bodies> fly_to = session.selection.fly_to;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  for (std::size_t i = 0; i < shown.size(); ++i) {
    View& view = list_[i];
    const View::Shown& what = shown[i];
    if (what.leader == nullptr && !session.selection.fly_to) session.selection.fly_to = fly_to;
    beginAt(what.name, {position.x + static_cast<float>(i) * (size.x - width), position.y},
            {width, size.y}, ImGuiWindowFlags_NoScrollbar);
    view.draw(ui, session, progress, what);
    ImGui::End();
    if (what.leader != nullptr && view.moved()) first().follow(view);
  }
  ImGui::PopStyleVar();
}

}  // namespace broadmark
