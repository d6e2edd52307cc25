// What the forms of the panel Batch share.
#pragma once

#include <fmt/format.h>

#include <string>

#include "inspector/jobs/job.h"
#include "inspector/panels/panel.h"
#include "support/words.h"

namespace broadmark {

/// An input for a folder, and a button that asks for one. `folder` and `changed` outlive the
/// dialog.
inline void drawFolder(PanelContext& context, const char* label, const char* title,
                       std::string& folder, bool& changed) {
  changed |= context.ui.text(label, folder, "directory");
  if (!wideButton(context.ui, "Browse…", "Chooses the directory")) return;
  context.files.ask({.title = title,
                     .purpose = FileDialog::Purpose::directory,
                     .suggestion = folder,
                     .chosen = [&folder, &changed](const std::filesystem::path& path) {
                       folder = path.string();
                       changed = true;
                     }});
}

/// A button that starts the work, or how far it is, with a button that ends it. Returns whether it
/// is to be started.
template <class Work>
bool drawStart(Ui& ui, Work& work, const char* started, const char* kept) {
  if (!work.running()) return wideButton(ui, "Start", started);
  const auto report = work.report();
  ImGui::ProgressBar(report.fraction, {-70 * ui.scale, 0});
  ImGui::SameLine();
  if (wideButton(ui, "Cancel", kept)) work.cancel();
  const std::string left = report.seconds_left > 0
                               ? fmt::format("about {} left; ", waitingTime(report.seconds_left))
                               : "";
  ui.faintParagraph(left + report.doing);
  return false;
}

/// What keeps the work from being started.
inline void drawFault(Ui& ui, const std::string& fault) {
  ImGui::PushTextWrapPos(0);
  ui.coloured(ui.theme.warning, fault);
  ImGui::PopTextWrapPos();
}

}  // namespace broadmark
