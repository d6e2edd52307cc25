// What the forms of the panel Batch share.
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

  /// An input for a folder, and a button that asks for one. `folder` and `changed` outlive the
  /// dialog.
  void drawFolder(const char* label, const char* title, std::string& folder, bool& changed) {
    changed |= ui.text(label, folder, "directory");
    if (!wideButton("Browse…", "Chooses the directory")) return;
    files.ask({.title = title,
               .purpose = FileDialog::Purpose::directory,
               .suggestion = folder,
               .chosen = [&folder, &changed](const std::filesystem::path& path) {
                 folder = path.string();
                 changed = true;
               }});
  }

  /// A button that starts the work, or how far it is, with a button that ends it. Returns whether
  /// it is to be started.
  template <class Work>
  bool drawStart(Work& work, const char* started, const char* kept) {
    if (!work.running()) return wideButton("Start", started);
    const auto report = work.report();
    ImGui::ProgressBar(report.fraction, {-70 * ui.scale, 0});
    ImGui::SameLine();
    if (wideButton("Cancel", kept)) work.cancel();
    const std::string left = report.seconds_left > 0
                                 ? fmt::format("about {} left; ", waitingTime(report.seconds_left))
                                 : "";
    ui.faintParagraph(left + report.doing);
    return false;
  }
};

}  // namespace broadmark
