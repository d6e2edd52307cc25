// A page for others, in one HTML file: what the window shows, the verdict, and the command that
// opens it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"

namespace broadmark {

/// The arguments that open the same source, algorithms, frame and selection, seen by this camera;
/// empty for a source that they cannot name: an unsaved scene, an import.
std::vector<std::string> openingArguments(const Session& session, const OrbitCamera& camera);
/// The shell command with these arguments; "" without any.
std::string openingCommand(const Session& session, const OrbitCamera& camera);
/// The link to a page of the program in a browser that opens the same.
std::string openingLink(const Session& session, const OrbitCamera& camera, std::string_view page);

/// The page. `png`: the bytes of a picture of the window.
std::string sharePage(const Session& session, const OrbitCamera& camera, const AnswerText& answer,
                      std::string_view png);

}  // namespace broadmark
