// Options of the main command.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "request/inspector_options.h"
#include "request/run_request.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// A run request, and what to do with it.
struct SessionOptions : RunRequest {
  std::filesystem::path export_case;      ///< output for the smallest failing recording; "": none
  std::filesystem::path request_file;     ///< request with further options; "": none
  std::filesystem::path written_request;  ///< output for the request, instead of a run; "": none
  bool list_only = false;
  bool quiet = false;
  bool headless = false;
  bool ui = false;  ///< run the inspector without a window
  InspectorOptions inspector_options;

  [[nodiscard]] bool inspector() const { return !headless || ui; }
};

/// Parses the options of the main command with CLI11.
class SessionParser {
 public:
  /// Adds the options to `app`, which must be destroyed before this.
  explicit SessionParser(CLI::App& app);
  SessionParser(const SessionParser&) = delete;
  SessionParser& operator=(const SessionParser&) = delete;

  /// Options parsed by `app`, not yet validated.
  [[nodiscard]] const SessionOptions& parsed() const { return options_; }
  /// Sets the options to the values of a request, as if they had been parsed.
  void set(const RunRequest& request) { static_cast<RunRequest&>(options_) = request; }
  /// Whether the option is part of run requests.
  [[nodiscard]] bool isRequestOption(const CLI::Option& option) const;
  /// Returns the options after `app` has parsed a command line. Throws InputError for conflicting
  /// options.
  [[nodiscard]] SessionOptions options() const;

 private:
  void addSources();
  void addCases();
  void addRun();
  void addOutput();
  void addPictures();
  void addCaseOfResults();
  void addInvocation();
  /// Stores the conflicts of an option.
  void tag(const CLI::Option* option, unsigned conflicts);
  void requireNoConflict() const;

  CLI::App& app_;
  SessionOptions options_;
  std::vector<std::pair<const CLI::Option*, unsigned>> tagged_;
};

}  // namespace broadmark
