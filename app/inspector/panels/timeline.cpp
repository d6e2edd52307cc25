// Live plot of the whole recording: times, pairs, bodies, marks at wrong and disturbed frames.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/statistics/statistics.h"
#include "inspector/panels/panel.h"
#include "inspector/session/track_statistics.h"
#include "support/words.h"

namespace broadmark::panels::timeline {
namespace {

constexpr float kPlotShare = 0.56F;      // of the width; a span's statistics get the rest
constexpr float kMinWidthForBoth = 600;  // units; a narrower panel shows one of both
constexpr std::array kShares = {0.5, 0.05, 0.95, 0.99, 1.0};  // of the quantiles in the table

class TimelinePanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (progress->tracks.empty()) {
      ui.faintParagraph(
          "Add algorithms in the panel Algorithms to see their frame times as curves.");
    }
    if (!progress->source) return;
    drawControls();
    const auto curves = [&] { drawCurves(); };
    // Statistics appear once the mouse is released: they move the plot, and a drag over it would
    // end at another frame.
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) || !session.timeline.span()) {
      shows_span_ = session.timeline.span().has_value();
    }
    if (!shows_span_ || progress->tracks.empty()) {
      curves();
      return;
    }
    const SplitPane parts{
        .share = kPlotShare, .min_width = kMinWidthForBoth * ui.scale, .second_only = span_only_};
    if (!parts.both()) {
      Ui::sameLineIfFits(50 * ui.scale);
      ui.toggle("Span", span_only_, "Show the span's statistics instead of the curves");
    }
    parts.draw(curves, [&] { drawSpan(); });
  }

 private:
  void drawControls() {
    Timeline& timeline = session.timeline;
    std::vector<std::string> names = {"pairs"};
    for (const std::string& phase : kPhases.names()) names.push_back(phase);
    ui.combo("##quantity", quantity_, names, "Quantity to plot", 150 * ui.scale);
    Ui::sameLineIfFits(110 * ui.scale);
    ui.checkbox("logarithmic", logarithmic_);
    Ui::sameLineIfFits(65 * ui.scale);
    ui.checkbox("pairs", shows_pairs_,
                "Plot the number of overlapping pairs as a thin line, with its scale on the right");
    if (progress->population.size() > 0) {
      Ui::sameLineIfFits(75 * ui.scale);
      ui.checkbox("bodies", shows_bodies_, "Plot the number of bodies present as an area");
    }
    Ui::sameLineIfFits(90 * ui.scale);
    if (ui.button("All frames", "Reset the zoom", 0, timeline.zoomed())) {
      timeline.showAll();
    }
    Ui::sameLineIfFits(240 * ui.scale);
    drawBudget();
  }

  void drawBudget() {
    ImGui::AlignTextToFramePadding();
    ui.faint("budget");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(60 * ui.scale);
    ui.entry("budget", session.timeline.budget_ms, 0, 1e5,
             "Frame budget in milliseconds, drawn as a line in the plot; 0: none");
    ImGui::SameLine();
    std::uint64_t over = 0;
    for (const TrackReport& track : progress->tracks) {
      if (session.timeline.budget_ms > 0) over += framesOver(track, session.timeline.budget_ms);
    }
    ui.faint(fmt::format("ms: {} over", counted(over, "frame")));
    ui.note("over");
  }

  /// Draws the statistics of the algorithms in the selected span.
  void drawSpan() {
    Timeline& timeline = session.timeline;
    if (!timeline.span()) return;  // cleared in this picture
    const auto [first, last] = *timeline.span();
    ui.plain(fmt::format("frames {} to {}", first, last));
    ImGui::SameLine();
    if (ui.button("Show", "Zoom to the span")) timeline.showSpan();
    ImGui::SameLine();
    if (ui.button("Clear", "Clear the span (Escape)")) timeline.clearSpan();
    summarise({first, last});
    drawStatistics();
    const std::vector<TrackReport>& tracks = progress->tracks;
    const TrackReport* const shown = findTrack(tracks, session.tracks.shown());
    const std::ptrdiff_t index = shown == nullptr ? 0 : shown - tracks.data();
    drawHistogram(ui, statistics_.at(static_cast<std::size_t>(index)).values,
                  [this](double value) { return valueText(value); });
  }

  /// Throttled, because sorting long spans takes a while.
  void summarise(FrameSpan span) {
    const auto& tracks = progress->tracks;
    if (!throttle_.isDue({span, tracks.size()})) return;
    statistics_.clear();
    for (const TrackReport& track : tracks) {
      statistics_.push_back(statisticsOf(valuesOf(track), track.curves.disturbed, span));
    }
  }

  /// The column's statistics, in the order of the headings.
  [[nodiscard]] Ui::SortKey sortKey(std::size_t track, std::size_t column) const {
    if (column == 0) return caseName(progress->tracks[track].spec.test_case);
    const SpanStatistics& span = statistics_[track];
    if (column > kShares.size() + 1) return static_cast<double>(span.values.size());
    if (span.values.empty()) return -1.0;
    return column > kShares.size() ? span.total : quantile(span.values, kShares[column - 1]);
  }

  void drawStatistics() const {
    const std::vector<TrackReport>& tracks = progress->tracks;
    const std::vector<Rgb> colours = trackColours();
    const float height =
        ImGui::GetTextLineHeightWithSpacing() * 1.3F * (static_cast<float>(tracks.size()) + 1.8F);
    if (!ui.beginTable("statistics",
                       {"algorithm", "median", "5 %", "95 %", "99 %", "max", "sum", "frames"}, 1,
                       height)) {
      return;
    }
    const auto rows = Ui::sortedRows(
        tracks.size(), [&](std::size_t row, std::size_t column) { return sortKey(row, column); });
    for (const std::size_t i : rows) {
      const SpanStatistics& span = statistics_[i];
      ImGui::TableNextRow();
      ui.cell(caseName(tracks[i].spec.test_case), colours[i]);
      for (const double share : kShares) {
        ui.cell(span.values.empty() ? "–" : valueText(quantile(span.values, share)));
      }
      ui.cell(span.values.empty() ? "–" : valueText(span.total));
      ui.cell(std::to_string(span.values.size()));
      if (span.disturbed > 0) {
        ui.tooltip(fmt::format("and {} left out as disturbed", span.disturbed).c_str());
      }
    }
    ui.endTable();
  }

  [[nodiscard]] std::string valueText(double value) const {
    return withPrefix(value, quantity_ == 0 ? "" : "s");
  }

  /// Returns the plotted quantity.
  [[nodiscard]] const FrameValues& valuesOf(const TrackReport& track) const {
    return quantity_ == 0 ? track.curves.pairs : track.curves.seconds[quantity_ - 1];
  }

  void drawCurves() {
    const Palette& theme = ui.theme;
    Timeline& timeline = session.timeline;
    std::vector<PlotCurve> curves;
    PlotMarks wrong{.label = "wrong", .colour = theme.bad, .frames = {}};
    PlotMarks disturbed{.label = "disturbed", .colour = theme.warning, .frames = {}};
    const std::vector<Rgb> colours = trackColours();
    for (const TrackReport& track : progress->tracks) {
      curves.push_back({.label = caseName(track.spec.test_case),
                        .colour = colours[curves.size()],
                        .values = &valuesOf(track),
                        .circled = &track.curves.disturbed,
                        .hidden = hidden_.contains(track.spec.number)});
      wrong.frames.push_back(&track.curves.mismatches);
      disturbed.frames.push_back(&track.curves.disturbed);
    }
    const PlotCurve pairs{.label = "pairs", .colour = theme.text, .values = &progress->pairs};
    const PlotCurve bodies{
        .label = "bodies", .colour = theme.faint, .values = &progress->population};
    std::optional<std::array<double, 2>> span;
    if (timeline.span())
      span = {{static_cast<double>(timeline.span()->first),
               static_cast<double>(timeline.span()->last)}};
    const PlotOptions options{
        .logarithmic = logarithmic_,
        .unit = quantity_ == 0 ? "" : "s",
        .limit = quantity_ == 0 ? 0 : timeline.budget_ms * 1e-3,
        .limit_colour = theme.warning,
        .span = span,
        .area = shows_bodies_ && bodies.values->size() > 0 ? &bodies : nullptr,
        .thin = shows_pairs_ ? &pairs : nullptr,
        .marks = {wrong, disturbed}};
    const PlotResult result = plotFrames("plot", curves, options, timeline);
    if (result.dragged) timeline.select((*result.dragged)[0], (*result.dragged)[1]);
    if (result.toggled) toggle(progress->tracks[*result.toggled].spec.number);
  }

  void toggle(int track) {
    if (hidden_.erase(track) == 0) hidden_.insert(track);
  }

  std::size_t quantity_ = kPhases.entries.size();  ///< 0: pairs; then phases, total last
  bool logarithmic_ = true;
  bool shows_pairs_ = true;
  bool shows_bodies_ = true;
  bool span_only_ = false;
  bool shows_span_ = false;
  std::set<int> hidden_;
  std::vector<SpanStatistics> statistics_;                       ///< by track
  SummaryThrottle<std::pair<FrameSpan, std::size_t>> throttle_;  ///< by span and number of tracks
};

}  // namespace

extern const PanelSpec spec = {
    "Timeline", DockArea::bottom,
    "Times of all algorithms over the whole recording, pairs and bodies, and marks at wrong and "
    "disturbed frames",
    make<TimelinePanel>};

}  // namespace broadmark::panels::timeline
