// What is asked before the window closes while work goes on in the background.
#pragma once

#include "inspector/session/session.h"
#include "inspector/ui/ui.h"

namespace broadmark {

/// While `session.ending` waits: whether to end the work, or to stay.
void drawEnding(Ui& ui, Session& session);

}  // namespace broadmark
