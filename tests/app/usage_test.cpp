// Completion and manual list every option of the help.

#include "command_line/usage.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <regex>
#include <set>

#include "broadmark/files.h"
#include "commands/command_line.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string printedBy(const std::vector<std::string>& arguments) {
  testing::internal::CaptureStdout();
  const int status = parseCommandLine(arguments)();
  std::string text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(status, 0);
  return text;
}

/// The option names at the beginning of the lines of --help-all, without dashes.
std::set<std::string> shownOptions() {
  const std::string help = printedBy({"--help-all"});
  const std::regex option(R"((^|\n) +(-h,)?--([a-z][a-z-]*))");
  std::set<std::string> names;
  for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found) {
    names.insert((*found)[3]);
  }
  return names;
}

/// Whether `name` is in the text as a whole word.
bool hasWord(const std::string& text, const std::string& name) {
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const char next = at + name.size() < text.size() ? text[at + name.size()] : ' ';
    if (std::isalnum(static_cast<unsigned char>(next)) == 0 && next != '-') return true;
  }
  return false;
}

TEST(Usage, EveryOptionOfHelpIsEverywhere) {
  const std::set<std::string> names = shownOptions();
  const std::string bash = printedBy({"completion", "bash"});
  const std::string zsh = printedBy({"completion", "zsh"});
  const std::string fish = printedBy({"completion", "fish"});
  const std::string manual = printedBy({"manual"});
  for (const std::string& name : names) {
    EXPECT_TRUE(hasWord(bash, "--" + name)) << name;
    EXPECT_TRUE(hasWord(zsh, "--" + name)) << name;
    EXPECT_TRUE(hasWord(fish, " -l " + name)) << name;
    std::string dashes = "--" + name;
    for (auto at = dashes.find('-'); at != std::string::npos; at = dashes.find('-', at + 2)) {
      dashes.insert(at, "\\");
    }
    EXPECT_THAT(manual, HasSubstr(dashes));
  }
  for (const char* command : {"bake", "list", "verify", "compare", "duel", "manual"}) {
    for (const std::string& text : {bash, zsh, fish, manual}) EXPECT_TRUE(hasWord(text, command));
  }
}

// Only in the README's commands that call this program.
TEST(Usage, EveryOptionOfTheReadmeIsThere) {
  const std::string readme = readTextFile(places::source("README.md"));
  const std::set<std::string> names = shownOptions();
  const std::regex command(R"((^|`|\n *)broadmark (([^`\n\\]|\\\n)*))");
  const std::regex option(R"(--([a-z][a-z-]*))");
  int options = 0;
  for (std::sregex_iterator call(readme.begin(), readme.end(), command), end; call != end; ++call) {
    const std::string text = (*call)[2];
    for (std::sregex_iterator found(text.begin(), text.end(), option); found != end; ++found) {
      ++options;
      EXPECT_TRUE(names.contains((*found)[1])) << text;
    }
  }
  EXPECT_GT(options, 20);
}

TEST(Usage, OfTheManual) {
  const std::string manual = printedBy({"manual"});
  EXPECT_THAT(manual, testing::StartsWith(".TH BROADMARK 1 "));
  for (const char* section :
       {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "EXIT STATUS"}) {
    EXPECT_THAT(manual, HasSubstr(std::string(".SH ") + section + "\n"));
  }
  EXPECT_THAT(manual, HasSubstr(".TP\n130\ninterrupted"));
  EXPECT_THAT(manual, HasSubstr(".TP\n\\fB\\-\\-json\\fR \\fIFILE\\fR\nresults as JSON"));
}

/// Bash's completions of the last of these words.
std::string completedByBash(const std::filesystem::path& script, const std::string& words) {
  const auto last = std::ranges::count(words, ' ');
  const std::string command = fmt::format(
      "bash -c '. \"$0\"; COMP_WORDS=({}) COMP_CWORD={}; _broadmark; echo ${{COMPREPLY[*]}}' "
      "\"{}\"",
      words, last, script.string());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"),
                                                             ::pclose);
  std::string text;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) {
    text += static_cast<char>(c);
  }
  return text;
}

TEST(Usage, BashCompletes) {
  const TemporaryDirectory directory;
  const auto script = directory / "script";
  writeTextFile(script, printedBy({"completion", "bash"}));
  EXPECT_EQ(completedByBash(script, "broadmark --csv"), "--csv --csv-frames\n");
  EXPECT_EQ(completedByBash(script, "broadmark ba"), "bake\n");
  EXPECT_EQ(completedByBash(script, "broadmark bake --sce"), "--scenes\n");
  EXPECT_EQ(completedByBash(script, "broadmark bake --csv"), "\n") << "no option of bake";
  EXPECT_EQ(completedByBash(script, "broadmark bake fi"), "\n") << "files are left to bash";
}

TEST(Usage, OfAnUnknownShell) {
  EXPECT_THAT(inputErrorOf([] {
                parseCommandLine({"completion", "bsh"});
              }),
              AllOf(HasSubstr("completion"), HasSubstr("'bsh'"), HasSubstr("'bash'")));
  EXPECT_THAT(inputErrorOf([] { parseCommandLine({"completion"}); }), HasSubstr("shell"));
}

}  // namespace
}  // namespace broadmark::tests
