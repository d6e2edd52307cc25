// Fixture of the end-to-end tests: a temporary directory, the program, and queries.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "support/program.h"

namespace broadmark::tests {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;
using Arguments = Program::Arguments;

std::string readFile(const fs::path& path);

void writeFile(const fs::path& path, const std::string& bytes);

/// The file as JSON; fails the test if it is invalid.
Json readJson(const fs::path& path);

std::vector<std::string> linesOf(const std::string& text);

/// A text's words on one line, independent of its line breaks.
std::string onOneLine(const std::string& text);

/// The bytes of an .aabbs recording with these boxes; the header may claim other numbers.
std::string recordingOf(std::int32_t objects, std::int32_t frames, const std::vector<Aabb>& boxes,
                        const Aabb& world = {{-9, -9, -9, 0}, {9, 9, 9, 0}});

inline constexpr Aabb kUnitBox{{0, 0, 0, 0}, {1, 1, 1, 0}};

/// `count` unit boxes.
inline std::vector<Aabb> unitBoxes(std::size_t count) { return {count, kUnitBox}; }

/// The path of a recording below the output directory of a bake.
std::string recordingIn(const std::string& directory, const std::string& name);

/// The path of a recording of positions and rotations below the output directory of a bake.
std::string posesIn(const std::string& directory, const std::string& name);

class EndToEnd : public ::testing::Test {
 protected:
  EndToEnd();
  ~EndToEnd() override;

  [[nodiscard]] fs::path file(const fs::path& name) const { return directory_ / name; }

  ProgramResult run(const Arguments& arguments, const ProgramEnvironment& around = {}) const;

  /// Runs a command line in a shell, with the program in the path and output to shell.out. Returns
  /// its exit status.
  [[nodiscard]] int shell(const std::string& command) const;

  /// Runs a command with --quiet, and expects success.
  ProgramResult runQuietly(Arguments arguments) const;

  /// The names of all entries below the directory.
  [[nodiscard]] std::set<std::string> entries() const;

  /// The names of all files below the directory.
  [[nodiscard]] std::set<std::string> files() const;

  /// Expects an error: exit status 2, no output, no written files, and a message of one line that
  /// contains all of `words`.
  void expectRefusal(const Arguments& arguments, const std::vector<std::string>& words,
                     const ProgramEnvironment& around = {}) const;

  /// A small recording called `name`, baked by the program.
  void bakeRecording(const std::string& name, const std::string& objects = "60",
                     const std::string& frames = "5", const std::string& seed = "1") const;

  fs::path directory_;
};

}  // namespace broadmark::tests
