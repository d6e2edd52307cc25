// Recordings: every file that is not JSON.

#include "sources/make_source.h"

namespace broadmark::sources::recording {
namespace {

OpenedSource open(NamedSource& source, const OpeningOptions&) {
  OpenedSource opened;
  opened.entries.push_back({.source = recordingSource(source.path()), .cases = {}});
  return opened;
}

}  // namespace

SourceKind kind() {
  return {.what = recordingKindsText(),
          .recognises = [](NamedSource& source) { return source.isFile() && !source.isJson(); },
          .open = open};
}

}  // namespace broadmark::sources::recording
