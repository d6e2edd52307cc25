#include "inspector/panels/batch_parts.h"

#include <fmt/format.h>

#include "support/words.h"

namespace broadmark {

void drawFolder(PanelContext& context, const char* label, const char* title, std::string& folder,
                bool& changed) {
  changed |= context.ui.text(label, folder, "directory");
  if (!context.ui.button("Browse…", "Chooses the directory", ImGui::GetContentRegionAvail().x)) {
    return;
  }
  context.files.ask({.title = title,
                     .purpose = FileDialog::Purpose::directory,
                     .suggestion = folder,
                     .chosen = [&folder, &changed](const std::filesystem::path& path) {
                       folder = path.string();
                       changed = true;
                     }});
}

bool drawProgress(Ui& ui, const WorkReport& report, const char* kept) {
  ImGui::ProgressBar(report.fraction, {-70 * ui.scale, 0});
  ImGui::SameLine();
  const bool cancelled = ui.button("Cancel", kept, ImGui::GetContentRegionAvail().x);
  const std::string left = report.seconds_left > 0
                               ? fmt::format("about {} left; ", waitingTime(report.seconds_left))
                               : "";
  ui.faintParagraph(left + report.doing);
  return cancelled;
}

}  // namespace broadmark
