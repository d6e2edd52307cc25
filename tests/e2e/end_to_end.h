// What all end-to-end tests share: a directory of their own, the program, and a few questions.
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

/// The file as JSON; fails the test when it is not.
Json readJson(const fs::path& path);

std::vector<std::string> linesOf(const std::string& text);

/// A text's words, so that it does not matter where its lines are broken.
std::string onOneLine(const std::string& text);

/// An .aabbs recording put together by hand: whatever the header claims, with these boxes.
std::string recordingOf(std::int32_t objects, std::int32_t frames, const std::vector<Aabb>& boxes,
                        const Aabb& world = {{-9, -9, -9, 0}, {9, 9, 9, 0}});

inline constexpr Aabb kUnitBox{{0, 0, 0, 0}, {1, 1, 1, 0}};

/// `count` times the unit box.
inline std::vector<Aabb> unitBoxes(std::size_t count) { return {count, kUnitBox}; }

/// Where a recording of this name lies in a directory that was baked into.
std::string recordingIn(const std::string& directory, const std::string& name);

/// Likewise for one of positions and rotations.
std::string posesIn(const std::string& directory, const std::string& name);

class EndToEnd : public ::testing::Test {
 protected:
  EndToEnd();
  ~EndToEnd() override;

  [[nodiscard]] fs::path file(const fs::path& name) const { return directory_ / name; }

  Ended run(const Arguments& arguments, const Surroundings& around = {}) const;

  /// Runs a command line in a shell, with the program in the path; what it prints is in shell.out.
  /// Returns its exit status.
  [[nodiscard]] int shell(const std::string& command) const;

  /// Runs what must succeed, silently.
  Ended runQuietly(Arguments arguments) const;

  /// Names of everything below the directory.
  [[nodiscard]] std::set<std::string> entries() const;

  /// Those of them that are no directories.
  [[nodiscard]] std::set<std::string> files() const;

  /// The program must refuse: exit status 2, nothing printed, nothing written, and one line of
  /// complaint that holds all of `words`.
  void expectRefusal(const Arguments& arguments, const std::vector<std::string>& words,
                     const Surroundings& around = {}) const;

  /// A small recording called `name`, baked by the program.
  void bakeRecording(const std::string& name, const std::string& objects = "60",
                     const std::string& frames = "5", const std::string& seed = "1") const;

  fs::path directory_;
};

}  // namespace broadmark::tests
