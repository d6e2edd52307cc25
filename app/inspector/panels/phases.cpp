// Where the time goes: the phases of each algorithm, stacked over the frames, and their means.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inspector/panels/panel.h"
#include "inspector/session/track_statistics.h"
#include "inspector/ui/terms.h"

namespace broadmark::panels::phases {
namespace {

constexpr float kMeansWidth = 400;       // units, of the table without its first column
constexpr float kMinStackShare = 0.35F;  // of the width
constexpr float kMinWidthForBoth = 640;  // units; a narrower panel shows one of both
constexpr float kMinStackHeight = 42;    // units
constexpr float kShading = 0.4F;         // of a cell that has all the time of its row

/// The phases that add up to the total; a colour each.
constexpr std::size_t kStacked = std::tuple_size_v<decltype(Palette::phase)>;

class PhasesPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (progress->tracks.empty()) {
      ui.paragraph(
          "Add algorithms in the panel Algorithms to see which phase of which frame takes their "
          "time.");
      return;
    }
    if (!progress->source) return;
    chooseColours();
    summarise();
    const float rest = 1 - tableWidth() / ImGui::GetContentRegionAvail().x;
    const SplitPane parts{.share = std::max(rest, kMinStackShare),
                          .min_width = kMinWidthForBoth * ui.scale,
                          .second_only = means_only_};
    drawControls(parts.both());
    parts.draw([&] { drawStacks(); }, [&] { drawMeans(); });
  }

 private:
  /// The means of a track, by phase; nothing without undisturbed frames.
  struct Means {
    std::array<std::optional<double>, kPhases.entries.size()> seconds;
    std::optional<std::uint32_t> slowest;  ///< frame
  };

  [[nodiscard]] float tableWidth() const {
    float name = 0;
    for (const TrackReport& track : progress->tracks) {
      name = std::max(name, ImGui::CalcTextSize(caseName(track.spec.test_case).c_str()).x);
    }
    return name + kMeansWidth * ui.scale;
  }

  [[nodiscard]] FrameSpan span() const {
    return session.timeline.span().value_or(
        FrameSpan{1, std::max(session.playback.lastFrame(), 1U)});
  }

  /// Throttled, because long spans take a while.
  void summarise() {
    const auto& tracks = progress->tracks;
    if (!throttle_.isDue({span(), tracks.size()})) return;
    if (means_.size() != tracks.size()) {
      order_.resize(tracks.size());
      std::iota(order_.begin(), order_.end(), 0);
    }
    means_.clear();
    for (const TrackReport& track : tracks) {
      Means& means = means_.emplace_back();
      for (const auto& [phase, name] : kPhases.entries) {
        means.seconds[static_cast<std::size_t>(phase)] = meanSeconds(track, phase, span());
      }
      means.slowest = slowestFrame(track, span());
    }
  }

  static const FrameValues& totals(const TrackReport& track) { return track.curves.seconds.back(); }

  void drawControls(bool both) {
    for (std::size_t i = 0; i < kStacked; ++i) {
      const std::string name(kPhases.entries.at(i).name);
      const float line = ImGui::GetTextLineHeight();
      if (i > 0) Ui::sameLineIfFits(1.2F * line + ImGui::CalcTextSize(name.c_str()).x);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float top = at.y + ImGui::GetStyle().FramePadding.y + 0.15F * line;
      ImGui::GetWindowDrawList()->AddRectFilled(
          {at.x, top}, {at.x + 0.7F * line, top + 0.7F * line}, colour(ui.theme.phase.at(i)), 3);
      ImGui::Dummy({line, ImGui::GetFrameHeight()});
      ImGui::SameLine(0, 0.2F * line);
      ImGui::AlignTextToFramePadding();
      ui.plain(name);
      ui.tooltip(termDoc(name));
    }
    Ui::sameLineIfFits(90 * ui.scale);
    ui.checkbox("one scale", one_scale_, "Draw all algorithms at the scale of the slowest");
    if (session.timeline.zoomed()) {
      Ui::sameLineIfFits(90 * ui.scale);
      if (ui.button("All frames", "Reset the zoom")) session.timeline.showAll();
    }
    if (!both) {
      Ui::sameLineIfFits(60 * ui.scale);
      ui.toggle("Means", means_only_, "Show the means instead of the frames");
    }
    Ui::sameLineIfFits(170 * ui.scale);
    ImGui::AlignTextToFramePadding();
    ui.faint(fmt::format("means of frames {} to {}", span().first, span().last));
    ui.tooltip("Drag over the frames to select others; Escape selects all");
  }

  void drawStacks() {
    const float all = ImGui::GetContentRegionAvail().y;
    const auto count = static_cast<float>(order_.size());
    const float gaps = (count - 1) * ImGui::GetStyle().ItemSpacing.y;
    const float height = std::max((all - gaps) / count, kMinStackHeight * ui.scale);
    double highest = 0;
    for (const TrackReport& track : progress->tracks) {
      const float high = totals(track).within(0, totals(track).size()).high;
      if (one_scale_ && high > highest) highest = high;
    }
    for (const std::size_t index : order_) {
      const TrackReport& track = progress->tracks[index];
      ImGui::PushID(track.spec.number);
      ImGui::BeginChild("stack", {0, height}, false,
                        ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
      drawStack(track, highest, index == order_.back());
      ImGui::EndChild();
      ImGui::PopID();
    }
  }

  void drawStack(const TrackReport& track, double highest, bool last) {
    Timeline& timeline = session.timeline;
    std::vector<PlotCurve> curves;
    for (std::size_t i = 0; i < kStacked; ++i) {
      curves.push_back({.label = std::string(kPhases.entries.at(i).name),
                        .colour = ui.theme.phase.at(i),
                        .values = &track.curves.seconds.at(i)});
    }
    PlotOptions options{.stack_total = &totals(track),
                        .least_top = highest,
                        .title = caseName(track.spec.test_case),
                        .frame_numbers = last};
    if (timeline.span()) {
      options.span = {{static_cast<double>(timeline.span()->first),
                       static_cast<double>(timeline.span()->last)}};
    }
    const auto inside = ui.scope(track.spec.test_case.algorithm.id);
    const PlotResult result = plotFrames("plot", curves, options, timeline);
    if (result.dragged) timeline.select((*result.dragged)[0], (*result.dragged)[1]);
    if (result.clicked_frame) showCost(track.spec.number, session.playback.frame());
  }

  /// Shows what an algorithm does in a frame: its cells, and the tests of each body.
  void showCost(int track, std::uint32_t frame) {
    session.playback.goTo(frame);
    session.tracks.show(track);
    session.display.structure = session.display.structure_population = true;
    session.display.colourBy("tests");
    chooses_colours_ = true;
  }

  /// If the frame's algorithm does not report its tests, its pairs tell where the bodies crowd.
  void chooseColours() {
    if (!chooses_colours_ || !session.playback.hasReached(*progress)) return;
    const Snapshot& snapshot = *progress->snapshot;
    if (snapshot.track != session.tracks.shown() || !snapshot.structure) return;
    chooses_colours_ = false;
    if (snapshot.structure->tests().empty() && session.display.colourMode().of_tests) {
      session.display.colourBy("overlaps");
    }
  }

  [[nodiscard]] std::vector<std::string> columnNames() const {
    std::vector<std::string> names = {"algorithm", "total"};
    for (const auto& [phase, name] : kPhases.entries) {
      const auto has_time = [index = static_cast<std::size_t>(phase)](const Means& means) {
        return means.seconds.at(index).value_or(0) > 0;
      };
      const bool stacked = static_cast<std::size_t>(phase) < kStacked;
      if (phase != Phase::total && (stacked || std::ranges::any_of(means_, has_time))) {
        names.emplace_back(name);
      }
    }
    return names;
  }

  void drawMeans() {
    const std::vector<TrackReport>& tracks = progress->tracks;
    const std::vector<std::string> columns = columnNames();
    if (!ui.beginTable("means", columns, 1)) return;
    order_ = Ui::sortedRows(tracks.size(), [&](std::size_t row, std::size_t column) -> Ui::SortKey {
      const Means& means = means_[row];
      if (column == 0) return caseName(tracks[row].spec.test_case);
      return means.seconds.at(indexOf(columns.at(column))).value_or(-1);
    });
    for (const std::size_t row : order_) drawRow(tracks[row], means_[row], columns);
    ui.endTable();
  }

  static std::size_t indexOf(const std::string& phase) {
    return static_cast<std::size_t>(*kPhases.find(phase));
  }

  void drawRow(const TrackReport& track, const Means& means,
               const std::vector<std::string>& columns) {
    ImGui::TableNextRow();
    ImGui::PushID(track.spec.number);
    ImGui::TableNextColumn();
    const bool shown = session.tracks.shown() == track.spec.number;
    const std::string label = fmt::format("{}###mean of {}", caseName(track.spec.test_case),
                                          track.spec.test_case.algorithm.id);
    if (ui.selectable(label.c_str(), shown, "Go to its slowest frame, with cells and heat map") &&
        means.slowest) {
      showCost(track.spec.number, *means.slowest);
    }
    const double total = means.seconds.back().value_or(0);
    for (std::size_t column = 1; column < columns.size(); ++column) {
      const std::size_t index = indexOf(columns[column]);
      const std::optional<double> seconds = means.seconds.at(index);
      ui.cell(seconds ? withPrefix(*seconds, "s") : "–");
      if (index >= kStacked || !(total > 0)) continue;
      const auto share = static_cast<float>(*seconds / total);
      ImGui::TableSetBgColor(ImGuiTableBgTarget_CellBg,
                             colour(ui.theme.phase.at(index), kShading * share));
      ui.tooltip(fmt::format("{:.0f} % of the total", 100 * share).c_str());
    }
    ImGui::PopID();
  }

  bool one_scale_ = false;
  bool means_only_ = false;
  bool chooses_colours_ = false;    ///< once the frame of showCost() is shown
  std::vector<Means> means_;        ///< by track
  std::vector<std::size_t> order_;  ///< of the tracks, by the table's sorting
  SummaryThrottle<std::pair<FrameSpan, std::size_t>> throttle_;  ///< by span and number of tracks
};

}  // namespace

extern const PanelSpec spec = {
    "Phases", DockArea::bottom,
    "Why an algorithm is slow: its phases over the frames, their means, and its slowest frame",
    make<PhasesPanel>};

}  // namespace broadmark::panels::phases
