// What a session can be opened on: a scene's name, or a file of some kind. One kind, one file in
// this folder and one line in the list in CMakeLists.txt.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/case.h"
#include "broadmark/oracle.h"
#include "broadmark/results.h"
#include "broadmark/scenes/simulation.h"
#include "original/settings.h"
#include "scene_options.h"

namespace broadmark {

/// One recording to be: everything known of it before a frame is read or simulated.
struct Source {
  RecordingReference reference;            ///< hash and path filled by openRecording()
  std::unique_ptr<Simulation> simulation;  ///< null for a given recording
  std::string expected_hash = {};          ///< what the recording must be; "": whatever it is
};

/// A recording with the cases to be run on it.
struct PlanEntry {
  Source source;
  std::vector<Case> cases;
  /// When the original's settings file names both.
  std::optional<OriginalSettings> original = {};
  /// When both are of a results file: the result that it holds.
  std::optional<CaseResult> known = {};
  std::filesystem::path screenshot = {};  ///< "": none

  /// What was wrong in the first frame that was, as far as it is known.
  [[nodiscard]] std::optional<FrameDifference> knownDifference() const;
};

/// A source that has been opened.
struct OpenedSource {
  /// Those of a scene or a recording have no cases of their own.
  std::vector<PlanEntry> entries;
  /// A results file one of whose cases is still to be chosen: then there are no entries.
  std::optional<Results> results = {};
};

/// What was named, with its text read and its schema found out once at the most.
class NamedSource {
 public:
  explicit NamedSource(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::filesystem::path path() const { return name_; }
  /// Whether it can only mean a file: it has an extension or a '/', or there is one.
  [[nodiscard]] bool isFile() const;
  [[nodiscard]] bool isJson() const;
  /// Of a file. Throws InputError.
  const std::string& text();
  /// Of a JSON file, as jsonSchema(). Throws InputError.
  const std::string& schema();

 private:
  std::string name_;
  std::optional<std::string> text_;
  std::optional<std::string> schema_;
};

/// What a kind of source may need to be opened.
struct OpeningOptions {
  SceneOptions scene;                 ///< of scenes that are simulated
  ParameterValues parameters;         ///< --param: of scenes or algorithms, whoever has them
  std::string case_id;                ///< of a results file; "": none chosen
  std::vector<Algorithm> algorithms;  ///< that there are, plug-ins included
};

/// A kind of source, as CMake's list has it: `broadmark::sources::NAME::kind()`.
struct SourceKind {
  std::string what;  ///< for help and messages: "recordings (.aabbs, .posrot)"
  bool (*recognises)(NamedSource&);
  OpenedSource (*open)(NamedSource&, const OpeningOptions&);
};
std::vector<SourceKind> sourceKinds();

/// Whether it is a built-in scene's name, or may be a file.
bool isSource(const std::string& name);

/// Opens what is named, by the first kind that recognises it. Throws InputError.
OpenedSource openSource(const std::string& name, const OpeningOptions&);

}  // namespace broadmark
