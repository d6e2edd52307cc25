// Sources: names of scenes, and files of several kinds. A kind is one file in this folder and one
// line in the list in CMakeLists.txt.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/error.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/results/results.h"
#include "broadmark/scenes/simulation.h"
#include "imports/import_summary.h"
#include "original/settings.h"
#include "request/reading_options.h"
#include "request/run_request.h"
#include "support/contents.h"

namespace broadmark {

/// A recording before it is opened: metadata that needs no reading or simulating of frames.
struct Source {
  RecordingReference reference;                  ///< hash and path filled by openRecording()
  std::unique_ptr<Simulation> simulation;        ///< null for an existing recording
  std::unique_ptr<IndexedFrames> imported = {};  ///< frames of imported files; else null
  imports::ImportSummary summary = {};           ///< of imported files
  std::string expected_hash = {};                ///< hash the recording must have; "": any
};

/// A recording with the cases to run on it.
struct PlanEntry {
  Source source;
  std::vector<Case> cases;
  /// Set if a settings file of the original defines source and case.
  std::optional<OriginalSettings> original = {};
  /// The previous result, if a results file defines source and case.
  std::optional<CaseResult> known = {};
  std::filesystem::path screenshot = {};  ///< "": none

  /// First mismatch of the previous result, if any.
  [[nodiscard]] std::optional<FrameDifference> knownDifference() const;
};

/// A source that has been opened.
struct OpenedSource {
  OpenedSource() = default;
  explicit OpenedSource(PlanEntry entry) { entries.push_back(std::move(entry)); }

  /// Entries of scenes and recordings have no cases yet.
  std::vector<PlanEntry> entries;
  /// Set for a results file without a chosen case; `entries` is then empty.
  std::optional<Results> results = {};
};

/// A source given by name. Its text and schema are read lazily, once.
class NamedSource {
 public:
  /// "-": standard input.
  explicit NamedSource(std::string name)
      : name_(name == "-" ? imports::kStandardInput : std::move(name)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::filesystem::path path() const { return name_; }
  /// Whether the name refers to a file: it has an extension or a '/', or the file exists.
  [[nodiscard]] bool isFile() const;
  [[nodiscard]] bool isJson() const;
  /// Returns the file's text. Throws InputError.
  const std::string& text();
  /// Returns the JSON file's schema, like jsonSchema(). Throws InputError.
  const std::string& schema();

 private:
  std::string name_;
  std::optional<std::string> text_;
  std::optional<std::string> schema_;
};

/// Options for opening sources of any kind.
struct OpeningOptions {
  SceneOptions scene;          ///< of simulated scenes
  ParameterValues parameters;  ///< --param: of scenes or algorithms
  ReadingOptions reading;
  std::string case_id;                ///< in a results file; "": none chosen
  std::vector<Algorithm> algorithms;  ///< all available, including plug-ins
};

/// Reader for files of other programs. Several files form a sequence.
struct FileImport {
  std::vector<std::string> formats;     ///< values of ReadingOptions::format
  std::vector<std::string> extensions;  ///< in lower case: ".csv"
  std::vector<std::string> options;     ///< names of the ReadingOptions it uses
  /// Whether the file is of this kind, by its content.
  bool (*recognises)(const imports::FileStart&) = nullptr;
  /// Throws InputError. Readers open files with imports::openContents() or LineReader.
  std::unique_ptr<IndexedFrames> (*open)(const std::vector<std::filesystem::path>&,
                                         const ReadingOptions&, imports::ImportSummary&) = nullptr;
};

/// A kind of source: `broadmark::sources::NAME::kind()` for a NAME in the list in CMakeLists.txt.
struct SourceKind {
  std::string what;  ///< description for help and messages: "recordings (.aabbs, .posrot)"
  bool (*recognises)(NamedSource&) = nullptr;
  OpenedSource (*open)(NamedSource&, const OpeningOptions&) = nullptr;
  /// Replaces both functions for files of other programs, folders of them, and patterns.
  std::optional<FileImport> import = {};
};
std::vector<SourceKind> sourceKinds();
/// Text for help and messages: "built-in scenes (freefall, …), recordings …".
std::string sourceKindsText();

/// Whether the name is a built-in scene's id or refers to a file.
bool isSource(const std::string& name);

/// Whether a file is named like a source, compressed or not; others may be recognised by their
/// content.
bool hasSourceName(const std::filesystem::path&);

/// Opens a source by the first kind that recognises it. Throws InputError.
OpenedSource openSource(const std::string& name, const OpeningOptions&);

/// Returns how to import a source; nothing if it is not a file of another program. Its kind is that
/// of the `format`, unless that is "auto"; else that of its content; else that of its extension.
/// Throws InputError.
std::optional<FileImport> importOf(const std::string& name, const std::string& format = "auto");
/// All files that these names refer to, in natural order; of folders only those of this kind.
/// Throws InputError for a name without files, or, unless a format is stated, for a file of another
/// kind.
std::vector<std::filesystem::path> filesToImport(const std::vector<std::string>& names,
                                                 const FileImport&, const std::string& format);
/// Kinds of files that can be imported, for help and messages.
std::string importKindsText();
/// Error for a name that importOf() does not know. Throws InputError if it cannot be read.
InputError notImported(const std::string& name);

/// What was understood of imported files, in a few lines; "" for other sources.
std::string importText(const Source&);

/// Throws InputError for a reading option that applies to none of these sources.
void requireReadingUsed(ReadingOptions, const std::vector<PlanEntry>&);

}  // namespace broadmark
