// Dialogs for opening, saving and baking the document.
#pragma once

#include <functional>

#include "inspector/session/session.h"
#include "inspector/ui/file_dialog.h"
#include "inspector/ui/ui.h"

namespace broadmark {

/// Asks for a scene file and opens it.
void askOpenScene(FileDialog& files, Session& session);
/// Asks for a file, saves the document to it, and calls `then`.
void askSaveScene(FileDialog& files, Session& session, std::function<void()> then = {});
/// Saves the document to its file, or asks for one if it has none; then calls `then`.
void saveScene(FileDialog& files, Session& session, std::function<void()> then = {});
/// Asks for a recording to bake the document into.
void askBakeScene(FileDialog& files, Session& session);
/// Asks whether to save or discard the changes while `session.document.pending_close` is set.
void drawLeaving(Ui& ui, FileDialog& files, Session& session);

}  // namespace broadmark
