// Run requests as JSON ("schema": "broadmark-run/1", docs/run-requests.md): an object of
// the main command's options and their values, so that options are declared once.
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

/// Only what is not as by default.
std::string formatRunRequest(const RunRequest&);

/// The request as arguments of the main command, without the options that `app` has been given
/// already. `name` stands for the file in messages. Throws InputError for a text that is no
/// request, or has a key that no request has.
std::vector<std::string> argumentsOf(std::string_view text, const std::string& name,
                                     const CLI::App& app, const SessionParser& session);

}  // namespace broadmark
