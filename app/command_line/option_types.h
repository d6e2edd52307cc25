// Options shared by several commands, and their types of values. Values are stored while the
// command line is parsed; an invalid value throws an InputError that names the option. Targets must
// outlive the parsing.
//
// An option that is part of a run request also formats its current value, as
// CLI::Option::default_function(): on one line, or one per repetition of the option.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/harness/case.h"
#include "broadmark/names.h"
#include "command_line/usage.h"
#include "request/hosts.h"
#include "request/reading_options.h"
#include "request/run_request.h"
#include "support/build_parts.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// Parses a finite number >= `min`, or > `min` if `open`.
double parseNumber(const std::string& text, std::string_view option, double min, bool open);

/// Parses a share, "1%" or "0.01": > 0 or, unless `open`, >= 0.
double parseShare(const std::string& text, std::string_view option, bool open);

/// Returns the value called `text` in a NameTable.
template <class Table>
auto parseNamed(const std::string& text, std::string_view option, const Table& table) {
  if (const auto value = table.find(text)) return *value;
  throw InputError(std::string(option) + ": " + unknownName("value", text, table.names()));
}

/// Formats the current value of an option; "": the option is not set.
using ValueText = std::function<std::string()>;

/// An option with one value, which `set` stores. Help shows the default, the initial `get()`.
CLI::Option* addValue(CLI::App&, const std::string& name, const std::string& type,
                      const std::function<void(const std::string&)>& set, const ValueText& get,
                      const std::string& doc);

/// An option without a value.
CLI::Option* addFlag(CLI::App&, const std::string& name, bool& target, const std::string& doc);

/// An option with an integer value. The default is the value of `target`.
template <class Integer>
CLI::Option* addInteger(CLI::App& app, const std::string& name, const std::string& type,
                        Integer& target, long long min, long long max, const std::string& doc) {
  const auto set = [&target, name, min, max](const std::string& text) {
    target = static_cast<Integer>(parseInteger(text, name, min, max));
  };
  return addValue(app, name, type, set, [&target] { return std::to_string(target); }, doc);
}

/// An option with a name of a NameTable as value. The default is the value of `target`.
template <class Value, class Table>
CLI::Option* addNamed(CLI::App& app, const std::string& name, const std::string& type,
                      Value& target, const Table& table, const std::string& doc) {
  const auto set = [&target, name, &table](const std::string& text) {
    target = parseNamed(text, name, table);
  };
  const auto get = [&target, &table] { return std::string(table.nameOf(target)); };
  return suggestValues(addValue(app, name, type, set, get, doc), table.names());
}

/// An option with a path as value.
CLI::Option* addPath(CLI::App&, const std::string& name, const std::string& type,
                     std::filesystem::path& target, const std::string& doc);

/// An option with a number greater than 0 as value. The default is the value of `target`.
CLI::Option* addPositive(CLI::App&, const std::string& name, const std::string& type,
                         double& target, const std::string& doc);

/// An option with a share as value, "1%" or "0.01": > 0 or, unless `open`, >= 0. The default is the
/// value of `target`.
CLI::Option* addShare(CLI::App&, const std::string& name, double& target, bool open,
                      const std::string& doc);

/// An option with a text as value.
CLI::Option* addText(CLI::App&, const std::string& name, const std::string& type,
                     std::string& target, const std::string& doc);

/// A repeatable option with a comma-separated list as value; `set` gets the parts of all lists.
CLI::Option* addList(CLI::App&, const std::string& name, const std::string& type,
                     std::function<void(const std::vector<std::string>&)> set, const ValueText& get,
                     const std::string& doc);

/// A repeatable option with one value, which may contain commas.
CLI::Option* addRepeatable(CLI::App&, const std::string& name, const std::string& type,
                           std::vector<std::string>& target, const std::string& doc);

/// Hides options from help if this build lacks the part that they need, by removing their
/// descriptions.
void hideWithout(const BuildPart&, const std::vector<CLI::Option*>& options);

/// --plugin: for addEnginesOf() and availableAlgorithms(). `more`: what the command loads from it.
CLI::Option* addPlugins(CLI::App&, std::vector<std::string>& plugins,
                        const std::string& more = "algorithms or physics engines");
/// --external: adds to the plug-ins. Define it after --plugin, which replaces them.
CLI::Option* addExternal(CLI::App&, std::vector<std::string>& plugins);
/// --param
CLI::Option* addParameters(CLI::App&, ParameterValues&);
/// An output file in one of several formats; `outputs` holds the given paths by `format`.
CLI::Option* addOutput(CLI::App&, std::string_view format, OutputPaths& outputs,
                       std::string_view doc);
/// Output files of results: --json, --csv, …
std::vector<CLI::Option*> addResultOutputs(CLI::App&, OutputPaths&);
/// --quiet
CLI::Option* addQuiet(CLI::App&, bool& quiet);
/// --recorder
CLI::Option* addRecorders(CLI::App&, std::vector<std::string>& recorders);
/// --size and --gl. Help shows them only in builds with the renderer.
std::vector<CLI::Option*> addPictureOptions(CLI::App&, PictureOptions&);
/// Options that select variants: --algorithm, --threads, --isa
std::vector<CLI::Option*> addVariants(CLI::App&, CaseOptions&);
/// --count
CLI::Option* addCount(CLI::App&, CountOptions&);
/// --filter
CLI::Option* addFilter(CLI::App&, std::string& filter);
/// --answer
std::vector<CLI::Option*> addAnswer(CLI::App&, Answer& answer);
/// --device. Help shows it only in builds with OpenCL.
CLI::Option* addDevice(CLI::App&, std::string& device);
/// Options of the processes that run cases: --in-process, --pin, --hard-limit, --memory-limit
std::vector<CLI::Option*> addHosts(CLI::App&, HostOptions&);
/// Options for reading the files of a source: --swept, --elements, …
std::vector<CLI::Option*> addReadingOptions(CLI::App&, ReadingOptions&);
/// Options of a scene: --objects, --object-type, --frames, …
std::vector<CLI::Option*> addSceneOptions(CLI::App&, SceneOptions&);

}  // namespace broadmark
