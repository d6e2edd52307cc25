// What all end-to-end tests share: a directory of their own, the program, and a few questions.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "support/program.h"

namespace broadmark::testing {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;
using Arguments = Program::Arguments;

inline std::string readFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void writeFile(const fs::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  ASSERT_TRUE(file) << path;
}

/// The file as JSON; fails the test when it is not.
inline Json readJson(const fs::path& path) {
  Json json = Json::parse(readFile(path), nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << path;
  return json;
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// An .aabbs recording put together by hand: whatever the header claims, with these boxes.
inline std::string recordingOf(std::int32_t objects, std::int32_t frames,
                               const std::vector<Aabb>& boxes,
                               const Aabb& world = {{-9, -9, -9, 0}, {9, 9, 9, 0}}) {
  std::string bytes("Handmade");
  bytes.resize(128);
  bytes += "Cubes";
  bytes.resize(256);
  const auto append = [&](const auto* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof *values);
  };
  const std::int32_t counts[] = {objects, frames, 0, 0};
  append(counts, 4);
  append(&world, 1);
  append(boxes.data(), boxes.size());
  return bytes;
}

inline constexpr Aabb kUnitBox{{0, 0, 0, 0}, {1, 1, 1, 0}};

/// `count` times the unit box.
inline std::vector<Aabb> unitBoxes(std::size_t count) { return {count, kUnitBox}; }

/// Where a recording of this name lies in a directory that was baked into.
inline std::string recordingIn(const std::string& directory, const std::string& name) {
  return directory + "/Recordings_AABBs/" + name + ".aabbs";
}

/// Likewise for one of positions and rotations.
inline std::string posesIn(const std::string& directory, const std::string& name) {
  return directory + "/Recordings_PositionRotation/" + name + ".posrot";
}

class EndToEnd : public ::testing::Test {
 protected:
  EndToEnd() {
    // Recordings have names with spaces; so has this directory.
    std::string name = (fs::temp_directory_path() / "broadmark e2e XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    directory_ = name;
  }
  ~EndToEnd() override {
    std::error_code ignored;
    fs::remove_all(directory_, ignored);
  }

  [[nodiscard]] fs::path file(const fs::path& name) const { return directory_ / name; }

  Ended run(const Arguments& arguments, const Surroundings& around = {}) const {
    return Program(directory_, arguments, around).wait();
  }

  /// Runs what must succeed, silently.
  Ended runQuietly(Arguments arguments) const {
    arguments.emplace_back("--quiet");
    Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
    EXPECT_EQ(ended.err, "");
    return ended;
  }

  /// Names of everything below the directory.
  [[nodiscard]] std::set<std::string> entries() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(directory_)) {
      names.insert(fs::relative(entry.path(), directory_).string());
    }
    return names;
  }

  /// Those of them that are no directories.
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names = entries();
    std::erase_if(names, [&](const std::string& name) { return fs::is_directory(file(name)); });
    return names;
  }

  /// The program must refuse: exit status 2, nothing printed, nothing written, and one line of
  /// complaint that holds all of `words`.
  void expectRefusal(const Arguments& arguments, const std::vector<std::string>& words,
                     const Surroundings& around = {}) const {
    std::string call = "broadmark";
    for (const std::string& argument : arguments) call.append(" ").append(argument);
    SCOPED_TRACE(call);
    const auto before = entries();
    const Ended ended = run(arguments, around);
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("broadmark: "));
    for (const std::string& word : words) EXPECT_THAT(ended.err, HasSubstr(word));
    EXPECT_EQ(entries(), before);
  }

  /// A small recording called `name`, baked by the program.
  void bakeRecording(const std::string& name, const std::string& objects = "60",
                     const std::string& frames = "5", const std::string& seed = "1") const {
    const Ended ended = runQuietly({"bake", "--scenes", "freefall", "--objects", objects,
                                    "--frames", frames, "--seed", seed, "--output", "baked"});
    fs::rename(file(recordingIn("baked", "FreeFall Cubes N" + objects + " F" + frames + "frames")),
               file(name));
    fs::remove_all(file("baked"));
  }

  fs::path directory_;
};

}  // namespace broadmark::testing
