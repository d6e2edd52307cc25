#include "result_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>

#include "broadmark/error.h"
#include "output.h"

namespace broadmark {
namespace {

FileDescriptor begin(const std::filesystem::path& path) {
  if (isStandardOutput(path)) return FileDescriptor(::dup(STDOUT_FILENO));
  constexpr int kEveryoneReads = 0666;
  FileDescriptor file(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kEveryoneReads));
  if (file.get() >= 0) return file;
  throw InputError(fmt::format("{}: cannot write: {}", path.string(), std::strerror(errno)));
}

}  // namespace

ResultFiles::ResultFiles(const ResultPaths& paths, const Results& results) {
  for (const ResultWriter& writer : resultWriters()) {
    const auto found = paths.find(std::string(writer.name));
    if (found == paths.end()) continue;
    if (writer.lines == nullptr) {
      wholes_.emplace_back(writer, found->second);
    } else {
      lines_.push_back({writer.lines, found->second, begin(found->second)});
      append(lines_.back(), writer.lines->before(results));
    }
  }
}

void ResultFiles::append(const Lines& lines, const std::string& text) {
  writeAll(lines.file.get(), std::as_bytes(std::span(text)), lines.path);
}

void ResultFiles::add(const CaseResult& result) {
  for (const Lines& lines : lines_) append(lines, lines.writer->one(result));
}

void ResultFiles::write(const Results& results, bool to_standard_output) {
  for (const auto& [writer, path] : wholes_) {
    if (isStandardOutput(path) == to_standard_output) writeOutput(path, writer.format(results));
  }
}

void ResultFiles::rewrite(const Results& results) { write(results, false); }

void ResultFiles::end(const Results& results) {
  for (const Lines& lines : lines_) append(lines, lines.writer->after(results));
  if (results.cases.empty()) return;
  rewrite(results);
  write(results, true);
}

}  // namespace broadmark
