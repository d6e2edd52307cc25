// What is asked before the window closes while work goes on in the background.

#include <utility>

#include "inspector/inspector.h"

namespace broadmark {
namespace {

constexpr const char* kEnding = "Still at work";

}  // namespace

void Inspector::leave() {
  ending_ = false;
  session_.document.leave([this] { closing_ = true; });
}

void Inspector::drawEnding() {
  if (!ending_ || !session_.notices.errors.empty()) return;
  if (!session_.jobs.running()) return leave();  // it has ended meanwhile
  const auto scope = ui_.scope("Ending");
  if (!ImGui::IsPopupOpen(kEnding)) ImGui::OpenPopup(kEnding);
  if (!ui_.beginDialog(kEnding, {420, 0})) return;
  for (const Job* const job : session_.jobs.all()) {
    if (job->running()) ui_.paragraph(job->status().doing);
  }
  ui_.paragraph("What is finished is kept.");
  ImGui::Spacing();
  const float width = 84 * ui_.scale;
  const bool end = ui_.button("End it", "What is not finished is given up", width);
  ImGui::SameLine();
  const bool stay = ui_.cancel(width);
  if (end || stay) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (stay) ending_ = false;
  if (end) leave();
}

}  // namespace broadmark
