// What is plotted of a results file: times over the frames of the marked cases, or over the numbers
// of bodies of all listed ones.
#pragma once

#include <optional>
#include <vector>

#include "inspector/panels/panel.h"
#include "inspector/session/opened_results.h"
#include "inspector/session/timeline.h"

namespace broadmark {

class CasePlots {
 public:
  /// The choices, and below them the plot.
  void draw(PanelContext& context, OpenedResults& results);
  /// By row: the colour of the curve that the case has or belongs to.
  std::vector<std::optional<Rgb>> rowColours(const Palette& palette, OpenedResults& results) const;

 private:
  void drawChoices(Ui& ui);
  void drawFrames(PanelContext& context, OpenedResults& results);
  void drawBodies(PanelContext& context, OpenedResults& results) const;
  [[nodiscard]] Phase phase() const { return kPhases.entries.at(phase_).value; }
  [[nodiscard]] bool overBodies() const { return over_ == 1; }

  std::size_t phase_ = kPhases.entries.size() - 1;  ///< the last: total
  std::size_t over_ = 0;                            ///< 0: frames; 1: bodies
  bool logarithmic_ = true;
  Timeline zoom_;  ///< of the frames
};

}  // namespace broadmark
