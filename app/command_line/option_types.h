// What the options of several commands share: how values are written, and whole options. A value
// is taken over while the command line is parsed; a bad one throws an InputError that names the
// option. Targets must outlive the parsing.
//
// An option that is part of a run request also states how its present value is written, as
// CLI::Option::default_function(): one line, or one for each time that the option is to be given.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/harness/case.h"
#include "broadmark/names.h"
#include "request/hosts.h"
#include "request/reading_options.h"
#include "request/run_request.h"
#include "support/build_parts.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// A finite number >= `min`, or > `min` when `open`.
double parseNumber(const std::string& text, std::string_view option, double min, bool open);

/// The value called `text` in a NameTable.
template <class Table>
auto parseNamed(const std::string& text, std::string_view option, const Table& table) {
  if (const auto value = table.find(text)) return *value;
  throw InputError(std::string(option) + ": " + unknownName("value", text, table.names()));
}

/// How the present value of an option is written; "": as if the option were not given.
using ValueText = std::function<std::string()>;

/// An option of one value, which `set` takes over. Help shows the default, `get()` at first.
CLI::Option* addValue(CLI::App&, const std::string& name, const std::string& type,
                      const std::function<void(const std::string&)>& set, const ValueText& get,
                      const std::string& doc);

/// An option without a value.
CLI::Option* addFlag(CLI::App&, const std::string& name, bool& target, const std::string& doc);

/// An option of one integer. The default is what `target` holds.
template <class Integer>
CLI::Option* addInteger(CLI::App& app, const std::string& name, const std::string& type,
                        Integer& target, long long min, long long max, const std::string& doc) {
  const auto set = [&target, name, min, max](const std::string& text) {
    target = static_cast<Integer>(parseInteger(text, name, min, max));
  };
  return addValue(
      app, name, type, set, [&target] { return std::to_string(target); }, doc);
}

/// An option of one name of a NameTable. The default is what `target` holds.
template <class Value, class Table>
CLI::Option* addNamed(CLI::App& app, const std::string& name, const std::string& type,
                      Value& target, const Table& table, const std::string& doc) {
  const auto set = [&target, name, &table](const std::string& text) {
    target = parseNamed(text, name, table);
  };
  const auto get = [&target, &table] { return std::string(table.nameOf(target)); };
  return addValue(app, name, type, set, get, doc);
}

/// An option of a path.
CLI::Option* addPath(CLI::App&, const std::string& name, const std::string& type,
                     std::filesystem::path& target, const std::string& doc);

/// An option of a number greater than 0. The default is what `target` holds.
CLI::Option* addPositive(CLI::App&, const std::string& name, const std::string& type,
                         double& target, const std::string& doc);

/// An option of a share, "1%" or "0.01": > 0 or, unless `open`, 0. The default is what `target`
/// holds.
CLI::Option* addShare(CLI::App&, const std::string& name, double& target, bool open,
                      const std::string& doc);

/// An option of a text.
CLI::Option* addText(CLI::App&, const std::string& name, const std::string& type,
                     std::string& target, const std::string& doc);

/// An option of a comma-separated list, which may be repeated; `set` gets all parts.
CLI::Option* addList(CLI::App&, const std::string& name, const std::string& type,
                     std::function<void(const std::vector<std::string>&)> set, const ValueText& get,
                     const std::string& doc);

/// An option of one value that may be repeated; commas are part of the value.
CLI::Option* addRepeatable(CLI::App&, const std::string& name, const std::string& type,
                           std::vector<std::string>& target, const std::string& doc);

/// Hides options from help if the part that they need has been left out of this build: they then
/// have no description.
void showWith(const BuildPart&, const std::vector<CLI::Option*>& options);

/// --plugin: for addEnginesOf() and availableAlgorithms(). `more`: what the command takes from it.
CLI::Option* addPlugins(CLI::App&, std::vector<std::string>& plugins,
                        const std::string& more = "algorithms or physics engines");
/// --param
CLI::Option* addParameters(CLI::App&, ParameterValues&);
/// A file of results in one of several formats; `outputs` has those that are given, by `format`.
CLI::Option* addOutput(CLI::App&, std::string_view format, ResultPaths& outputs,
                       std::string_view doc);
/// Where results go: --json, --csv, …
std::vector<CLI::Option*> addResultOutputs(CLI::App&, ResultPaths&);
/// --quiet
CLI::Option* addQuiet(CLI::App&, bool& quiet);
/// --recorder. Sets the default, too.
CLI::Option* addRecorders(CLI::App&, std::vector<std::string>& recorders);
/// --size and --gl. Help shows them only if there is a renderer.
std::vector<CLI::Option*> addPictureOptions(CLI::App&, PictureOptions&);
/// --answer.
CLI::Option* addAnswer(CLI::App&, AnswerKind& answer);
/// --device. Help shows it only if there is OpenCL.
CLI::Option* addDevice(CLI::App&, std::string& device);
/// Where cases run: --in-process, --pin, --hard-limit, --memory-limit
std::vector<CLI::Option*> addHosts(CLI::App&, HostOptions&);
/// How the files of a source are read: --swept, --elements, …
std::vector<CLI::Option*> addReadingOptions(CLI::App&, ReadingOptions&);
/// What a scene is like: --objects, --object-type, --frames, …
std::vector<CLI::Option*> addSceneOptions(CLI::App&, SceneOptions&);

}  // namespace broadmark
