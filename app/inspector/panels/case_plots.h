// Plots of a results file: times over the frames of the marked cases, or over the numbers of bodies
// of all listed cases.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "broadmark/render/point_plot.h"
#include "inspector/panels/panel.h"

namespace broadmark {

class CasePlots : PanelContext {
 public:
  explicit CasePlots(const PanelContext& context) : PanelContext(context) {}

  /// Draws the options, and the plot below.
  void draw(OpenedResults& results) {
    drawChoices();
    overBodies() ? drawBodies(results) : drawFrames(results);
  }

  /// Returns for each row the colour of its case's curve, if it has one.
  std::vector<std::optional<Rgb>> rowColours(const Palette& palette, OpenedResults& results) const {
    std::vector<std::vector<std::size_t>> rows_of_curves;
    if (overBodies()) {
      for (const ScalingCurve& curve : results.scaling(phase())) {
        auto& rows = rows_of_curves.emplace_back();
        for (const ScalingCurve::Point& point : curve.points) rows.push_back(point.row);
      }
    } else {
      for (const OpenedResults::Curve& curve : results.curves(phase())) {
        rows_of_curves.push_back({curve.row});
      }
    }
    std::vector<std::string_view> algorithms;
    for (const auto& rows : rows_of_curves) {
      algorithms.emplace_back(results.rows()[rows.front()].result.algorithm);
    }
    const std::vector<Rgb> colours = curveColours(algorithms, palette);
    std::vector<std::optional<Rgb>> by_row(results.rows().size());
    for (std::size_t i = 0; i < colours.size(); ++i) {
      for (const std::size_t row : rows_of_curves[i]) by_row[row] = colours[i];
    }
    return by_row;
  }

 private:
  static constexpr std::size_t kMaxCurves = 24;  // more are indistinguishable
  static constexpr float kPointRadius = 3;       // pixels, of the rectangle registered for a point

  using Row = OpenedResults::Row;

  /// Returns the first kMaxCurves curves; writes a note if others are left out.
  template <class Curve>
  std::span<const Curve> limited(const std::vector<Curve>& curves, const char* noun) {
    if (curves.size() > kMaxCurves) {
      ImGui::SameLine();
      ui.faint(fmt::format("the first {} of {} {}", kMaxCurves, curves.size(), noun));
    }
    return std::span(curves).first(std::min(kMaxCurves, curves.size()));
  }

  void drawChoices() {
    ui.combo("##phase", phase_, kPhases.names(), "Time to plot", 140 * ui.scale);
    ImGui::SameLine();
    ui.combo("##over", over_, {"over frames", "over bodies"},
             "Plot marked cases over frames, or all listed cases over numbers of bodies",
             100 * ui.scale);
    Ui::sameLineIfFits(100 * ui.scale);
    ui.checkbox("logarithmic", logarithmic_);
  }

  void drawFrames(OpenedResults& results) {
    if (results.curves(phase()).empty()) {
      ui.faintParagraph("Mark cases in the table to see their times over the frames.");
      return;
    }
    const auto curves = limited(results.curves(phase()), "marked");
    const Palette& theme = ui.theme;
    const FrameProviderRequest* open = session.playback.source().get();
    const bool is_open = open != nullptr && open->origin == FrameOrigin::results;
    std::vector<PlotCurve> plotted;
    PlotMarks wrong{.label = "wrong", .colour = theme.bad, .frames = {}};
    const auto& recording = results.rows()[curves.front().row].recording;
    const bool same_recording = std::ranges::all_of(curves, [&](const OpenedResults::Curve& curve) {
      return results.rows()[curve.row].recording == recording;
    });
    const auto colours = rowColours(theme, results);
    std::uint32_t last = 1;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const Row& row = results.rows()[curves[i].row];
      plotted.push_back({.label = same_recording ? row.algorithm : row.result.id,
                         .colour = *colours[curves[i].row],
                         .values = &curves[i].seconds,
                         .circled = nullptr});
      wrong.frames.push_back(&curves[i].mismatches);
      last = std::max(last, curves[i].seconds.size() - 1);
    }
    zoom_.update(nullptr, last, 0);
    plotFrames("plot", plotted,
               {.logarithmic = logarithmic_, .unit = "s", .span = {}, .marks = {wrong}}, zoom_,
               is_open);
  }

  void drawBodies(OpenedResults& results) {
    if (results.scaling(phase()).empty()) {
      ui.faintParagraph(
          "Open results of a scene with several numbers of bodies (--objects 1000,2000,4000) to "
          "see how times grow. Each algorithm needs two complete and correct cases of different "
          "sizes in the list.");
      return;
    }
    const auto curves = limited(results.scaling(phase()), "curves");
    const auto colours = rowColours(ui.theme, results);
    std::vector<PointCurve> plotted;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      PointCurve& curve = plotted.emplace_back();
      curve.label = fmt::format("{}  n^{:.2f}", curves[i].algorithm, curves[i].exponent);
      if (!curves[i].scene.empty()) curve.label += "  " + curves[i].scene;
      curve.colour = *colours[curves[i].points.front().row];
      for (const ScalingCurve::Point& point : curves[i].points) {
        curve.points.push_back(
            {.across = static_cast<double>(point.objects), .value = point.seconds});
      }
    }
    const auto row_of = [&](const DrawnPoint& point) -> Row& {
      return results.rows()[curves[point.curve].points[point.point].row];
    };
    const ImVec2 size = ImGui::GetContentRegionAvail();
    const PointPlotResult result = drawPointPlot("bodies", plotted,
                                                 {.logarithmic = logarithmic_,
                                                  .unit = "s",
                                                  .across = "bodies",
                                                  .shapes = ui.beginPlot("plot")},
                                                 size.x, size.y);
    ui.endPlot("plot");
    for (const DrawnPoint& point : result.drawn) {
      ui.noteAt("point/" + row_of(point).result.id,
                {point.at.x - kPointRadius, point.at.y - kPointRadius},
                {point.at.x + kPointRadius, point.at.y + kPointRadius});
    }
    if (result.clicked) session.openCase(row_of(*result.hovered));
  }

  [[nodiscard]] Phase phase() const { return kPhases.entries.at(phase_).value; }
  [[nodiscard]] bool overBodies() const { return over_ == 1; }

  std::size_t phase_ = kPhases.entries.size() - 1;  ///< the last: total
  std::size_t over_ = 0;                            ///< 0: frames; 1: bodies
  bool logarithmic_ = true;
  Timeline zoom_;  ///< range of the plotted frames
};

}  // namespace broadmark
