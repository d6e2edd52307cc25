// What is plotted of a results file: times over the frames of the marked cases, or over the numbers
// of bodies of all listed ones.
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

  /// The choices, and below them the plot.
  void draw(OpenedResults& results) {
    drawChoices();
    overBodies() ? drawBodies(results) : drawFrames(results);
  }

  /// By row: the colour of the curve that the case has or belongs to.
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
    std::vector<std::string_view> families;
    for (const auto& rows : rows_of_curves) {
      families.emplace_back(results.rows()[rows.front()].result.family);
    }
    const std::vector<Rgb> colours = curveColours(families, palette);
    std::vector<std::optional<Rgb>> by_row(results.rows().size());
    for (std::size_t i = 0; i < colours.size(); ++i) {
      for (const std::size_t row : rows_of_curves[i]) by_row[row] = colours[i];
    }
    return by_row;
  }

 private:
  static constexpr std::size_t kMaxCurves = 24;  // more are indistinguishable
  static constexpr float kPointPlace = 3;  // pixels around a point that are noted as its place

  using Row = OpenedResults::Row;

  /// As many as are plotted; says so where these are not all.
  template <class Curve>
  std::span<const Curve> firstOf(const std::vector<Curve>& curves, const char* which) {
    if (curves.size() > kMaxCurves) {
      ImGui::SameLine();
      ui.faint(fmt::format("the first {} of {} {}", kMaxCurves, curves.size(), which));
    }
    return std::span(curves).first(std::min(kMaxCurves, curves.size()));
  }

  void drawChoices() {
    ui.combo("##phase", phase_, kPhases.names(), "Which time is plotted", 140 * ui.scale);
    ImGui::SameLine();
    ui.combo("##over", over_, {"over frames", "over bodies"},
             "The marked cases over their frames, or all listed ones over their numbers of bodies",
             100 * ui.scale);
    Ui::besideIfRoom(100 * ui.scale);
    ui.checkbox("logarithmic", logarithmic_);
  }

  void drawFrames(OpenedResults& results) {
    if (results.curves(phase()).empty()) {
      ui.faintParagraph("Mark cases in the table to see their times over the frames.");
      return;
    }
    const auto curves = firstOf(results.curves(phase()), "marked");
    const Palette& theme = ui.theme;
    const FrameProviderRequest* open = session.playback.source().get();
    const bool is_open = open != nullptr && open->origin == FrameOrigin::results;
    std::vector<PlotCurve> plotted;
    PlotMarks wrong{.label = "wrong", .colour = theme.bad, .frames = {}};
    const auto& recording = results.rows()[curves.front().row].recording;
    const bool one_recording = std::ranges::all_of(curves, [&](const OpenedResults::Curve& curve) {
      return results.rows()[curve.row].recording == recording;
    });
    const auto colours = rowColours(theme, results);
    std::uint32_t last = 1;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const Row& row = results.rows()[curves[i].row];
      plotted.push_back({.label = one_recording ? row.algorithm : row.result.id,
                         .colour = *colours[curves[i].row],
                         .values = &curves[i].seconds,
                         .circled = nullptr});
      wrong.frames.push_back(&curves[i].mismatches);
      last = std::max(last, curves[i].seconds.size() - 1);
    }
    zoom_.follow(nullptr, last, 0);
    plotFrames("plot", plotted,
               {.logarithmic = logarithmic_, .unit = "s", .span = {}, .marks = {wrong}}, zoom_,
               is_open);
  }

  void drawBodies(OpenedResults& results) {
    if (results.scaling(phase()).empty()) {
      ui.faintParagraph(
          "Open results of a scene in several numbers of bodies (--objects 1000,2000,4000) to see "
          "how "
          "times grow. Of each algorithm two listed cases of different sizes are needed, complete "
          "and "
          "right.");
      return;
    }
    const auto curves = firstOf(results.scaling(phase()), "curves");
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
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const PointPlotResult done = drawPointPlot(
        "bodies", plotted, {.logarithmic = logarithmic_, .unit = "s", .across = "bodies"}, room.x,
        room.y);
    ui.note("plot");
    for (const DrawnPoint& point : done.drawn) {
      ui.noteAt("point/" + row_of(point).result.id,
                {point.at.x - kPointPlace, point.at.y - kPointPlace},
                {point.at.x + kPointPlace, point.at.y + kPointPlace});
    }
    if (done.clicked) session.openCase(row_of(*done.hovered));
  }

  [[nodiscard]] Phase phase() const { return kPhases.entries.at(phase_).value; }
  [[nodiscard]] bool overBodies() const { return over_ == 1; }

  std::size_t phase_ = kPhases.entries.size() - 1;  ///< the last: total
  std::size_t over_ = 0;                            ///< 0: frames; 1: bodies
  bool logarithmic_ = true;
  Timeline zoom_;  ///< of the frames
};

}  // namespace broadmark
