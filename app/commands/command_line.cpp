// The main command with the others as subcommands, and error messages for bad usage.

#include "commands/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "broadmark/error.h"
#include "broadmark/harness/environment.h"
#include "broadmark/names.h"
#include "command_line/run_requests.h"
#include "command_line/usage.h"
#include "commands/command.h"
#include "inspector/run_inspector.h"
#include "parts.h"
#include "request/former_names.h"
#include "request/plugins.h"
#include "run/export_case.h"
#include "run/headless.h"
#include "run/plan.h"
#include "sources/source.h"
#include "support/build_parts.h"
#include "support/exit_status.h"
#include "support/output.h"
#include "support/table.h"

namespace broadmark {

#define COMMAND(name)        \
  namespace commands::name { \
  Command command();         \
  }
#include "commands.inc"
#undef COMMAND

namespace {

/// The end of the main command's help.
std::string closingText(std::size_t width) {
  std::string text = "\nExit status:\n";
  for (const auto& [status, meaning] : kExitStatuses.entries) {
    text += fmt::format("  {:<4}{}\n", static_cast<int>(status), meaning);
  }
  std::string closing = "'broadmark COMMAND --help' shows a command's options, --help-all all.";
  if (parts::kInspector.included) {
    closing +=
        " Without --headless or a command, the inspector opens, with SOURCE if one is given.";
  }
  return text + '\n' + wrapped(closing, 0, 0, width) + '\n';
}

/// The version, the build, and the versions of its libraries: a package per line.
std::string verboseVersion() {
  constexpr const char* kLibraries =
#include "library_versions.inc"
      ;
  const Environment environment = thisEnvironment();
  return fmt::format("{}\ncommit: {}\ncompiler: {} {}\nbuild type: {}\nlibraries:{}",
                     environment.version, commitName(environment), environment.compiler,
                     environment.compiler_flags, environment.build_type, kLibraries);
}

std::vector<Command> allCommands() {
  return {
#define COMMAND(name) commands::name::command(),
#include "commands.inc"
#undef COMMAND
  };
}

class HelpFormatter final : public CLI::FormatterBase {
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    const std::size_t width = outputWidth();
    std::string text = helpText(*app, name, width);
    if (app->get_parent() != nullptr) return text;
    if (mode == CLI::AppFormatMode::All) {
      for (const CLI::App* command : commandsOf(*app)) {
        text += '\n' + helpText(*command, name + ' ' + command->get_name(), width);
      }
    }
    return text + closingText(width);
  }
};

/// Adds the options and examples of a command's help.
void describe(CLI::App& app, const std::vector<std::string>& examples) {
  app.set_help_flag("-h,--help", "print this help");
  std::string text;
  for (const std::string& example : examples) {
    text += fmt::format("{}broadmark {}", text.empty() ? "" : "\n", example);
  }
  app.footer(text);
}

/// Error message for an argument that `app` does not accept; suggests the nearest option.
std::string unexpectedText(const CLI::App& app, const std::string& argument) {
  if (!argument.starts_with('-')) return fmt::format("unexpected argument '{}'", argument);
  std::vector<std::string> known;
  for (const CLI::Option* option : shownOptions(app)) {
    if (!option->get_positional()) known.push_back(option->get_name());
  }
  const std::string name = argument.substr(0, argument.find('='));
  const std::string nearest = nearestName(name, known);
  return fmt::format("unknown option '{}'{}", name,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
}

/// CLI11's error message on a single line, with the names and terms of help.
std::string errorText(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  std::ranges::replace(message, '\n', ' ');
  // Returns the option with this name, or null.
  const auto option_of = [&](const std::string& name) { return app.get_option_no_throw(name); };
  // Joins the two options that CLI11's message names before and after `separator`; "" if it names
  // no two.
  const auto related = [&](const std::string& separator, const std::string& relation) {
    const auto at = message.find(separator);
    if (at == std::string::npos) return std::string();
    const CLI::Option* first = option_of(message.substr(0, at));
    const CLI::Option* second = option_of(message.substr(at + separator.size()));
    if (first == nullptr || second == nullptr) return std::string();
    return shownName(*first) + relation + shownName(*second);
  };
  const std::string kind = error.get_name();
  std::string text;
  if (kind == "RequiresError") text = related(" requires ", ": only with ");
  if (kind == "ExcludesError") text = related(" excludes ", ": cannot be combined with ");
  if (kind == "RequiredError") {
    const CLI::Option* option = option_of(message.substr(0, message.find(" is required")));
    if (option != nullptr && option->get_positional()) {
      text = fmt::format("no {} given", option->get_type_name());
    }
  }
  if (kind == "ArgumentMismatch") {
    const CLI::Option* option = option_of(message.substr(0, message.find(": ")));
    if (option != nullptr && message.ends_with(" missing")) {
      text =
          fmt::format("{}: a value ({}) is missing", shownName(*option), option->get_type_name());
    } else if (option != nullptr && message.find(": At Most 1 ") != std::string::npos) {
      text = fmt::format("{}: given more than once", shownName(*option));
    }
  }
  return text.empty() ? message : text;
}

/// The error of a wrong command line, which refers to the command's help.
InputError usageError(const CLI::App& main, const CLI::ParseError& error) {
  const auto chosen = main.get_subcommands();
  const CLI::App& app = chosen.empty() ? main : *chosen.front();
  std::string message = errorText(app, error);
  if (!app.remaining().empty()) message = unexpectedText(app, app.remaining().front());
  const std::string name = chosen.empty() ? "" : app.get_name();
  return InputError(fmt::format("{}{} (see 'broadmark {}--help')", name.empty() ? "" : name + ": ",
                                message, name.empty() ? "" : name + " "));
}

class CommandLine {
 public:
  CommandLine() {
    describe(app_, {"--headless freefall --objects 2000 --frames 60",
                    "--headless recording.aabbs --algorithm kd,tide --repetitions auto --json "
                    "results.json"});
    app_.formatter(std::make_shared<HelpFormatter>());
    app_.require_subcommand(0, 1);
    for (const Command& command : allCommands()) {
      CLI::App* added = app_.add_subcommand(command.name, command.summary);
      commands_.emplace_back(added, command.add(*added));
      describe(*added, command.examples);
      if (command.internal) added->group("");
    }
    app_.set_help_all_flag("--help-all", "print the help of all commands");
    CLI::Option* verbose = app_.add_flag(
        "--verbose", verbose_, "with --version: also print compiler and versions of libraries");
    const auto version = [this] {
      return verbose_ ? verboseVersion() : buildName(thisEnvironment());
    };
    verbose->needs(app_.set_version_flag("--version", version, "print version, commit and build"));
  }

  /// Parses a command line. Returns the requested help; nothing if there is a command to run.
  std::optional<std::string> parse(std::vector<std::string> arguments) {
    if (!arguments.empty()) requireNoMisspeltCommand(arguments.front());
    requireDoubleDashes(arguments);
    arguments = withCurrentOptions(std::move(arguments));
    std::ranges::reverse(arguments);  // the order that CLI11 expects
    try {
      app_.parse(std::move(arguments));
    } catch (const CLI::Success& success) {
      std::ostringstream out;
      app_.exit(success, out, out);
      return out.str();
    } catch (const CLI::ParseError& error) {
      throw usageError(app_, error);
    }
    requireNothingBeforeCommand();
    return {};
  }

  /// Returns the function that runs the parsed command; nothing for the main command.
  [[nodiscard]] std::function<int()> command() const {
    for (const auto& [app, run] : commands_) {
      if (app->parsed()) return run;
    }
    return {};
  }

  [[nodiscard]] SessionOptions session() const {
    const std::vector<std::string>& sources = session_.parsed().sources;
    if (!sources.empty()) requireNoMisspeltCommand(sources.front());
    return session_.options();
  }

  /// Returns the arguments together with those of their run request; nothing without a run request.
  [[nodiscard]] std::optional<std::vector<std::string>> withRequest(
      const std::vector<std::string>& given) const {
    const std::filesystem::path& file = session_.parsed().request_file;
    if (file.empty()) return std::nullopt;
    std::vector<std::string> all = argumentsOf(readInput(file), file.string(), app_, session_);
    all.insert(all.end(), given.begin(), given.end());
    return all;
  }

 private:
  /// Returns the command with this name, or null.
  [[nodiscard]] const CLI::App* find(const std::string& name) const {
    const auto found = std::ranges::find(
        commands_, name, [](const auto& command) { return command.first->get_name(); });
    return found == commands_.end() ? nullptr : found->first;
  }

  /// Throws InputError for options before a command, which would have no effect.
  void requireNothingBeforeCommand() const {
    const auto chosen = app_.get_subcommands();
    if (chosen.empty()) return;
    const std::string command = chosen.front()->get_name();
    for (const CLI::Option* option : app_.get_options()) {
      if (option->count() == 0) continue;
      throw InputError(fmt::format("{}: not an option of '{}' (see 'broadmark {} --help')",
                                   option->get_name(), command, command));
    }
  }

  /// Throws InputError if an argument is neither a source nor a command but resembles one.
  void requireNoMisspeltCommand(const std::string& argument) const {
    if (argument.starts_with('-') || isSource(argument) || find(argument) != nullptr) return;
    std::vector<std::string> names;
    for (const CLI::App* command : commandsOf(app_)) names.push_back(command->get_name());
    const std::string nearest = nearestName(argument, names);
    if (nearest.empty()) return;
    throw InputError(fmt::format("'{}': did you mean the command '{}'?", argument, nearest));
  }

  /// Throws InputError for "-headless", which CLI11 would take for -h with more letters.
  void requireDoubleDashes(const std::vector<std::string>& arguments) const {
    for (const std::string& argument : arguments) {
      if (argument.size() < 3 || !argument.starts_with("-h")) continue;
      const CLI::App* command = find(arguments.front());
      throw InputError(unexpectedText(command == nullptr ? app_ : *command, argument));
    }
  }

  bool verbose_ = false;
  CLI::App app_{"Broadmark tests, compares and validates broad-phase collision detection.",
                "broadmark"};
  SessionParser session_{app_};
  std::vector<std::pair<const CLI::App*, std::function<int()>>> commands_;
};

/// Options of a command line of the main command, together with those of its run request.
SessionOptions sessionOf(const CommandLine& line, const std::vector<std::string>& arguments) {
  const auto all = line.withRequest(arguments);
  CommandLine with_request;
  if (all) with_request.parse(*all);
  SessionOptions options = (all ? with_request : line).session();
  options.command_line = all.value_or(arguments);
  return options;
}

int listCases(const Plan& plan) {
  for (const std::string& id : caseIds(plan)) fmt::print("{}\n", id);
  return exit_status::success;
}

/// Throws InputError if this build lacks a part that the options need.
void requireParts(const SessionOptions& options) {
  if (!options.screenshot.empty()) requirePart(parts::kRenderer, "--screenshot");
  if (!options.cases.device.empty()) requirePart(parts::kOpenCl, "--device");
}

/// Throws InputError for a case that the inspector cannot show.
void requireShowable(const Plan& plan) {
  for (const PlanEntry& entry : plan.entries) {
    for (const Case& test_case : entry.cases) {
      if (!isQuery(test_case.answer)) continue;
      throw InputError(
          fmt::format("--case: {} answers queries, which the inspector does not show: "
                      "add --headless",
                      caseName(test_case)));
    }
  }
}

/// Makes the plan, then lists it, runs it, exports its case or opens it in the inspector. Returns
/// the exit status. Throws InputError.
int runSession(const SessionOptions& options) {
  // In the inspector, the user can end a simulation, and build a plug-in again.
  const bool inspects = options.inspector();
  const auto loading = inspects ? PluginLoading::copy : PluginLoading::in_place;
  addEnginesOf(options.plugins, inspects ? kNoEngineLimit : options.hosts.hard_limit_seconds,
               loading);
  Plan plan = makePlan(options, inspects ? PlanUse::open : PlanUse::run,
                       availableAlgorithms(options.plugins, loading));
  if (!options.written_request.empty()) {
    writeOutput(options.written_request, formatRunRequest(options));
    return exit_status::success;
  }
  if (options.list_only) return listCases(plan);
  requireParts(options);
  if (options.inspector()) {
    requireShowable(plan);
    return runInspector(std::move(plan), !options.headless, options.inspector_options);
  }
  if (!options.export_case.empty()) {
    return runExportCase(std::move(plan), options.export_case, options.quiet);
  }
  return runHeadless(std::move(plan), options.quiet);
}

}  // namespace

std::function<int()> parseCommandLine(const std::vector<std::string>& arguments) {
  const auto line = std::make_shared<CommandLine>();
  if (const auto help = line->parse(arguments)) {
    return [help] {
      std::fputs(help->c_str(), stdout);
      return 0;
    };
  }
  if (auto command = line->command()) {
    return [line, command = std::move(command)] { return command(); };
  }
  return [options = sessionOf(*line, arguments)] { return runSession(options); };
}

SessionOptions parseSession(const std::vector<std::string>& arguments) {
  CommandLine line;
  if (line.parse(arguments) || line.command()) {
    throw InputError("not a command line of the main command");
  }
  return sessionOf(line, arguments);
}

}  // namespace broadmark
