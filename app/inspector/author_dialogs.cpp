#include "inspector/author_dialogs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace broadmark {
namespace {

namespace fs = std::filesystem;
constexpr const char* kLeaving = "Unsaved changes";

}  // namespace

void askOpenScene(FileDialog& files, Session& session) {
  files.ask({.title = "Open a scene",
             .purpose = FileDialog::Purpose::open,
             .extensions = {".json"},
             .suggestion = session.desk.path().parent_path(),
             .chosen = [&session](const fs::path& path) { session.open(path); }});
}

void askSaveScene(FileDialog& files, Session& session, std::function<void()> then) {
  const AuthorDesk& desk = session.desk;
  files.ask({.title = "Save the scene",
             .purpose = FileDialog::Purpose::save,
             .extensions = {".json"},
             .suggestion =
                 desk.path().empty() ? fs::path(desk.editor.scene().name + ".json") : desk.path(),
             .chosen = [&session, then = std::move(then)](const fs::path& path) {
               if (session.saveAuthored(path) && then) then();
             }});
}

void saveScene(FileDialog& files, Session& session, std::function<void()> then) {
  if (session.desk.path().empty()) {
    askSaveScene(files, session, std::move(then));
  } else if (session.saveAuthored(session.desk.path()) && then) {
    then();
  }
}

void askBakeScene(FileDialog& files, Session& session) {
  session.attempt([&] {
    files.ask({.title = "Bake all frames into a recording",
               .purpose = FileDialog::Purpose::save,
               .extensions = {".aabbs", ".posrot"},
               .suggestion = recordingFileName(session.desk.simulation()->scene()),
               .chosen = [&session](const fs::path& path) { session.bakeAuthored(path); }});
  });
}

void drawLeaving(Ui& ui, FileDialog& files, Session& session) {
  if (!session.leaving || !session.errors.empty() || files.isOpen()) return;
  const auto scope = ui.scope("Unsaved");
  if (!ImGui::IsPopupOpen(kLeaving)) ImGui::OpenPopup(kLeaving);
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(420 * ui.scale, screen.x - 16), 0});
  if (!ImGui::BeginPopupModal(kLeaving, nullptr,
                              ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
    return;
  }
  ui.paragraph(
      fmt::format("The scene '{}' has changes that stand in no file.", session.desk.title()));
  ImGui::Spacing();
  const float width = 84 * ui.scale;
  const bool save = ui.button("Save", nullptr, width);
  ImGui::SameLine();
  const bool discard = ui.button("Discard", "The changes are lost", width);
  ImGui::SameLine();
  const bool stay = ui.button("Cancel", nullptr, width) ||
                    ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
  const bool decided = save || discard || stay;
  if (decided) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (!decided) return;
  const auto then = std::exchange(session.leaving, {});
  if (save) saveScene(files, session, then);
  if (discard) then();
}

}  // namespace broadmark
