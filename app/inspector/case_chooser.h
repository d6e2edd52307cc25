// Choosing one of the cases of a results file.
#pragma once

#include "inspector/session.h"
#include "inspector/ui.h"

namespace broadmark {

/// Draws the choice that the session offers, if any, as a dialog.
void drawCaseChooser(Ui& ui, Session& session);

}  // namespace broadmark
