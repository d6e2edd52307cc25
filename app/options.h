// The command line, parsed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "movie.h"
#include "broadmark/parameters.h"
#include "broadmark/runner.h"
#include "broadmark/render/picture.h"

namespace broadmark {

/// What is simulated when a source is a built-in scene.
struct SceneOptions {
  std::vector<std::uint32_t> objects;     ///< empty: the scene's default
  std::vector<std::string> object_types;  ///< likewise
  /// Scene parameters given by options of their own (--frames, --seed, …), by parameter name.
  ParameterValues parameters;
  std::vector<std::string> recorders;  ///< kinds of recordings to keep; the first is run on
};

/// One part of a run that is divided among machines: cases whose number is index (mod count).
struct Shard {
  int index = 0;
  int count = 1;
};

struct HeadlessOptions {
  std::vector<std::string> sources;
  SceneOptions scene;
  std::vector<std::string> plugins;     ///< libraries with more algorithms
  std::string case_id;                  ///< of the results file that is the source; "": none
  std::filesystem::path export_case;    ///< where its smallest failing recording goes; "": nowhere
  std::vector<std::string> algorithms;  ///< ids, families, globs, "all"; empty: all
  std::vector<int> threads;
  std::vector<Isa> isas;
  std::string device;          ///< compute device: "" for the first
  ParameterValues parameters;  ///< --param: of algorithms or scenes, whoever has them
  int repetitions = 1;
  int warmup = 0;
  double frame_limit_seconds = 0.5;
  CheckMode check = CheckMode::full;
  bool memory = false;
  std::map<std::string, std::filesystem::path> outputs;  ///< by result writer's name
  std::filesystem::path record;                          ///< "": keep no recordings
  std::filesystem::path screenshot;                      ///< "": none
  std::optional<std::uint32_t> screenshot_frame;         ///< nothing: the last one
  int screenshot_width = 1280;
  int screenshot_height = 720;
  GlSource gl = GlSource::automatic;
  Shard shard;
  std::string filter;
  bool list_only = false;
  bool quiet = false;
  bool headless = false;
  bool ui = false;               ///< the inspector, without a window
  std::filesystem::path script;  ///< of the inspector; "": none
  std::vector<std::string> command_line;
};

struct ListOptions {
  std::string what = "all";
  std::vector<std::string> plugins;
};

struct BakeOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> parameter_files;  ///< more scenes, described in files
  SceneOptions scene;
  ParameterValues parameters;
  std::filesystem::path output;
  int threads = 1;
  std::optional<MovieOptions> movie;
  bool list_only = false;
  bool force = false;
  bool quiet = false;
};

struct VerifyOptions {
  std::vector<std::filesystem::path> files;
  bool describe = false;
  std::filesystem::path json;  ///< "": none
  bool quiet = false;
};

struct CompareOptions {
  std::filesystem::path before;
  std::filesystem::path after;
  double fail_above = 0.05;
};

/// Parses the command line and runs the command it asks for. Returns the exit status. Throws
/// InputError.
int runCommandLine(int argc, char** argv);

// The commands. Each returns the exit status and throws InputError.
int runHeadless(const HeadlessOptions&);
/// Shrinks the case of a results file instead of running it.
int runExportCase(const HeadlessOptions&);
int runInspector(const HeadlessOptions&);
int runBake(const BakeOptions&);
int runList(const ListOptions&);
int runVerify(const VerifyOptions&);
int runCompare(const CompareOptions&);

}  // namespace broadmark
