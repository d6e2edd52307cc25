// Interleaves the algorithms on the open scene frame by frame, and ranks them by their times.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "broadmark/statistics/statistics.h"
#include "compare/comparison.h"
#include "compare/duel_report.h"
#include "inspector/panels/panel.h"
#include "support/words.h"

namespace broadmark::panels::duel {
namespace {

constexpr float kTableShare = 0.68F;     // of the width; the rest is the histogram's
constexpr float kMinWidthForBoth = 560;  // units; a narrower panel shows one of both

class DuelPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    const BackgroundDuel::Report report = session.jobs.get<BackgroundDuel>().report();
    drawControls(report);
    if (report.state == TaskState::idle) {
      ui.paragraph(
          "Run two or more algorithms of the panel Algorithms in turns on the frames available so "
          "far, until their ratio is known within 1 % or time is up. Pause playback for accurate "
          "times.");
      return;
    }
    if (!report.result.ok()) return drawFailures(report.result);
    if (report.result.rounds() == 0) return;
    if (!report.result.ranking.empty()) ui.plain(verdictOf(report.result));
    const SplitPane parts{.share = kTableShare,
                          .min_width = kMinWidthForBoth * ui.scale,
                          .second_only = histogram_only_};
    if (!parts.both()) {
      ui.toggle("Histogram", histogram_only_, "Show the histogram of ratios instead of the table");
    }
    parts.draw([&] { drawTable(report.result); }, [&] { drawRatios(report.result); });
  }

 private:
  void drawControls(const BackgroundDuel::Report& report) {
    if (report.state == TaskState::running) {
      if (ui.button("Cancel", "Stop the duel without a verdict"))
        session.jobs.get<BackgroundDuel>().cancel();
      ImGui::SameLine();
      ImGui::AlignTextToFramePadding();
      ui.faint(fmt::format("{}, {:.0f} of at most {:.0f} s",
                           counted(report.result.rounds(), "round"), report.result.seconds,
                           report.max_seconds));
      return;
    }
    const bool ready = session.playback.source() && session.tracks.list.size() >= 2;
    if (ui.button("Start", "Start the duel", 0, ready)) {
      session.startDuel(max_seconds_);
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(60 * ui.scale);
    ui.entry("seconds", max_seconds_, 1, 3600, "Time after which the duel stops");
    ImGui::SameLine();
    ui.faint("s at most");
    if (report.state == TaskState::idle) return;
    const std::string rounds =
        fmt::format("{}: {} in {}", kTaskStates.nameOf(report.state),
                    counted(report.result.rounds(), "round"), waitingTime(report.result.seconds));
    Ui::sameLineIfFits(ImGui::CalcTextSize(rounds.c_str()).x);
    ui.faint(rounds);
    ui.note("rounds");
  }

  void drawFailures(const DuelResult& result) {
    for (const DuelResult::Side& side : result.sides) {
      if (side.status == Status::ok) continue;
      ui.coloured(ui.theme.bad,
                  fmt::format("{}: {}: {}", side.name, statusName(side.status), side.reason));
    }
  }

  /// Draws the ranking or, until there is one, the algorithms in their own order.
  void drawTable(const DuelResult& result) {
    if (!ui.beginTable("ranking", {"rank", "algorithm", "median", "min", "ratio", "95 % interval"},
                       2)) {
      return;
    }
    const auto rows = Ui::sortedRows(
        result.sides.size(), [&](std::size_t row, std::size_t column) -> Ui::SortKey {
          const std::size_t side = result.ranking.empty() ? row : result.ranking[row].side;
          const std::vector<double>& seconds = result.sides[side].seconds;
          if (column == 1) return result.sides[side].name;
          if (column == 2) return quantile(seconds, 0.5);
          if (column == 3) return quantile(seconds, 0);
          return static_cast<double>(row);
        });
    for (const std::size_t row : rows) {
      const DuelRank* rank = result.ranking.empty() ? nullptr : &result.ranking[row];
      drawSide(result, rank == nullptr ? row : rank->side, rank);
    }
    ui.endTable();
  }

  void drawSide(const DuelResult& result, std::size_t side, const DuelRank* rank) {
    const std::vector<double>& seconds = result.sides[side].seconds;
    const Estimate ratio = rank != nullptr ? rank->ratio : result.ratio(side, 0);
    ImGui::TableNextRow();
    ui.cell(rank == nullptr ? "" : fmt::format("{}.", rank->rank));
    ImGui::TableNextColumn();
    ImGui::PushID(static_cast<int>(side));
    if (ui.selectable(result.sides[side].name.c_str(), side == shown_,
                      "Show its ratios to the first algorithm in the histogram")) {
      shown_ = side;
    }
    ImGui::PopID();
    ui.cell(durationText(quantile(seconds, 0.5)));
    ui.cell(durationText(quantile(seconds, 0)));
    ui.cell(side == 0 ? "1" : fmt::format("{:.3f}", ratio.value));
    ui.cell(side == 0 ? "" : intervalText(ratio.ci95, 3));
  }

  /// Draws the histogram of the rounds' ratios, with a line at equal times.
  void drawRatios(const DuelResult& result) const {
    const std::size_t side = shown_ > 0 && shown_ < result.sides.size() ? shown_ : 1;
    ui.faint(fittingText(fmt::format("rounds by ratio of {}", result.sides[side].name),
                         ImGui::GetContentRegionAvail().x));
    const auto text = [](double ratio) { return fmt::format("{:.3f}", ratio); };
    drawHistogram(ui, result.ratios(side, 0), text, 1);
  }

  double max_seconds_ = 60;
  bool histogram_only_ = false;
  std::size_t shown_ = 1;  ///< the side in the histogram
};

}  // namespace

extern const PanelSpec spec = {
    "Duel", DockArea::bottom,
    "Interleave the algorithms on the open scene until the faster one is known", make<DuelPanel>};

}  // namespace broadmark::panels::duel
