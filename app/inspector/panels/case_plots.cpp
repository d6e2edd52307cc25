#include "inspector/panels/case_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "broadmark/render/plot.h"
#include "broadmark/render/point_plot.h"
#include "inspector/ui/curve_colours.h"

namespace broadmark {
namespace {

constexpr std::size_t kMostCurves = 24;  // more could not be told apart
constexpr float kPointPlace = 3;         // pixels around a point that are noted as its place

using Row = OpenedResults::Row;

Rgb colourOfCurve(const Ui& ui, std::size_t curve) {
  return curveColour(static_cast<int>(curve) + 1, ui.theme.dark);
}

/// As many as are plotted; says so where these are not all.
template <class Curve>
std::span<const Curve> firstOf(Ui& ui, const std::vector<Curve>& curves, const char* which) {
  if (curves.size() > kMostCurves) {
    ImGui::SameLine();
    ui.faint(fmt::format("the first {} of {} {}", kMostCurves, curves.size(), which));
  }
  return std::span(curves).first(std::min(kMostCurves, curves.size()));
}

}  // namespace

std::optional<Rgb> CasePlots::colourOf(const Ui& ui, OpenedResults& results,
                                       std::size_t row) const {
  const auto colour_at = [&](const auto& curves, const auto& isOf) -> std::optional<Rgb> {
    const auto found = std::ranges::find_if(curves, isOf);
    if (found == curves.end()) return {};
    return colourOfCurve(ui, static_cast<std::size_t>(found - curves.begin()));
  };
  if (!overBodies()) {
    return colour_at(results.curves(phase()),
                     [&](const OpenedResults::Curve& curve) { return curve.row == row; });
  }
  return colour_at(results.scaling(phase()), [&](const ScalingCurve& curve) {
    return std::ranges::find(curve.points, row, &ScalingPoint::row) != curve.points.end();
  });
}

void CasePlots::draw(PanelContext& context, OpenedResults& results) {
  drawChoices(context.ui);
  overBodies() ? drawBodies(context, results) : drawFrames(context, results);
}

void CasePlots::drawChoices(Ui& ui) {
  ui.combo("##phase", phase_, kPhases.names(), "Which time is plotted", 140 * ui.scale);
  ImGui::SameLine();
  ui.combo("##over", over_, {"over frames", "over bodies"},
           "The marked cases over their frames, or all listed ones over their numbers of bodies",
           100 * ui.scale);
  Ui::besideIfRoom(100 * ui.scale);
  ui.checkbox("logarithmic", logarithmic_);
}

void CasePlots::drawFrames(PanelContext& context, OpenedResults& results) {
  if (results.curves(phase()).empty()) {
    context.ui.faintParagraph("Mark cases in the table to see their times over the frames.");
    return;
  }
  const auto curves = firstOf(context.ui, results.curves(phase()), "marked");
  const Theme& theme = context.ui.theme;
  const FootageRequest* open = context.session.playback.footage().get();
  const bool is_open = open != nullptr && open->source == FootageSource::results;
  std::vector<PlotCurve> plotted;
  PlotMarks wrong{.label = "wrong", .colour = theme.bad, .frames = {}};
  const auto& recording = results.rows()[curves.front().row].recording;
  const bool one_recording = std::ranges::all_of(curves, [&](const OpenedResults::Curve& curve) {
    return results.rows()[curve.row].recording == recording;
  });
  std::uint32_t last = 1;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Row& row = results.rows()[curves[i].row];
    plotted.push_back({.label = one_recording ? row.algorithm : row.result.id,
                       .colour = colourOfCurve(context.ui, i),
                       .values = &curves[i].seconds,
                       .circled = nullptr});
    wrong.frames.push_back(&curves[i].mismatches);
    last = std::max(last, curves[i].seconds.size() - 1);
  }
  zoom_.follow(nullptr, last, 0);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const PlotResult done = drawPlot("plot", plotted,
                                   {.logarithmic = logarithmic_,
                                    .unit = "s",
                                    .first = zoom_.first(),
                                    .last = zoom_.last(),
                                    .playhead = is_open ? context.session.playback.frame() : 0,
                                    .span = {},
                                    .marks = {wrong}},
                                   room.x, room.y);
  context.ui.note("plot");
  if (done.zoom != 0) zoom_.zoom(done.zoom, done.zoom_at);
  if (done.moved != 0) zoom_.move(done.moved);
  if (done.clicked_frame && is_open) {
    context.session.playback.goTo(std::llround(*done.clicked_frame));
  }
}

void CasePlots::drawBodies(PanelContext& context, OpenedResults& results) const {
  Ui& ui = context.ui;
  if (results.scaling(phase()).empty()) {
    ui.faintParagraph(
        "Open results of a scene in several numbers of bodies (--objects 1000,2000,4000) to see "
        "how "
        "times grow. Of each algorithm two listed cases of different sizes are needed, complete "
        "and "
        "right.");
    return;
  }
  const auto curves = firstOf(ui, results.scaling(phase()), "curves");
  std::vector<PointCurve> plotted;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    PointCurve& curve = plotted.emplace_back();
    curve.label = fmt::format("{}  n^{:.2f}", curves[i].algorithm, curves[i].exponent);
    if (!curves[i].scene.empty()) curve.label += "  " + curves[i].scene;
    curve.colour = colourOfCurve(ui, i);
    for (const ScalingPoint& point : curves[i].points) {
      curve.points.push_back(
          {.across = static_cast<double>(point.objects), .value = point.seconds});
    }
  }
  const auto row_of = [&](const DrawnPoint& point) -> Row& {
    return results.rows()[curves[point.curve].points[point.point].row];
  };
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const PointPlotResult done =
      drawPointPlot("bodies", plotted,
                    {.logarithmic = logarithmic_, .unit = "s", .across = "bodies"}, room.x, room.y);
  ui.note("plot");
  for (const DrawnPoint& point : done.drawn) {
    ui.noteAt("point/" + row_of(point).result.id,
              {point.at.x - kPointPlace, point.at.y - kPointPlace},
              {point.at.x + kPointPlace, point.at.y + kPointPlace});
  }
  if (done.clicked) context.session.opener.openCase(row_of(*done.hovered));
}

}  // namespace broadmark
