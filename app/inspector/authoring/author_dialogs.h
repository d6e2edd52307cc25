// Dialogs about the document.
#pragma once

#include <functional>

#include "inspector/session/session.h"
#include "inspector/ui/file_dialog.h"
#include "inspector/ui/ui.h"

namespace broadmark {

/// Asks for a scene file, and opens it.
void askOpenScene(FileDialog& files, Session& session);
/// Asks for a file and saves the document there, then goes on.
void askSaveScene(FileDialog& files, Session& session, std::function<void()> then = {});
/// Saves the document in its file, or asks for one if it has none; then goes on.
void saveScene(FileDialog& files, Session& session, std::function<void()> then = {});
/// Asks for a recording to bake the document into.
void askBakeScene(FileDialog& files, Session& session);
/// While `session.document.leaving` waits: whether to save or to discard the changes, or to stay.
void drawLeaving(Ui& ui, FileDialog& files, Session& session);

}  // namespace broadmark
