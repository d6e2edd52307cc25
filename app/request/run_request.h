// What is to be run: a plain, complete value.
//
// A command line, a file (JSON, docs/run-requests.md), the inspector, the Python package and
// campaigns each state one. Nothing that runs it looks at the command line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/harness/case_run.h"
#include "broadmark/parameters.h"
#include "broadmark/render/picture.h"
#include "request/cases.h"
#include "request/hosts.h"
#include "request/reading_options.h"
#include "request/repetitions.h"

namespace broadmark {

/// What is simulated when a source is a scene or a batch is baked.
struct SceneOptions {
  std::vector<std::uint32_t> objects;  ///< numbers of bodies, ascending; empty: the scene's default
  std::vector<std::string> object_types;  ///< empty: the scene's default
  /// Scene parameters given by options of their own (--frames, --seed, …), by parameter name. A
  /// text may hold several values (sweep.h).
  ParameterValues parameters;
  /// Kinds of recordings to keep; the first is run on. Empty: recordingExtension() of the scene.
  std::vector<std::string> recorders;
};

/// How pictures are drawn off-screen.
struct PictureOptions {
  int width = 1280;
  int height = 720;
  GlSource gl = GlSource::automatic;
};

/// One part of a run that is divided among machines: every `count`-th case from the `index`-th.
struct Shard {
  int index = 0;
  int count = 1;
};

/// Where the results of a run go, by the name of the result writer.
using ResultPaths = std::map<std::string, std::filesystem::path>;

struct RunRequest {
  std::vector<std::string> sources;
  std::vector<std::string> plugins;  ///< libraries with more algorithms or engines
  SceneOptions scene;
  ParameterValues parameters;  ///< of algorithms or scenes
  ReadingOptions reading;
  std::string case_id;  ///< of the results file that is the source; "": none

  CaseOptions cases;
  std::string filter;  ///< regular expression
  Shard shard;

  RepetitionOptions repetitions;
  RunPolicy policy;
  HostOptions hosts;
  bool allow_timeout = false;  ///< a case that crosses a time limit is no failure of the run

  ResultPaths outputs;
  std::filesystem::path record;      ///< directory for recordings; "": keep none
  std::filesystem::path screenshot;  ///< "": none
  PictureOptions picture;
  std::optional<std::uint32_t> frame;  ///< of the screenshot, or where the inspector opens

  /// As results tell what was run: arguments that ask for the same.
  std::vector<std::string> command_line;
};

}  // namespace broadmark
