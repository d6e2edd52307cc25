// What a run leaves behind: cases with their times and verdicts, and files to keep them in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/environment.h"
#include "broadmark/execution.h"
#include "broadmark/frame.h"
#include "broadmark/frame_times.h"
#include "broadmark/oracle.h"
#include "broadmark/parameters.h"
#include "broadmark/statistics.h"
#include "broadmark/status.h"

namespace broadmark {

/// One pass of a fresh instance over the whole recording.
struct Repetition {
  std::int64_t initialize_ns = 0;
  std::vector<FrameTimes> frames;
};

/// The recording a case ran on.
struct RecordingReference {
  SceneInfo scene;
  std::optional<std::uint64_t> seed;  ///< nothing for a recording from elsewhere
  std::string hash;
  std::string path;                  ///< "" when it was simulated for this run
  ParameterValues scene_parameters;  ///< all of them, when it was simulated
  ParameterValues swept = {};        ///< of those, what tells it from other recordings of its run
};

struct CaseResult {
  std::string id;
  RecordingReference recording;
  std::string algorithm;
  std::string family;
  Isa isa = Isa::scalar;
  bool vectorised = false;  ///< whether the algorithm is vectorised, so that `isa` means something
  int threads = 1;
  std::string device;          ///< the compute device asked for, as Execution::device()
  std::string plugin;          ///< the file that the algorithm was loaded from; "": built in
  ParameterValues parameters;  ///< all, defaults included

  Status status = Status::ok;
  std::string reason;  ///< for every status but ok

  double pairs_mean = 0;
  std::uint64_t pairs_max = 0;
  bool checked = false;  ///< when false, the counts of wrong pairs mean nothing
  // Pairs over all frames and repetitions, as in FrameDifference.
  std::uint64_t missed_count = 0;
  std::uint64_t false_count = 0;
  std::uint64_t allowed_extra_count = 0;
  std::uint64_t invalid_count = 0;
  std::vector<FrameDifference> differences;  ///< of the frames that are mismatches
  std::optional<std::uint64_t> peak_bytes;   ///< as CaseHost::peakBytes()
  /// The algorithm's own counts of work, mean per frame.
  std::map<std::string, double> counters;
  /// What it counted once, in the first initialisation.
  std::map<std::string, std::uint64_t> setup;

  std::vector<Repetition> repetitions;

  /// The total times in seconds, per repetition.
  [[nodiscard]] Summary summary() const;
};

/// A whole run.
struct Results {
  Environment environment;
  std::vector<std::string> options;  ///< the command line
  std::vector<CaseResult> cases;
};

/// One way to write results. The list of all of them is resultWriters().
struct ResultWriter {
  std::string_view name;  ///< of the command line option, without dashes: "json"
  std::string_view doc;
  std::string (*format)(const Results&);
};
std::vector<ResultWriter> resultWriters();

/// The kind of JSON file, its "schema", that results are.
inline constexpr std::string_view kResultsSchema = "broadmark-results/1";

/// Parses a results file. `name` stands for it in messages.
/// Throws InputError.
Results parseResults(std::string_view json, std::string_view name);

}  // namespace broadmark
