#include "inspector/jobs/background_report.h"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "support/child_program.h"
#include "support/output.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Debian's Python, preferred because it has the packages that the report needs.
constexpr const char* kDebianPython = "/usr/bin/python3";

bool holdsPackage(const fs::path& folder) { return fs::exists(folder / "broadmark/__main__.py"); }

std::vector<std::pair<std::string, std::string>> pythonEnvironment(const fs::path& program) {
  std::vector<std::pair<std::string, std::string>> variables = {
      {"BROADMARK", program.string()},
      {"PYTHONSAFEPATH", "1"}};  // no imports from the current folder
  const fs::path folder = packageFolder(program);
  if (folder.empty()) return variables;
  const char* const inherited = std::getenv("PYTHONPATH");
  variables.emplace_back(
      "PYTHONPATH", folder.string() + (inherited == nullptr ? "" : fmt::format(":{}", inherited)));
  return variables;
}

/// The error, from the last line that the program printed.
InputError failureOf(const ProgramEnd& end) {
  std::string last = end.printed;
  while (!last.empty() && last.back() == '\n') last.pop_back();
  last.erase(0, last.rfind('\n') + 1);
  if (last.find("No module named broadmark") != last.npos) {
    last =
        "the Python package of Broadmark was not found: install it, or build with "
        "BROADMARK_PYTHON=ON";
  }
  return InputError(fmt::format("no report page (status {}): {}", end.status, last));
}

}  // namespace

fs::path packageFolder(const fs::path& program) {
  for (fs::path above = program.parent_path(); above != above.root_path();
       above = above.parent_path()) {
    if (holdsPackage(above / "python")) return above / "python";
    std::error_code none;
    for (const fs::directory_entry& version : fs::directory_iterator(above / "lib", none)) {
      fs::path packages = version.path() / "dist-packages";
      if (globMatches("python3*", version.path().filename().string()) && holdsPackage(packages)) {
        return packages;
      }
    }
  }
  return {};
}

JobStatus PageReport::status() const {
  const bool done = state == TaskState::done;
  return {.activity = "A report page is being written.",
          .outcome = done ? "report page: " + fs::absolute(page).string() : ""};
}

void startReport(BackgroundReport& job, const fs::path& results, const fs::path& page) {
  requireOutput(page);
  PageReport initial;
  initial.page = page;
  job.start(std::move(initial), [&job, results, page] {
    const bool debian = fs::exists(kDebianPython);
    const ProgramEnd end = runProgram(
        {debian ? kDebianPython : "python3", "-m", "broadmark", "report",
         fs::absolute(results).string(), "-o", fs::absolute(page).string()},
        pythonEnvironment(fs::read_symlink("/proc/self/exe")), [&job] { return job.cancelled(); });
    if (end.status != 0) throw failureOf(end);
    return true;
  });
}

}  // namespace broadmark
