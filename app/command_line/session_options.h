// The options of the main command: what is opened, which cases are run on it, and what is kept.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/harness/case_run.h"
#include "request/cases.h"
#include "request/hosts.h"
#include "request/picture_options.h"
#include "request/reading_options.h"
#include "request/repetitions.h"
#include "request/scene_options.h"
#include "run/result_files.h"

namespace CLI {
class App;
}

namespace broadmark {

/// One part of a run that is divided among machines: every `count`-th case from the `index`-th.
struct Shard {
  int index = 0;
  int count = 1;
};

struct SessionOptions {
  std::vector<std::string> sources;
  SceneOptions scene;
  CaseOptions cases;
  ParameterValues parameters;  ///< --param: of algorithms or scenes
  ReadingOptions reading;
  std::vector<std::string> plugins;   ///< libraries with more algorithms or engines
  std::string case_id;                ///< of the results file that is the source; "": none
  std::filesystem::path export_case;  ///< where its smallest failing recording goes; "": nowhere
  RepetitionOptions repetitions;
  int warmup = 0;
  RunPolicy policy;
  bool allow_timeout = false;  ///< a case that crosses a time limit is no failure of the run
  HostOptions hosts;
  ResultPaths outputs;
  std::filesystem::path record;        ///< "": keep no recordings
  std::filesystem::path screenshot;    ///< "": none
  std::optional<std::uint32_t> frame;  ///< of the screenshot, or where the inspector opens
  PictureOptions picture;
  Shard shard;
  std::string filter;  ///< regular expression
  bool list_only = false;
  bool quiet = false;
  bool headless = false;
  bool ui = false;               ///< the inspector, without a window
  std::filesystem::path script;  ///< of the inspector; "": none
  std::vector<std::string> command_line;

  [[nodiscard]] bool inspector() const { return !headless || ui; }
};

/// The options of the main command as CLI11 has them.
class SessionParser {
 public:
  /// Adds them to `app`, which is destroyed first.
  explicit SessionParser(CLI::App& app);
  ~SessionParser();
  SessionParser(const SessionParser&) = delete;
  SessionParser& operator=(const SessionParser&) = delete;

  /// The sources alone, after `app` has parsed a command line.
  [[nodiscard]] const std::vector<std::string>& sources() const;
  /// The options, after `app` has parsed a command line. Throws InputError for options that cannot
  /// be combined.
  [[nodiscard]] SessionOptions options() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace broadmark
