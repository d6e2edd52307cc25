#include "inspector/closing.h"

#include <fmt/format.h>

#include <utility>

namespace broadmark {
namespace {

constexpr const char* kEnding = "Still at work";

}  // namespace

void drawEnding(Ui& ui, Session& session) {
  if (!session.ending || !session.notices.errors.empty()) return;
  if (!session.atWork()) {  // it has ended meanwhile
    session.document.leave(std::exchange(session.ending, {}));
    return;
  }
  const auto scope = ui.scope("Ending");
  if (!ImGui::IsPopupOpen(kEnding)) ImGui::OpenPopup(kEnding);
  if (!ui.beginDialog(kEnding, {420, 0})) return;
  if (session.bake.running()) ui.paragraph("Baking: " + session.bake.report().text() + ".");
  if (session.benchmark.running()) {
    ui.paragraph("Running algorithms: " + session.benchmark.report().text() + ".");
  }
  if (session.duel.running()) ui.paragraph("A duel goes on.");
  if (session.case_export.running()) ui.paragraph("A case is being exported.");
  if (session.report_page.running()) ui.paragraph("A report page is being written.");
  ui.paragraph("What is finished is kept.");
  ImGui::Spacing();
  const float width = 84 * ui.scale;
  const bool end = ui.button("End it", "What is not finished is given up", width);
  ImGui::SameLine();
  const bool stay = ui.cancel(width);
  if (end || stay) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (!end && !stay) return;
  const auto then = std::exchange(session.ending, {});
  if (end) session.document.leave(then);
}

}  // namespace broadmark
