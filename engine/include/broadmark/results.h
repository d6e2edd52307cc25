// What a run leaves behind: cases with their times and verdicts, and files to keep them in.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/environment.h"
#include "broadmark/execution.h"
#include "broadmark/oracle.h"
#include "broadmark/parameters.h"
#include "broadmark/statistics.h"

namespace broadmark {

/// The timed phases of a frame. A phase names the call, not the work: only the total compares
/// across algorithm families. Upload and download are the parts of the four calls before them that
/// went into copying to and from a compute device; without a device they are 0.
enum class Phase {
  update_objects,
  clean_cache,
  update_structures,
  search_overlaps,
  upload,
  download,
  total
};
inline constexpr std::array kAllPhases = {Phase::update_objects,
                                          Phase::clean_cache,
                                          Phase::update_structures,
                                          Phase::search_overlaps,
                                          Phase::upload,
                                          Phase::download,
                                          Phase::total};
std::string_view phaseName(Phase);

/// Durations of one frame's phases in nanoseconds of a steady clock.
struct FrameTimes {
  std::array<std::int64_t, kAllPhases.size()> ns{};

  std::int64_t& operator[](Phase phase) { return ns[static_cast<std::size_t>(phase)]; }
  std::int64_t operator[](Phase phase) const { return ns[static_cast<std::size_t>(phase)]; }
};

/// One pass of a fresh instance over the whole recording.
struct Repetition {
  std::int64_t initialize_ns = 0;
  std::vector<FrameTimes> frames;
};

enum class Status { ok, mismatch, timeout, unsupported, error };
std::string_view statusName(Status);

/// The recording a case ran on.
struct RecordingReference {
  SceneInfo scene;
  std::optional<std::uint64_t> seed;  ///< nothing for a recording from elsewhere
  std::string hash;
  std::string path;                  ///< "" when it was simulated for this run
  ParameterValues scene_parameters;  ///< all of them, when it was simulated
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
  bool checked = false;      ///< when false, missed and extra mean nothing
  std::uint64_t missed = 0;  ///< over all frames and repetitions
  std::uint64_t extra = 0;
  std::uint64_t invalid = 0;
  std::vector<FrameDifference> differences;
  std::optional<std::uint64_t> peak_bytes;
  /// The algorithm's own counts of work, mean per frame.
  std::map<std::string, double> counters;

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
