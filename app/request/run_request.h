// A run request: a complete specification of a run, as a plain value.
//
// Command lines, JSON files (docs/run-requests.md), the inspector, the Python package and campaigns
// all create run requests. Code that runs a request does not depend on the command line.
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
#include "request/count.h"
#include "request/hosts.h"
#include "request/reading_options.h"
#include "request/repetitions.h"
#include "support/output.h"

namespace broadmark {

/// Options of simulations: for sources that are scenes, and for baking.
struct SceneOptions {
  std::vector<std::uint32_t> objects;  ///< numbers of bodies, ascending; empty: the scene's default
  std::vector<std::string> object_types;  ///< empty: the scene's default
  /// Scene parameters with their own options (--frames, --seed, …), by parameter name. A text may
  /// hold several values (sweep.h).
  ParameterValues parameters;
  /// Kinds of recordings to write; cases run on the first. Empty: recordingExtension() of the
  /// scene.
  std::vector<std::string> recorders;
};

/// How pictures are drawn off-screen.
struct PictureOptions {
  int width = 1280;
  int height = 720;
  GlSource gl = GlSource::automatic;
};

/// Part of a run divided among machines: every `count`-th case, starting with the `index`-th.
struct Shard {
  int index = 0;
  int count = 1;
};

struct RunRequest {
  std::vector<std::string> sources;
  std::vector<std::string> plugins;  ///< libraries with additional algorithms or engines
  SceneOptions scene;
  ParameterValues parameters;  ///< of algorithms or scenes
  ReadingOptions reading;
  std::string case_id;  ///< case to run of the results file given as source; "": none

  CaseOptions cases;
  std::string filter;  ///< regular expression
  Shard shard;

  RepetitionOptions repetitions;
  RunPolicy policy;
  CountOptions count;
  HostOptions hosts;
  bool allow_timeout = false;  ///< exceeded time limits do not fail the run

  OutputPaths outputs;
  bool print_pairs = false;          ///< print the wrong pairs of each mismatch
  std::filesystem::path record;      ///< directory for simulated recordings; "": none
  std::filesystem::path screenshot;  ///< "": none
  PictureOptions picture;
  std::optional<std::uint32_t> frame;  ///< of the screenshot, or shown first in the inspector

  /// Equivalent arguments, as stated in results.
  std::vector<std::string> command_line;
};

}  // namespace broadmark
