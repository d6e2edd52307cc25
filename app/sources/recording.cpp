// Recordings: every file that is not JSON.

#include "sources/make_source.h"

namespace broadmark::sources::recording {

SourceKind kind() {
  return {.what = recordingKindsText(),
          .recognises = [](NamedSource& source) { return source.isFile() && !source.isJson(); },
          .open =
              [](NamedSource& source, const OpeningOptions&) {
                return OpenedSource({.source = recordingSource(source.path()), .cases = {}});
              }};
}

}  // namespace broadmark::sources::recording
