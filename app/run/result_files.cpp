#include "run/result_files.h"

#include <unistd.h>

#include "broadmark/error.h"
#include "support/output.h"

namespace broadmark {
namespace {

std::unique_ptr<AppendedFile> openAppended(const std::filesystem::path& path) {
  if (!isStandardOutput(path)) return std::make_unique<AppendedFile>(path);
  return std::make_unique<AppendedFile>(FileDescriptor(::dup(STDOUT_FILENO)), "standard output");
}

/// Calls visit(writer, path) for each requested file.
template <class Visit>
void forEachFile(const OutputPaths& paths, Visit&& visit) {
  for (const ResultWriter& writer : resultWriters()) {
    const auto found = paths.find(std::string(writer.name));
    if (found != paths.end()) visit(writer, found->second);
  }
}

}  // namespace

void writeResults(const OutputPaths& paths, const Results& results) {
  if (results.cases.empty()) return;
  forEachFile(paths, [&](const ResultWriter& writer, const std::filesystem::path& path) {
    writeOutput(path, writer.format(results));
  });
}

ResultFiles::ResultFiles(const OutputPaths& paths, const Results& results) {
  forEachFile(paths, [&](const ResultWriter& writer, const std::filesystem::path& path) {
    if (writer.lines == nullptr) {
      whole_files_.emplace_back(writer, path);
    } else {
      line_files_.push_back({writer.lines, openAppended(path), writer.lines->before(results)});
    }
  });
}

void ResultFiles::add(const CaseResult& result) {
  for (LineFile& lines : line_files_) {
    lines.file->append(lines.header + lines.writer->one(result));
    lines.header.clear();
  }
}

void ResultFiles::write(const Results& results, bool to_standard_output) {
  for (const auto& [writer, path] : whole_files_) {
    if (isStandardOutput(path) == to_standard_output) writeOutput(path, writer.format(results));
  }
}

void ResultFiles::rewrite(const Results& results) { write(results, false); }

void ResultFiles::finish(const Results& results) {
  if (results.cases.empty()) return;
  for (const LineFile& lines : line_files_) lines.file->append(lines.writer->after(results));
  rewrite(results);
  write(results, true);
}

}  // namespace broadmark
