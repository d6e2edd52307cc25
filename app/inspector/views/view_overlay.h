// The overlay of a view: the source of its answer, the legend, the selected pair, the tools.
#pragma once

#include <string>

#include "inspector/authoring/gizmo.h"
#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"
#include "inspector/ui/ui.h"
#include "inspector/views/view_content.h"

namespace broadmark {

/// Draws the text of the answer in the upper left corner. Returns its lower right corner.
ImVec2 drawAnswer(const Ui& ui, const AnswerText& answer, ImVec2 corner, ImVec2 size);

/// Names the deciding axis of the selected pair, with the gap or the overlap, beside its drawing.
void drawDecidingAxis(const Ui& ui, const ViewContent::DecidingAxis& deciding,
                      const ViewProjection& projection, ImVec2 corner, ImVec2 size);

/// Draws the button that replays the frames before the examined pair's.
void drawReplay(Ui& ui, Session& session, ImVec2 at);

/// Draws the legend in the upper right corner, below `answer_end` if it would overlap the answer,
/// with the counts of `owner` and, if they may differ, of the oracle. Omitted if too large.
void drawLegend(const Ui& ui, const ViewContent& content, const std::string& owner, ImVec2 corner,
                ImVec2 size, ImVec2 answer_end);

/// Draws the tool buttons in the lower right corner, if they fit. Returns the free height above.
float drawTools(Ui& ui, Session& session, ImVec2 corner, ImVec2 size);

}  // namespace broadmark
