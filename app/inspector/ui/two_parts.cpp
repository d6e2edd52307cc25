#include "inspector/ui/two_parts.h"

#include <imgui.h>

namespace broadmark {

bool TwoParts::both() const { return ImGui::GetContentRegionAvail().x >= narrowest; }

void TwoParts::draw(const std::function<void()>& first, const std::function<void()>& second) const {
  const bool both = this->both();
  const float width = ImGui::GetContentRegionAvail().x;
  const auto part = [](const char* id, float extent, const std::function<void()>& draw_it) {
    ImGui::BeginChild(id, {extent, 0}, false, ImGuiWindowFlags_NavFlattened);
    draw_it();
    ImGui::EndChild();
  };
  if (both || !second_alone) part("first", both ? share * width : 0, first);
  if (both) ImGui::SameLine();
  if (both || second_alone) part("second", 0, second);
}

}  // namespace broadmark
