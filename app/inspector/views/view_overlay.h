// The overlay of a view: the source of its answer, the legend, the tools.
#pragma once

#include <string>

#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"
#include "inspector/ui/ui.h"
#include "inspector/views/view_content.h"

namespace broadmark {

/// Writes into the upper left corner of the view. Returns the lower right corner of that.
ImVec2 drawAnswer(const Ui& ui, const AnswerText& answer, ImVec2 corner, ImVec2 size);

/// What the colours of the content mean, beside the oracle's counts where these differ from those
/// of `owner`. In the upper right corner, below what is `taken` by drawAnswer() if need be; left
/// out where there is no room.
void drawLegend(const Ui& ui, const ViewContent& content, const std::string& owner, ImVec2 corner,
                ImVec2 size, ImVec2 taken);

/// Buttons of the tools in the lower right corner; left out where there is no room. Returns the
/// height of what is free above them.
float drawTools(Ui& ui, Session& session, ImVec2 corner, ImVec2 size);

}  // namespace broadmark
