// Any text is either a run request that survives a round trip unchanged, or an error of one line.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/error.h"
#include "command_line/run_requests.h"
#include "command_line/session_options.h"

namespace {

using namespace broadmark;

/// Nothing for what is refused.
std::optional<std::string> read(std::string_view text) {
  CLI::App app;
  SessionParser session(app);
  try {
    std::vector<std::string> arguments = argumentsOf(text, "fuzz", app, session);
    std::ranges::reverse(arguments);  // as CLI11 takes them
    app.parse(arguments);
    return formatRunRequest(session.parsed());
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  } catch (const CLI::ParseError&) {
  }
  return std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto written = read({reinterpret_cast<const char*>(data), size});
  if (written && read(*written) != written) std::abort();
  return 0;
}
