// Run requests as JSON ("schema": "broadmark-run/1", docs/run-requests.md): an object with the main
// command's options and their values, so that options are declared only once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "request/run_request.h"

namespace CLI {
class App;
}

namespace broadmark {

class SessionParser;

inline constexpr std::string_view kRunSchema = "broadmark-run/1";

/// Formats a request; omits options that have their defaults.
std::string formatRunRequest(const RunRequest&);

/// Converts a request to arguments of the main command, without options that `app` has already
/// parsed. `name` is the file's name in messages. Throws InputError for a text that is not a
/// request or has an unknown key.
std::vector<std::string> argumentsOf(std::string_view text, const std::string& name,
                                     const CLI::App& app, const SessionParser& session);

}  // namespace broadmark
