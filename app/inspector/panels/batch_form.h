// The base of the forms of the panel Batch.
#pragma once

#include <fmt/format.h>

#include <string>

#include "inspector/jobs/job.h"
#include "inspector/panels/panel.h"
#include "support/words.h"

namespace broadmark {

class BatchForm : protected PanelContext {
 protected:
  explicit BatchForm(const PanelContext& context) : PanelContext(context) {}

  /// Draws an input for a folder with a "Browse…" button. Both references outlive the dialog.
  void drawFolder(const char* label, const char* title, std::string& folder, bool& changed) {
    changed |= ui.text(label, folder, "folder");
    if (!wideButton("Browse…", "Choose the folder")) return;
    files.ask({.title = title,
               .purpose = FileDialog::Purpose::directory,
               .suggestion = folder,
               .chosen = [&folder, &changed](const std::filesystem::path& path) {
                 folder = path.string();
                 changed = true;
               }});
  }

  /// Draws a button that starts the work or, while it runs, its progress and a button that cancels
  /// it. Returns whether "Start" was pressed.
  template <class Work>
  bool drawStart(Work& work, const char* start_tip, const char* cancel_tip) {
    if (!work.running()) return wideButton("Start", start_tip);
    const auto report = work.report();
    ImGui::ProgressBar(report.fraction, {-70 * ui.scale, 0});
    ImGui::SameLine();
    if (wideButton("Cancel", cancel_tip)) work.cancel();
    const std::string remaining =
        report.seconds_left > 0 ? fmt::format("about {} left; ", waitingTime(report.seconds_left))
                                : "";
    ui.faintParagraph(remaining + report.activity);
    return false;
  }
};

}  // namespace broadmark
