// Plots in panels: their names, and how they are saved.
#include <fmt/format.h>

#include <algorithm>

#include "inspector/ui/svg.h"
#include "inspector/ui/ui.h"

namespace broadmark {

std::vector<PlotShape>* Ui::beginPlot(std::string_view label) {
  if (fullName(label) != svg_of_) return nullptr;
  shapes_.clear();
  return &shapes_;
}

void Ui::endPlot(std::string_view label) {
  constexpr float kClickPixels = 3;  // a press with less movement is a click
  note(label);
  const std::string name = plots_.emplace_back(fullName(label));
  if (name == svg_of_) svg_ = formatSvg(shapes_, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const std::string menu = fmt::format("{} menu", label);
  if (ImGui::IsItemHovered()) {
    hovered_plot_ = name;
    const float moved = ImGui::GetIO().MouseDragMaxDistanceSqr[1];
    if (ImGui::IsMouseReleased(1) && moved < kClickPixels * kClickPixels) {
      ImGui::OpenPopup(menu.c_str());
    }
  }
  if (!ImGui::BeginPopup(menu.c_str())) return;
  if (menuItem("Save plot…") && on_save_plot) on_save_plot(name);
  ImGui::EndPopup();
}

std::string Ui::plotInUse() const {
  if (former_plots_.empty()) return "";
  const bool is_drawn = std::ranges::find(former_plots_, hovered_plot_) != former_plots_.end();
  return is_drawn ? hovered_plot_ : former_plots_.front();
}

}  // namespace broadmark
