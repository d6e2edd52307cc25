#include "imports/mesh_format.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "imports/files.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

bool isText(std::string_view text) { return text.find('\0') == std::string_view::npos; }

/// Without white space and line ends at its start.
std::string_view fromFirstWord(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\v\f\r\n"), text.size()));
}

bool isPly(const FileStart& start) {
  return start.text.starts_with("ply\n") || start.text.starts_with("ply\r");
}

bool isTextStl(const FileStart& start) {
  const std::string text = lowered(fromFirstWord(start.text));
  return text.starts_with("solid") && isText(text) &&
         (text.find("facet") != std::string::npos || text.find("endsolid") != std::string::npos);
}

bool isBinaryStl(const FileStart& start) {
  constexpr std::uint64_t kHeaderBytes = 84;
  constexpr std::uint64_t kTriangleBytes = 50;
  if (start.text.size() < kHeaderBytes) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, &start.text[kHeaderBytes - sizeof triangles], sizeof triangles);
  return triangles > 0 && start.size == kHeaderBytes + kTriangleBytes * triangles;
}

bool isObj(const FileStart& start) {
  if (!isText(start.text)) return false;
  static const std::vector<std::string_view> other_words = {
      "vt", "vn", "vp", "f", "l", "p", "g", "o", "s", "mg", "mtllib", "usemtl", "#"};
  bool has_vertex = false;
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin < start.text.size();) {
    const std::size_t end = start.text.find_first_of("\r\n", begin);
    if (end == std::string::npos && !start.whole && has_vertex) break;  // cut
    const auto line = std::string_view(start.text).substr(begin, end - begin);
    begin = end == std::string::npos ? start.text.size() : end + 1;
    splitWords(line, words);
    if (words.empty() || words[0].starts_with('#')) continue;
    double number = 0;
    if (words[0] == "v" && words.size() >= 4 && parseReal(words[1], number)) {
      has_vertex = true;
    } else if (std::ranges::find(other_words, words[0]) == other_words.end()) {
      return false;
    }
    if (line.ends_with('\\')) break;
  }
  return has_vertex;
}

bool isGltf(const FileStart& start) {
  if (start.text.starts_with("glTF")) return true;
  if (!fromFirstWord(start.text).starts_with('{')) return false;
  const auto has = [&](const char* key) { return start.text.find(key) != std::string::npos; };
  return has("\"asset\"") && has("\"version\"") && !has("\"schema\"") && !has("\"m_inputScene\"");
}

}  // namespace

std::string meshFormat(const FileStart& start) {
  if (isPly(start)) return "ply";
  if (isGltf(start)) return "gltf";
  if (isTextStl(start) || isBinaryStl(start)) return "stl";
  return isObj(start) ? "obj" : "";
}

std::string meshFormat(const std::filesystem::path& path, const std::string& stated) {
  if (stated != "auto") return stated;
  std::string format = meshFormat(startOf(path));
  if (!format.empty()) return format;
  for (const char* name : {"ply", "obj", "stl"}) {
    if (hasExtension(path, {std::string(".") + name})) return name;
  }
  return hasExtension(path, {".gltf", ".glb"}) ? "gltf" : "";
}

}  // namespace broadmark::imports
