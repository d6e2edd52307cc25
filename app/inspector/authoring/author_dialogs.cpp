#include "inspector/authoring/author_dialogs.h"

#include <fmt/format.h>

#include <utility>

namespace broadmark {

namespace fs = std::filesystem;

void askOpenScene(FileDialog& files, Session& session) {
  files.ask({.title = "Open a scene",
             .extensions = {".json"},
             .suggestion = session.document.path().parent_path(),
             .chosen = [&session](const fs::path& path) { session.open(path); }});
}

void askSaveScene(FileDialog& files, Session& session, std::function<void()> then) {
  const Document& document = session.document;
  files.ask({.title = "Save the scene",
             .purpose = FileDialog::Purpose::save,
             .extensions = {".json"},
             .suggestion = document.path().empty()
                               ? fs::path(document.editor.scene().name + ".json")
                               : document.path(),
             .chosen = [&session, then = std::move(then)](const fs::path& path) {
               if (session.document.save(path) && then) then();
             }});
}

void saveScene(FileDialog& files, Session& session, std::function<void()> then) {
  if (session.document.path().empty()) {
    askSaveScene(files, session, std::move(then));
  } else if (session.document.save(session.document.path()) && then) {
    then();
  }
}

void askBakeScene(FileDialog& files, Session& session) {
  session.notices.catchErrors([&] {
    files.ask({.title = "Bake all frames into a recording",
               .purpose = FileDialog::Purpose::save,
               .extensions = recordingExtensions(),
               .suggestion = recordingFileName(session.document.simulation()->scene()),
               .chosen = [&session](const fs::path& path) { session.document.bake(path); }});
  });
}

void drawLeaving(Ui& ui, FileDialog& files, Session& session) {
  if (!session.document.pending_close || !session.notices.errors.empty() || files.isOpen()) return;
  const auto scope = ui.scope("Unsaved");
  const auto answer =
      ui.ask("Unsaved changes",
             fmt::format("The scene '{}' has unsaved changes.", session.document.title()),
             {{"Save", nullptr}, {"Discard", "Discard the changes"}});
  if (!answer) return;
  const auto then = std::exchange(session.document.pending_close, {});
  if (*answer == 0) saveScene(files, session, then);
  if (*answer == 1) then();
}

}  // namespace broadmark
