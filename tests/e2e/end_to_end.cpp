#include "e2e/end_to_end.h"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "support/places.h"

namespace broadmark::tests {

std::string readFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeFile(const fs::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  ASSERT_TRUE(file) << path;
}

Json readJson(const fs::path& path) {
  Json json = Json::parse(readFile(path), nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << path;
  return json;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string onOneLine(const std::string& text) {
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::string recordingOf(std::int32_t objects, std::int32_t frames, const std::vector<Aabb>& boxes,
                        const Aabb& world) {
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

std::string recordingIn(const std::string& directory, const std::string& name) {
  return directory + "/Recordings_AABBs/" + name + ".aabbs";
}

std::string posesIn(const std::string& directory, const std::string& name) {
  return directory + "/Recordings_PositionRotation/" + name + ".posrot";
}

EndToEnd::EndToEnd() {
  // The name has spaces, as names of recordings do.
  std::string name = (fs::temp_directory_path() / "broadmark e2e XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
  directory_ = name;
}

EndToEnd::~EndToEnd() {
  std::error_code ignored;
  fs::remove_all(directory_, ignored);
}

ProgramResult EndToEnd::run(const Arguments& arguments, const ProgramEnvironment& around) const {
  return Program(directory_, arguments, around).wait();
}

int EndToEnd::shell(const std::string& command) const {
  writeFile(file("command.sh"), "cd '" + directory_.string() + "' && PATH='" +
                                    fs::path(places::program()).parent_path().string() +
                                    "':$PATH && " + command + " > shell.out 2>&1\n");
  const int status = std::system(("sh '" + file("command.sh").string() + "'").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

ProgramResult EndToEnd::runQuietly(Arguments arguments) const {
  arguments.emplace_back("--quiet");
  ProgramResult ended = run(arguments);
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_EQ(ended.err, "");
  return ended;
}

std::set<std::string> EndToEnd::entries() const {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(directory_)) {
    names.insert(fs::relative(entry.path(), directory_).string());
  }
  return names;
}

std::set<std::string> EndToEnd::files() const {
  std::set<std::string> names = entries();
  std::erase_if(names, [&](const std::string& name) { return fs::is_directory(file(name)); });
  return names;
}

void EndToEnd::expectRefusal(const Arguments& arguments, const std::vector<std::string>& words,
                             const ProgramEnvironment& around) const {
  std::string call = "broadmark";
  for (const std::string& argument : arguments) call.append(" ").append(argument);
  SCOPED_TRACE(call);
  const auto before = entries();
  const ProgramResult ended = run(arguments, around);
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
  EXPECT_THAT(ended.err, StartsWith("broadmark: "));
  for (const std::string& word : words) EXPECT_THAT(ended.err, HasSubstr(word));
  EXPECT_EQ(entries(), before);
}

void EndToEnd::bakeRecording(const std::string& name, const std::string& objects,
                             const std::string& frames, const std::string& seed) const {
  const ProgramResult ended = runQuietly({"bake", "--scenes", "freefall", "--objects", objects,
                                          "--frames", frames, "--seed", seed, "--output", "baked"});
  fs::rename(file(recordingIn("baked", "FreeFall Cubes N" + objects + " F" + frames + "frames")),
             file(name));
  fs::remove_all(file("baked"));
}

}  // namespace broadmark::tests
