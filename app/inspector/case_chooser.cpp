#include "inspector/case_chooser.h"

#include <fmt/format.h>

#include <algorithm>

namespace broadmark {
namespace {

constexpr const char* kTitle = "Open a case";

/// Returns the id of the case that is clicked; "": none.
std::string drawCases(Ui& ui, const CaseChoice& choice) {
  std::vector<const CaseChoice::Item*> shown;
  for (const CaseChoice::Item& item : choice.cases) {
    if (choice.all || item.wrong) shown.push_back(&item);
  }
  std::string clicked;
  ImGui::BeginChild("cases", {0, -ImGui::GetFrameHeightWithSpacing() * 1.2F}, true,
                    ImGuiWindowFlags_NavFlattened);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(shown.size()));
  while (clipper.Step()) {
    for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
      const CaseChoice::Item& item = *shown[static_cast<std::size_t>(row)];
      const std::string status(statusName(item.status));
      ImGui::PushID(row);
      const Rgb rgb = item.status == Status::ok ? ui.theme.good : ui.theme.bad;
      if (ui.selectable(item.id.c_str(), false, status, rgb,
                        item.reason.empty() ? nullptr : item.reason.c_str())) {
        clicked = item.id;
      }
      if (row == 0) ui.note("first");
      ImGui::PopID();
    }
  }
  ImGui::EndChild();
  return clicked;
}

}  // namespace

void drawCaseChooser(Ui& ui, Session& session) {
  if (!session.case_choice) return;
  const auto scope = ui.scope("Cases");
  if (!ImGui::IsPopupOpen(kTitle)) ImGui::OpenPopup(kTitle);
  bool keep = true;
  if (!ui.beginDialog(kTitle, {620, 420}, &keep)) {
    session.case_choice.reset();
    return;
  }
  CaseChoice& choice = *session.case_choice;
  const auto wrong = std::ranges::count_if(choice.cases, &CaseChoice::Item::wrong);
  ui.paragraph(fmt::format("{}: {} of {} cases gave wrong answers", choice.file.filename().string(),
                           wrong, choice.cases.size()));
  const std::string clicked = drawCases(ui, choice);
  ui.checkbox("all cases", choice.all, "Also those whose answers were right");
  ImGui::SameLine();
  if (ui.cancel()) keep = false;
  if (!clicked.empty() || !keep) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (clicked.empty() && keep) return;
  const std::filesystem::path file = choice.file;
  session.case_choice.reset();
  if (!clicked.empty()) session.openCase(file, clicked);
}

}  // namespace broadmark
