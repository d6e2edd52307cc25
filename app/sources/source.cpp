// The list of source kinds, and operations that do not depend on the kind.

#include "sources/source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/json_fields.h"
#include "broadmark/names.h"
#include "imports/files.h"
#include "sources/make_source.h"

namespace broadmark {

#define SOURCE_KIND(name)   \
  namespace sources::name { \
  SourceKind kind();        \
  }
#include "source_kinds.inc"
#undef SOURCE_KIND

namespace {

std::string kindsText(const std::vector<SourceKind>& kinds) {
  return fmt::format("{}", fmt::join(kinds | std::views::transform(&SourceKind::what), ", "));
}

/// Whether this kind can open the source.
bool opens(const SourceKind& kind, NamedSource& source) {
  if (!kind.import) return kind.recognises(source);
  const auto files = imports::expandName(source.name(), kind.import->extensions);
  return !files.empty() && imports::hasExtension(files.front(), kind.import->extensions);
}

OpenedSource openWith(const SourceKind& kind, NamedSource& source, const OpeningOptions& options) {
  if (!kind.import) return kind.open(source, options);
  return OpenedSource(
      {.source = importedSource({source.name()}, *kind.import, options.reading), .cases = {}});
}

/// Error for a source that no kind recognises.
InputError unknownSource(NamedSource& source) {
  if (!source.isFile()) {
    return InputError(unknownName("scene", source.name(), sceneIds()) + ", and no such file");
  }
  const std::string& schema = source.schema();
  const std::string kind =
      schema.empty() ? "no \"schema\"" : fmt::format("unknown \"schema\" '{}'", onOneLine(schema));
  return InputError(fmt::format("{}: {}; expected: {}", source.name(), kind, sourceKindsText()));
}

}  // namespace

std::optional<FrameDifference> PlanEntry::knownDifference() const {
  if (!known) return {};
  const auto first = std::ranges::min_element(known->differences, {}, &FrameDifference::frame);
  if (first == known->differences.end()) return {};
  return *first;
}

bool NamedSource::isFile() const {
  return name_.find('/') != std::string::npos || path().has_extension() ||
         std::filesystem::exists(path());
}

bool NamedSource::isJson() const {
  return isFile() && (path().extension() == ".json" || path().extension() == ".jsonl");
}

const std::string& NamedSource::text() {
  if (!text_) text_ = readTextFile(path());
  return *text_;
}

const std::string& NamedSource::schema() {
  if (!schema_) schema_ = jsonSchema(text(), name_);
  return *schema_;
}

std::vector<SourceKind> sourceKinds() {
  return {
#define SOURCE_KIND(name) sources::name::kind(),
#include "source_kinds.inc"
#undef SOURCE_KIND
  };
}

std::string sourceKindsText() { return kindsText(sourceKinds()); }

bool isSource(const std::string& name) { return isSceneId(name) || NamedSource(name).isFile(); }

OpenedSource openSource(const std::string& name, const OpeningOptions& options) {
  NamedSource source(name);
  for (const SourceKind& kind : sourceKinds()) {
    if (!opens(kind, source)) continue;
    OpenedSource opened = openWith(kind, source, options);
    if (options.reading.swept) {
      for (PlanEntry& entry : opened.entries) sweepBoxes(entry.source);
    }
    return opened;
  }
  throw unknownSource(source);
}

std::optional<FileImport> importOf(const std::string& name) {
  NamedSource source(name);
  for (const SourceKind& kind : sourceKinds()) {
    if (kind.import && opens(kind, source)) return kind.import;
  }
  return {};
}

std::string importKindsText() {
  std::vector<SourceKind> kinds = sourceKinds();
  std::erase_if(kinds, [](const SourceKind& kind) { return !kind.import; });
  return kindsText(kinds);
}

void requireReadingUsed(ReadingOptions options, const std::vector<PlanEntry>& entries) {
  for (const auto& [name, value] : options.changed()) {
    const auto uses = [&, key = name](const PlanEntry& entry) {
      return entry.source.reference.reading.contains(key);
    };
    if (entries.empty() || std::ranges::any_of(entries, uses)) continue;
    throw InputError(
        fmt::format("{}: applies to none of the sources: omit it", parameterOption(name)));
  }
}

}  // namespace broadmark
