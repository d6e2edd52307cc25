// The example of a GitHub workflow: its commands run, with the program as both versions.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

/// A line of YAML: "key: value", possibly the first one of a list item.
struct YamlLine {
  std::size_t indent = 0;  ///< of the key
  bool begins_item = false;
  std::string key;
  std::string value;
};

/// Parses a line of a block mapping; fails the test for anything else.
YamlLine lineOf(const std::string& text) {
  YamlLine line;
  line.indent = text.find_first_not_of(' ');
  line.begins_item = text.compare(line.indent, 2, "- ") == 0;
  if (line.begins_item) line.indent += 2;
  const std::size_t colon = text.find(':', line.indent);
  EXPECT_NE(colon, std::string::npos) << text;
  if (colon == std::string::npos) return line;
  line.key = text.substr(line.indent, colon - line.indent);
  EXPECT_EQ(line.key.find_first_not_of("abcdefghijklmnopqrstuvwxyz-_"), std::string::npos) << text;
  EXPECT_TRUE(colon + 1 == text.size() || text[colon + 1] == ' ') << text;
  line.value = colon + 2 < text.size() ? text.substr(colon + 2) : "";
  return line;
}

using WorkflowStep = std::map<std::string, std::string>;

/// The steps of the workflow's job, with a block ("|") as its text. Nested keys are "with.path".
std::vector<WorkflowStep> stepsOf(const std::string& text) {
  std::vector<WorkflowStep> steps;
  const std::vector<std::string> lines = linesOf(text);
  bool is_inside = false;
  std::size_t indent = 0;
  std::string parent;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].find('\t'), std::string::npos) << "YAML has no tabs";
    if (lines[i].empty() || lines[i].starts_with('#')) continue;
    YamlLine line = lineOf(lines[i]);
    if (!is_inside) {
      is_inside = line.key == "steps";
      continue;
    }
    if (line.begins_item) {
      indent = line.indent;
      steps.emplace_back();
    }
    if (line.value == "|") {
      line.value.clear();
      const std::size_t block = lines.at(i + 1).find_first_not_of(' ');
      EXPECT_GT(block, line.indent);
      while (i + 1 < lines.size() && lines[i + 1].find_first_not_of(' ') >= block) {
        line.value += lines[++i].substr(block) + '\n';
      }
    }
    if (line.indent == indent) parent = line.key + '.';
    const std::string name = line.indent == indent ? line.key : parent + line.key;
    EXPECT_TRUE(steps.back().emplace(name, line.value).second) << "twice: " << name;
  }
  return steps;
}

class Workflow : public EndToEnd {
 protected:
  /// Does what actions/checkout and ./run do.
  void checkOut(const std::string& path) const {
    fs::create_directories(file(path) / "build/release");
    fs::create_symlink(places::program(), file(path) / "build/release/broadmark");
    writeFile(file(path) / "run", "#!/bin/sh\nexec '" + places::program() + "' \"$@\"\n");
    fs::permissions(file(path) / "run", fs::perms::owner_all);
  }

  /// Runs a step's commands as GitHub does, ended by the first that fails.
  [[nodiscard]] int runStep(const std::string& commands) const {
    writeFile(file("step.sh"), commands);
    return shell("GITHUB_STEP_SUMMARY=summary.md sh -e step.sh");
  }

  const std::string text_ = readFile(places::source("assets/workflows/duel.yml"));
};

TEST_F(Workflow, RunsStepByStep) {
  std::size_t commands = 0;
  for (const WorkflowStep& step : stepsOf(text_)) {
    SCOPED_TRACE(step.at("name"));
    ASSERT_NE(step.contains("run"), step.contains("uses"));
    if (step.contains("uses")) {
      if (step.at("uses").starts_with("actions/checkout@")) checkOut(step.at("with.path"));
      continue;
    }
    ++commands;
    const int status = runStep(step.at("run"));
    // A duel judges measured times: on a busy machine it may claim a difference.
    const bool is_duel = step.at("name") == "Duel";
    EXPECT_TRUE(status == 0 || (is_duel && status == 3)) << status << readFile(file("shell.out"));
  }
  EXPECT_EQ(commands, 4U);
  EXPECT_THAT(readFile(file("summary.md")), HasSubstr("| `FreeFall/Cubes/N2000/F60"));
  EXPECT_THAT(readFile(file("summary.md")), HasSubstr("6 cases: "));
  EXPECT_THAT(readFile(file("duel.txt")), HasSubstr("::notice title=broadmark duel::6 cases: "));
  EXPECT_THAT(readFile(file("duel.xml")), HasSubstr("<testsuite name=\"broadmark duel\""));
  EXPECT_THAT(readFile(file("shell.out")), Not(HasSubstr("not found")));
}

TEST_F(Workflow, IsTheDocumentedOne) {
  EXPECT_THAT(readFile(places::source("docs/comparing.md")),
              HasSubstr("assets/workflows/duel.yml"));
}

}  // namespace
}  // namespace broadmark::tests
