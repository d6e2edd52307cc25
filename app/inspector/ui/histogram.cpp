#include "inspector/ui/histogram.h"

#include <algorithm>

#include "broadmark/statistics/statistics.h"

namespace broadmark {
namespace {

constexpr std::size_t kBins = 48;

}  // namespace

void drawHistogram(Ui& ui, std::span<const double> values,
                   const std::function<std::string(double)>& text, std::optional<double> line) {
  if (values.empty()) return;
  const Histogram histogram = histogramOf(values, kBins);
  if (histogram.counts.empty()) return;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float letters = ImGui::GetTextLineHeight();
  const ImVec2 size = {ImGui::GetContentRegionAvail().x,
                       std::max(ImGui::GetContentRegionAvail().y - letters, letters)};
  const float bottom = corner.y + size.y;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto most = static_cast<float>(*std::ranges::max_element(histogram.counts));
  const float width = size.x / static_cast<float>(kBins);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const float left = corner.x + width * static_cast<float>(bin);
    const float height = size.y * static_cast<float>(histogram.counts[bin]) / most;
    draw.AddRectFilled({left, bottom - height}, {left + width - 1, bottom},
                       colour(ui.theme.accent));
  }
  if (line && histogram.low < *line && *line < histogram.high) {
    const double share = (*line - histogram.low) / (histogram.high - histogram.low);
    const float x = corner.x + size.x * static_cast<float>(share);
    draw.AddLine({x, corner.y}, {x, bottom}, colour(ui.theme.warning), 2 * ui.scale);
  }
  const auto label = [&](double value, float share) {
    const std::string number = text(value);
    const float extent = ImGui::CalcTextSize(number.c_str()).x;
    draw.AddText({corner.x + share * (size.x - extent), bottom}, colour(ui.theme.faint),
                 number.c_str());
    return extent;
  };
  const float ends = label(histogram.low, 0) + label(histogram.high, 1);
  const bool room = size.x > 2 * ends;
  if (room) label((histogram.low + histogram.high) / 2, 0.5F);
  ImGui::Dummy(size);
  ui.note("histogram");
}

}  // namespace broadmark
