#include "support/output.h"

#include <cstdio>
#include <iostream>
#include <iterator>

#include "broadmark/files.h"

namespace broadmark {

bool isStandardOutput(const std::filesystem::path& path) {
  return path == "-" || path == "/dev/stdout";
}

void requireOutput(const std::filesystem::path& path) {
  if (!isStandardOutput(path)) AtomicFile probe(path);
}

std::string readInput(const std::filesystem::path& path) {
  if (path != "-") return readTextFile(path);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

void writeOutput(const std::filesystem::path& path, std::string_view text) {
  if (!isStandardOutput(path)) return writeTextFile(path, text);
  // main() reports write errors.
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace broadmark
