#include "support/output.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

std::size_t outputWidth() {
  constexpr std::size_t kMin = 40;
  constexpr std::size_t kDefault = 80;
  std::size_t columns = 0;
  if (const char* text = std::getenv("COLUMNS")) {
    std::from_chars(text, text + std::strlen(text), columns);
  }
  winsize size{};
  if (columns == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) columns = size.ws_col;
  return columns == 0 ? kDefault : std::max(columns, kMin);
}

void writeOutput(const std::filesystem::path& path, std::string_view text) {
  if (!isStandardOutput(path)) return writeTextFile(path, text);
  // main() reports write errors.
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace broadmark
