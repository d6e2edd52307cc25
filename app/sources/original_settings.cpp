// Settings files of the original Broadmark: a recording and the case to run on it.

#include "original/case.h"
#include "sources/make_source.h"

namespace broadmark::sources::original_settings {
namespace {

OpenedSource open(NamedSource& source, const OpeningOptions& options) {
  const OriginalSettings settings = parseOriginalSettings(source.text(), source.name());
  OpenedSource opened;
  opened.entries.push_back(
      {.source = recordingSource(statedPath(source.path(), settings.input_scene)),
       .cases = {originalCase(settings, options.algorithms)},
       .original = settings});
  return opened;
}

}  // namespace

SourceKind kind() {
  return {.what = "settings files of the original Broadmark (.json with m_inputScene)",
          .recognises =
              [](NamedSource& source) {
                return source.isJson() && isOriginalSettings(source.text(), source.name());
              },
          .open = open};
}

}  // namespace broadmark::sources::original_settings
