// Settings files of the original Broadmark: a recording and the case to run on it.

#include "sources/make_source.h"
#include "sources/original_case.h"

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
                // What has a schema is ours: JSON Lines, too, which are no JSON as a whole.
                return source.isJson() && source.schema().empty() &&
                       isOriginalSettings(source.text(), source.name());
              },
          .open = open};
}

}  // namespace broadmark::sources::original_settings
