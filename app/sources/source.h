// What a session can be opened on: a scene's name, or a file of some kind. One kind, one file in
// this folder and one line in the list in CMakeLists.txt.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/results/results.h"
#include "broadmark/scenes/simulation.h"
#include "original/settings.h"
#include "request/reading_options.h"
#include "request/run_request.h"

namespace broadmark {

/// A recording before it is opened: everything known without reading or simulating a frame.
struct Source {
  RecordingReference reference;                  ///< hash and path filled by openRecording()
  std::unique_ptr<Simulation> simulation;        ///< null for a given recording
  std::unique_ptr<IndexedFrames> imported = {};  ///< of files that are no recording; else null
  std::string expected_hash = {};                ///< that the recording must have; "": any
};

/// A recording with the cases to be run on it.
struct PlanEntry {
  Source source;
  std::vector<Case> cases;
  /// When a settings file of the original names source and case.
  std::optional<OriginalSettings> original = {};
  /// When source and case are of a results file: the result it holds.
  std::optional<CaseResult> known = {};
  std::filesystem::path screenshot = {};  ///< "": none

  /// The first mismatch of the known result, if it has one.
  [[nodiscard]] std::optional<FrameDifference> knownDifference() const;
};

/// A source that has been opened.
struct OpenedSource {
  OpenedSource() = default;
  explicit OpenedSource(PlanEntry entry) { entries.push_back(std::move(entry)); }

  /// Scenes and recordings have no cases of their own.
  std::vector<PlanEntry> entries;
  /// A results file without a chosen case: then there are no entries.
  std::optional<Results> results = {};
};

/// What was named. Its text is read once and its schema found once, when first needed.
class NamedSource {
 public:
  explicit NamedSource(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::filesystem::path path() const { return name_; }
  /// Whether it means a file: it has an extension or a '/', or there is such a file.
  [[nodiscard]] bool isFile() const;
  [[nodiscard]] bool isJson() const;
  /// The file's text. Throws InputError.
  const std::string& text();
  /// The JSON file's schema, as jsonSchema(). Throws InputError.
  const std::string& schema();

 private:
  std::string name_;
  std::optional<std::string> text_;
  std::optional<std::string> schema_;
};

/// What a kind of source may need to be opened.
struct OpeningOptions {
  SceneOptions scene;          ///< of scenes that are simulated
  ParameterValues parameters;  ///< --param: of scenes or algorithms
  ReadingOptions reading;
  std::string case_id;                ///< of a results file; "": none chosen
  std::vector<Algorithm> algorithms;  ///< all available ones, plug-ins included
};

/// How files of other programs are read. Several of them are a sequence.
struct FileImport {
  std::vector<std::string> extensions;  ///< in lower case: ".csv"
  std::vector<std::string> options;     ///< names of the ReadingOptions that it uses
  /// Throws InputError.
  std::unique_ptr<IndexedFrames> (*open)(const std::vector<std::filesystem::path>&,
                                         const ReadingOptions&);
};

/// A kind of source: `broadmark::sources::NAME::kind()` for a NAME in the list in CMakeLists.txt.
struct SourceKind {
  std::string what;  ///< in help and messages: "recordings (.aabbs, .posrot)"
  bool (*recognises)(NamedSource&) = nullptr;
  OpenedSource (*open)(NamedSource&, const OpeningOptions&) = nullptr;
  /// Takes the place of the other two: files with these extensions, folders of them, and patterns.
  std::optional<FileImport> import = {};
};
std::vector<SourceKind> sourceKinds();
/// What all of them are, for help and messages: "built-in scenes (freefall, …), recordings …".
std::string sourceKindsText();

/// Whether it is a built-in scene's id, or means a file.
bool isSource(const std::string& name);

/// Opens what is named, by the first kind that recognises it. Throws InputError.
OpenedSource openSource(const std::string& name, const OpeningOptions&);

/// How to import what is named; nothing if that is no file of another program.
std::optional<FileImport> importOf(const std::string& name);
/// The kinds of files that can be imported, for help and messages.
std::string importKindsText();

/// Throws InputError for a reading option that none of these sources uses.
void requireReadingUsed(ReadingOptions, const std::vector<PlanEntry>&);

}  // namespace broadmark
