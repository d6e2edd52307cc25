#include "run/result_files.h"

#include <unistd.h>

#include "broadmark/error.h"
#include "support/output.h"

namespace broadmark {
namespace {

std::unique_ptr<AppendedFile> begin(const std::filesystem::path& path) {
  if (!isStandardOutput(path)) return std::make_unique<AppendedFile>(path);
  return std::make_unique<AppendedFile>(FileDescriptor(::dup(STDOUT_FILENO)), "standard output");
}

/// Calls visit(writer, path) for each file that is wanted.
template <class Visit>
void eachFile(const ResultPaths& paths, Visit&& visit) {
  for (const ResultWriter& writer : resultWriters()) {
    const auto found = paths.find(std::string(writer.name));
    if (found != paths.end()) visit(writer, found->second);
  }
}

}  // namespace

void writeResults(const ResultPaths& paths, const Results& results) {
  if (results.cases.empty()) return;
  eachFile(paths, [&](const ResultWriter& writer, const std::filesystem::path& path) {
    writeOutput(path, writer.format(results));
  });
}

ResultFiles::ResultFiles(const ResultPaths& paths, const Results& results) {
  eachFile(paths, [&](const ResultWriter& writer, const std::filesystem::path& path) {
    if (writer.lines == nullptr) {
      wholes_.emplace_back(writer, path);
    } else {
      lines_.push_back({writer.lines, begin(path), writer.lines->before(results)});
    }
  });
}

void ResultFiles::add(const CaseResult& result) {
  for (Lines& lines : lines_) {
    lines.file->append(lines.before + lines.writer->one(result));
    lines.before.clear();
  }
}

void ResultFiles::write(const Results& results, bool to_standard_output) {
  for (const auto& [writer, path] : wholes_) {
    if (isStandardOutput(path) == to_standard_output) writeOutput(path, writer.format(results));
  }
}

void ResultFiles::rewrite(const Results& results) { write(results, false); }

void ResultFiles::end(const Results& results) {
  if (results.cases.empty()) return;
  for (const Lines& lines : lines_) lines.file->append(lines.writer->after(results));
  rewrite(results);
  write(results, true);
}

}  // namespace broadmark
