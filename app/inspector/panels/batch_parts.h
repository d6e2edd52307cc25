// What the forms of the panel Batch share.
#pragma once

#include <string>

#include "inspector/jobs/job.h"
#include "inspector/panels/panel.h"

namespace broadmark {

/// An input for a folder, and a button that asks for one. `folder` and `changed` outlive the
/// dialog.
void drawFolder(PanelContext& context, const char* label, const char* title, std::string& folder,
                bool& changed);

/// How far the work is, and a button that ends it; `kept` is its tooltip. Returns whether it was
/// pressed.
bool drawProgress(Ui& ui, const WorkReport& report, const char* kept);

}  // namespace broadmark
