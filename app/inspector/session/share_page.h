// A page for others, in one HTML file: what the window shows, the verdict, and the command that
// opens it.
#pragma once

#include <string>
#include <string_view>

#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"

namespace broadmark {

/// The shell command that opens the same source, algorithms and frame; "" for a source that a
/// command cannot name: an unsaved scene, an import.
std::string openingCommand(const Session& session);

/// The page. `png`: the bytes of a picture of the window.
std::string sharePage(const Session& session, const AnswerText& answer, std::string_view png);

}  // namespace broadmark
