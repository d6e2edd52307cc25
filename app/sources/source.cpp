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
#include "broadmark/recordings/recording.h"
#include "imports/files.h"
#include "sources/make_source.h"
#include "support/line_reader.h"
#include "support/words.h"

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

namespace fs = std::filesystem;

std::vector<SourceKind> importKinds() {
  std::vector<SourceKind> kinds = sourceKinds();
  std::erase_if(kinds, [](const SourceKind& kind) { return !kind.import; });
  return kinds;
}

/// Whether the name is that of a recording: these are not read to recognise them.
bool isRecordingName(const fs::path& path) {
  return imports::hasExtension(path, recordingExtensions());
}

const SourceKind* kindByContent(const std::vector<SourceKind>& kinds, const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (!fs::exists(status) || fs::is_directory(status) || isRecordingName(file)) return nullptr;
  try {
    const imports::FileStart start = imports::startOf(file);
    const auto kind = std::ranges::find_if(
        kinds, [&](const SourceKind& other) { return other.import->recognises(start); });
    return kind == kinds.end() ? nullptr : &*kind;
  } catch (const InputError&) {
    if (!fs::is_regular_file(status)) throw;
    return nullptr;  // the reader for its name says what is wrong
  }
}

const SourceKind* kindByName(const std::vector<SourceKind>& kinds, const fs::path& file) {
  const auto kind = std::ranges::find_if(kinds, [&](const SourceKind& other) {
    return imports::hasExtension(file, other.import->extensions);
  });
  return kind == kinds.end() ? nullptr : &*kind;
}

const SourceKind* kindOf(const std::vector<SourceKind>& kinds, const fs::path& file) {
  const SourceKind* kind = kindByContent(kinds, file);
  return kind == nullptr ? kindByName(kinds, file) : kind;
}

/// The kind of a folder's files: of those recognised by their content, if there are any. Throws
/// InputError if there are several kinds.
const SourceKind* kindOfFolder(const std::vector<SourceKind>& kinds, const std::string& folder) {
  std::vector<fs::path> files = imports::expandName(folder);
  imports::sortNaturally(files);
  for (const auto& find : {kindByContent, kindByName}) {
    const SourceKind* found = nullptr;
    for (const fs::path& file : files) {
      const SourceKind* kind = find(kinds, file);
      if (kind == nullptr || kind == found) continue;
      if (found != nullptr) {
        throw InputError(fmt::format(
            "{}: holds {} and {}: choose files by a pattern like '{}'", folder, found->what,
            kind->what, (fs::path(folder) / ("*" + file.extension().string())).string()));
      }
      found = kind;
    }
    if (found != nullptr) return found;
  }
  return nullptr;
}

/// Error for a source that no kind recognises.
InputError unknownSource(NamedSource& source) {
  if (!source.isFile()) {
    return InputError(unknownName("scene", source.name(), sceneIds()) + ", and no such file");
  }
  std::error_code ignored;
  if (fs::is_directory(source.path(), ignored)) {
    return InputError(fmt::format("{}: holds no file that can be imported; expected: {}",
                                  source.name(), importKindsText()));
  }
  if (!source.isJson()) {
    static_cast<void>(openForReading(source.path()));  // throws if that is the reason
    return InputError(
        fmt::format("{}: its content has no known format; expected: {}; --format sets the format "
                    "of imported files",
                    source.name(), sourceKindsText()));
  }
  const std::string& schema = source.schema();
  const std::string kind =
      schema.empty() ? "no \"schema\"" : fmt::format("unknown \"schema\" '{}'", onOneLine(schema));
  return InputError(fmt::format("{}: {}; expected: {}", source.name(), kind, sourceKindsText()));
}

OpenedSource openAny(NamedSource& source, const OpeningOptions& options) {
  if (const auto import = importOf(source.name(), options.reading.format.value)) {
    return OpenedSource(
        {.source = importedSource({source.name()}, *import, options.reading), .cases = {}});
  }
  for (const SourceKind& kind : sourceKinds()) {
    if (!kind.import && kind.recognises(source)) return kind.open(source, options);
  }
  throw unknownSource(source);
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

bool hasSourceName(const fs::path& file) {
  return isRecordingName(file) || kindByName(importKinds(), file) != nullptr ||
         imports::hasExtension(file, {".json", ".jsonl"});
}

OpenedSource openSource(const std::string& name, const OpeningOptions& options) {
  NamedSource source(name);
  OpenedSource opened = openAny(source, options);
  for (PlanEntry& entry : opened.entries) adaptBoxes(entry.source, options.reading);
  return opened;
}

std::optional<FileImport> importOf(const std::string& name, const std::string& format) {
  if (isSceneId(name)) return {};
  const std::string file = NamedSource(name).name();
  const std::vector<SourceKind> kinds = importKinds();
  const SourceKind* kind = nullptr;
  if (format != "auto") {
    const auto has_format = [&](const SourceKind& other) {
      return std::ranges::count(other.import->formats, format) > 0;
    };
    kind = &*std::ranges::find_if(kinds, has_format);
  } else if (std::error_code ignored; fs::is_directory(file, ignored)) {
    kind = kindOfFolder(kinds, file);
  } else if (std::vector<fs::path> files = imports::expandName(file); !files.empty()) {
    imports::sortNaturally(files);
    kind = kindOf(kinds, files.front());
  }
  return kind == nullptr ? std::nullopt : kind->import;
}

std::vector<fs::path> filesToImport(const std::vector<std::string>& names, const FileImport& import,
                                    const std::string& format) {
  const std::vector<SourceKind> kinds = importKinds();
  const auto is_of_kind = [&](const fs::path& file) {
    const SourceKind* kind = kindOf(kinds, file);
    return kind != nullptr && kind->import->formats == import.formats;
  };
  std::vector<fs::path> files;
  std::optional<fs::path> other;  // the first of another kind
  for (const std::string& stated : names) {
    const std::string name = NamedSource(stated).name();
    std::vector<fs::path> expanded = imports::expandName(name);
    std::error_code ignored;
    if (fs::is_directory(name, ignored)) {
      std::erase_if(expanded, [&](const fs::path& file) { return !is_of_kind(file); });
      if (expanded.empty() && format != "auto") expanded = imports::expandName(name);
    } else if (format == "auto" && !other) {
      const auto found = std::ranges::find_if_not(expanded, is_of_kind);
      if (found != expanded.end()) other = *found;
    }
    if (expanded.empty()) {
      throw InputError(fmt::format("{}: matches no file; expected: {}", name,
                                   fmt::join(import.extensions, ", ")));
    }
    files.insert(files.end(), expanded.begin(), expanded.end());
  }
  if (other) {
    throw InputError(fmt::format("{}: not the same kind of file as {}: {} is expected",
                                 other->string(), files.front().string(),
                                 fmt::join(import.formats, ", ")));
  }
  imports::sortNaturally(files);
  return files;
}

std::string importKindsText() { return kindsText(importKinds()); }

InputError notImported(const std::string& name) {
  const std::string file = NamedSource(name).name();
  const auto because = [&](std::string_view reason) {
    return InputError(fmt::format("{}: {}; expected: {}", name, reason, importKindsText()));
  };
  if (isSceneId(name) || isRecordingName(file)) return because("cannot be imported");
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (fs::is_directory(status)) return because("holds no file that can be imported");
  if (imports::expandName(file).empty()) return because("matches no file");
  // Throws if that is the reason.
  if (!fs::exists(status) || fs::is_regular_file(status)) static_cast<void>(openForReading(file));
  return because("its content has no known format");
}

std::string importText(const Source& source) {
  if (!source.imported) return {};
  const imports::ImportSummary& summary = source.summary;
  const SceneInfo& scene = source.imported->scene();
  const auto corner = [](const auto& point) {
    return fmt::format("({:.6g} {:.6g} {:.6g})", point[0], point[1], point[2]);
  };
  std::string text = fmt::format(
      "{}: {}: {} ({}), initial pose and {}, box {} to {}, units {}", source.reference.path,
      summary.format, counted(scene.objects, "body", "bodies"), imports::lowered(scene.object_type),
      counted(scene.frames, "frame"), corner(scene.world.min), corner(scene.world.max),
      summary.units.empty() ? "not stated" : onOneLine(summary.units));
  const auto add = [&](const char* what, const std::vector<std::string>& parts) {
    if (parts.empty()) return;
    text += fmt::format("\n  {}: {}", what, onOneLine(fmt::format("{}", fmt::join(parts, "; "))));
  };
  add("used", summary.used);
  add("left out", summary.left_out);
  add("warning", summary.warnings);
  return text;
}

void requireReadingUsed(ReadingOptions options, const std::vector<PlanEntry>& entries) {
  for (const auto& [name, value] : options.changed()) {
    // "strict" and "format" say how files are read, not what they hold: results need not state
    // them.
    const auto uses = [key = name](const PlanEntry& entry) {
      return entry.source.reference.reading.contains(key) ||
             (entry.source.imported && (key == "format" || key == "strict"));
    };
    if (entries.empty() || std::ranges::any_of(entries, uses)) continue;
    throw InputError(
        fmt::format("{}: applies to none of the sources: omit it", parameterOption(name)));
  }
}

}  // namespace broadmark
