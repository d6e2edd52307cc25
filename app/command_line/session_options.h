// The options of the main command: a run request, and what is to be done with it.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "request/run_request.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// A run request, and what is to be done with it.
struct SessionOptions : RunRequest {
  std::filesystem::path export_case;   ///< where its smallest failing recording goes; "": nowhere
  std::filesystem::path request_file;  ///< source of further options; "": none
  std::filesystem::path written_request;  ///< where the request goes, which is not run; "": nowhere
  bool list_only = false;
  bool quiet = false;
  bool headless = false;
  bool ui = false;               ///< the inspector, without a window
  std::filesystem::path script;  ///< of the inspector; "": none

  [[nodiscard]] bool inspector() const { return !headless || ui; }
};

/// The options of the main command as CLI11 has them.
class SessionParser {
 public:
  /// Adds them to `app`, which is destroyed first.
  explicit SessionParser(CLI::App& app);
  SessionParser(const SessionParser&) = delete;
  SessionParser& operator=(const SessionParser&) = delete;

  /// What `app` has parsed, not yet checked.
  [[nodiscard]] const SessionOptions& parsed() const { return options_; }
  /// Gives the options the values of a request, as if they had been parsed.
  void set(const RunRequest& request) { static_cast<RunRequest&>(options_) = request; }
  /// Whether a run request has this option.
  [[nodiscard]] bool isOfRequest(const CLI::Option& option) const;
  /// The options, after `app` has parsed a command line. Throws InputError for options that cannot
  /// be combined.
  [[nodiscard]] SessionOptions options() const;

 private:
  void addCall();
  void addCases();
  void addRun();
  void addOutput();
  void addPictures();
  void addScene();
  void addCaseOfResults();
  /// States what an option cannot be combined with.
  void tag(const CLI::Option* option, unsigned conflicts);
  void requireNoConflict() const;

  CLI::App& app_;
  SessionOptions options_;
  std::vector<std::pair<const CLI::Option*, unsigned>> tagged_;
};

}  // namespace broadmark
