// A page for others, in one HTML file: what the window shows, the verdict, and the command that
// opens it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"

namespace broadmark {

/// The arguments that open the same source, algorithms and frame; empty for a source that they
/// cannot name: an unsaved scene, an import.
std::vector<std::string> openingArguments(const Session& session);
/// The shell command with these arguments; "" without any.
std::string openingCommand(const Session& session);
/// The link to a page of the program in a browser that opens the same.
std::string openingLink(const Session& session, std::string_view page);

/// The page. `png`: the bytes of a picture of the window.
std::string sharePage(const Session& session, const AnswerText& answer, std::string_view png);

}  // namespace broadmark
