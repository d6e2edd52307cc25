// Recordings: by their extension, or by their content.

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/error.h"
#include "broadmark/recordings/recording.h"
#include "imports/files.h"
#include "sources/make_source.h"
#include "support/line_reader.h"

namespace broadmark::sources::recording {
namespace {

/// Whether a file is a recording or has a name of one. Without a known extension it must be of the
/// original's format, the header of which has two names padded with zeros.
bool isRecording(const std::filesystem::path& path) {
  if (imports::hasExtension(path, recordingExtensions())) return true;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  constexpr std::size_t kNameBytes = 128;
  const std::string start = imports::startOf(path).text.substr(0, kRecordingHeaderBytes);
  if (start.size() < kRecordingHeaderBytes || start.front() == '\0') return false;
  const auto is_name = [&](std::size_t begin) {
    const std::string name = start.substr(begin, kNameBytes);
    const std::size_t end = std::min(name.find('\0'), name.size());
    return end < kNameBytes && name.find_first_not_of('\0', end) == std::string::npos;
  };
  return is_name(0) && is_name(kNameBytes);
}

bool isCompressed(const std::filesystem::path& path) {
  return imports::lowered(path.extension().string()) == ".gz" && imports::startOf(path).size == 0;
}

}  // namespace

SourceKind kind() {
  return {.what = recordingKindsText(),
          .recognises =
              [](NamedSource& source) { return source.isFile() && isRecording(source.path()); },
          .open =
              [](NamedSource& source, const OpeningOptions&) {
                if (isCompressed(source.path())) {
                  throw InputError(fmt::format(
                      "{}: a compressed recording: uncompress it with gunzip", source.name()));
                }
                return OpenedSource({.source = recordingSource(source.path()), .cases = {}});
              }};
}

}  // namespace broadmark::sources::recording
