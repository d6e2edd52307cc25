// What stands over the view: whose answer it shows, what the colours mean, the tools.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "broadmark/render/colouring.h"
#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"
#include "inspector/ui/ui.h"

namespace broadmark {

/// Writes into the upper left corner of the view. Returns the lower right corner of that.
ImVec2 drawAnswer(const Ui& ui, const AnswerText& answer, ImVec2 corner, ImVec2 size);

struct ViewLegend {
  std::span<const LegendEntry> legend;
  std::span<const LegendEntry> oracle;  ///< the same classes by the oracle's answer; may be empty
  std::string owner;                    ///< of the other answer
  std::span<const LegendEntry> cells;   ///< of the structure's cells by population; may be empty
  std::size_t left_out = 0;             ///< lines that were too many to be drawn
};
/// In the upper right corner, below what is `taken` by drawAnswer() if need be; left out where
/// there is no room.
void drawLegend(const Ui& ui, const ViewLegend& legend, ImVec2 corner, ImVec2 size, ImVec2 taken);

/// Buttons of the tools in the lower right corner; left out where there is no room. Returns the
/// height of what is free above them.
float drawTools(Ui& ui, Session& session, ImVec2 corner, ImVec2 size);

}  // namespace broadmark
