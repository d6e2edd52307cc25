// Completion and manual list every option of the help.

#include "command_line/usage.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <regex>
#include <set>

#include "broadmark/files.h"
#include "commands/command_line.h"
#include "engine/helpers.h"
#include "request/reading_options.h"
#include "support/places.h"
#include "support/words.h"

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
  const std::regex option(R"((^|\n) +(-[a-z], )?--([a-z][a-z-]*))");
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

// Only in commands that call this program.
TEST(Usage, EveryOptionOfTheDocumentsIsThere) {
  std::string documents = readTextFile(places::source("README.md"));
  for (const auto& file : std::filesystem::directory_iterator(places::source("docs"))) {
    if (file.path().extension() == ".md") documents += "\n" + readTextFile(file.path());
  }
  const std::set<std::string> names = shownOptions();
  const std::regex command(R"((^|`|\n *)broadmark (([^`\n\\]|\\\n)*))");
  const std::regex option(R"(--([a-z][a-z-]*))");
  int options = 0;
  for (std::sregex_iterator call(documents.begin(), documents.end(), command), end; call != end;
       ++call) {
    const std::string text = (*call)[2];
    for (std::sregex_iterator found(text.begin(), text.end(), option); found != end; ++found) {
      ++options;
      EXPECT_TRUE(names.contains((*found)[1])) << text;
    }
  }
  EXPECT_GT(options, 100);
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
  EXPECT_THAT(manual, HasSubstr("\\fBImports\\fR\n.TP\n\\fB\\-\\-swept"));
  EXPECT_THAT(manual, HasSubstr("\nbroadmark bake \\-\\-"));
}

// Reading options add themselves to a group, whichever command has them.
TEST(Usage, OptionsAreInGroups) {
  ReadingOptions reading;
  for (const std::string& name : parameterNames(reading)) {
    for (const std::string command : {"", "import", "verify", "duel"}) {
      const std::string help =
          printedBy(command.empty() ? std::vector<std::string>{"--help"}
                                    : std::vector{command, std::string("--help")});
      const auto group = help.find("\nImports:\n");
      const std::string option = "\n  " + parameterOption(name);
      ASSERT_NE(group, help.npos) << command;
      EXPECT_GT(help.find(option), group) << command << option;
      EXPECT_LT(help.find(option), help.find("\n\n", group)) << command << option;
    }
  }
  const std::string help = printedBy({"--help"});
  std::size_t before = 0;
  for (const char* heading : {"What to open", "Algorithms", "How to measure", "Results", "Pictures",
                              "Imports", "Options", "Commands", "Examples"}) {
    const auto position = help.find(std::string("\n\n") + heading + ":\n");
    ASSERT_NE(position, help.npos) << heading;
    EXPECT_GT(position, before) << heading;
    before = position;
  }
  EXPECT_THAT(help, testing::Not(HasSubstr("\n  worker ")));
}

// The first "broadmark" is the program.
TEST(Usage, EveryCommandHasTwoExamplesThatParse) {
  const std::regex heading(R"(\nUsage: broadmark)");
  const std::string help = printedBy({"--help-all"});
  const std::regex example(R"(\n  broadmark ([^\n]*))");
  int examples = 0;
  for (std::sregex_iterator found(help.begin(), help.end(), example), end; found != end; ++found) {
    std::vector<std::string> arguments;
    for (std::string word : splitAt(' ', (*found)[1].str())) {
      if (word == ">" || word == "|") break;
      std::erase(word, '\'');
      arguments.push_back(word);
    }
    EXPECT_NO_THROW(parseCommandLine(arguments)) << (*found)[1];
    ++examples;
  }
  const auto commands = std::distance(std::sregex_iterator(help.begin(), help.end(), heading), {});
  EXPECT_GT(commands, 10);
  EXPECT_EQ(examples, 2 * commands);
}

TEST(Usage, HelpFitsTheWidth) {
  for (const std::size_t width : {50, 80, 132}) {
    ::setenv("COLUMNS", std::to_string(width).c_str(), 1);
    std::size_t longest = 0;
    for (const std::string& line : splitAt('\n', printedBy({"--help-all"}))) {
      const auto characters =
          std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; });
      // Names and examples are never broken.
      const bool is_description = line.starts_with("      ");
      if (is_description) longest = std::max(longest, static_cast<std::size_t>(characters));
    }
    EXPECT_LE(longest, width);
    EXPECT_GT(longest, width - 15) << "and uses it";
  }
  ::unsetenv("COLUMNS");
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
  EXPECT_EQ(completedByBash(script, "broadmark --isa av"), "avx2 avx512\n");
  EXPECT_EQ(completedByBash(script, "broadmark --isa scalar,ss"), "scalar,sse2\n");
  EXPECT_EQ(completedByBash(script, "broadmark --isa = ss"), "sse2\n");
  EXPECT_EQ(completedByBash(script, "broadmark --algorithm kd,sap-simd-"), "kd,sap-simd-mt\n");
  EXPECT_EQ(completedByBash(script, "broadmark bake --engine bul"), "bullet\n");
  EXPECT_EQ(completedByBash(script, "broadmark bake --scenes gravity,expl"), "gravity,explosion\n");
  EXPECT_EQ(completedByBash(script, "broadmark --headless brow"), "brownian\n");
  EXPECT_EQ(completedByBash(script, "broadmark duel brow"), "brownian\n");
  EXPECT_EQ(completedByBash(script, "broadmark duel brownian kd-"), "kd-mt\n");
  EXPECT_EQ(completedByBash(script, "broadmark list eng"), "engines\n");
  EXPECT_EQ(completedByBash(script, "broadmark --headless x --check ha"), "hash\n");
  EXPECT_EQ(completedByBash(script, "broadmark wor"), "world worlds\n") << "not the worker";
}

TEST(Usage, OfAnUnknownShell) {
  EXPECT_THAT(inputErrorOf([] { parseCommandLine({"completion", "bsh"}); }),
              AllOf(HasSubstr("completion"), HasSubstr("'bsh'"), HasSubstr("'bash'")));
  EXPECT_THAT(inputErrorOf([] { parseCommandLine({"completion"}); }), HasSubstr("no SHELL"));
}

}  // namespace
}  // namespace broadmark::tests
