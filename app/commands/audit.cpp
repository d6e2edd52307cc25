// broadmark audit: checks the pairs that a program logged, and cuts out what shows its faults.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/recordings/sub_recording.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "request/pair_log.h"
#include "request/plugins.h"
#include "run/recordings.h"
#include "run/wrong_pairs.h"
#include "sources/make_source.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark::commands::audit {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string source;
  fs::path log;
  ReadingOptions reading;
  double margin = 0;
  fs::path output;
  bool quiet = false;
};

/// A wrong pair of two bodies.
struct WrongPair {
  std::uint32_t frame = 0;
  Pair pair;
};

/// The faults of one kind, over all frames.
struct Faults {
  const char* name;
  int rows = 0;  ///< with its pair, in the log of the recording that shows it
  std::uint64_t count = 0;
  std::uint64_t frames = 0;
  std::optional<WrongPair> first = {};

  void add(std::uint32_t frame, std::uint64_t more, const std::vector<Pair>& pairs) {
    if (more == 0) return;
    count += more;
    ++frames;
    if (!first && !pairs.empty()) first = {frame, pairs.front()};
  }
};

class Audit {
 public:
  Audit(const Options& options, IndexedFrames& recording)
      : options_(options), recording_(recording), log_(options.log) {
    const std::uint32_t last = recording.scene().frames;
    if (log_.lastFrame() > last) {
      throw InputError(fmt::format("{}: has pairs of frame {}, but {} has frames 0 to {}",
                                   options.log.string(), log_.lastFrame(), options.source, last));
    }
  }

  int run() {
    Progress progress("auditing " + options_.log.string(), recording_.scene().frames,
                      options_.quiet);
    for (std::optional<Frame> frame = recording_.rewind(); frame; frame = recording_.next()) {
      if (frame->index > 0 || log_.hasFrame(0)) check(*frame);
      if (!progress.advance(frame->index)) throw Interrupted();
    }
    return report(progress);
  }

 private:
  void check(const Frame& frame) {
    const SceneInfo& scene = recording_.scene();
    const CollisionFilter& filter = frame.filterIn(scene);
    const std::vector<Pair>& logged = log_.pairsOf(frame.index);
    const PairRun run(logged);
    FrameDifference difference =
        findDifference({&run, 1}, oracle_.pairs(frame.boxes, filter, scene.periodic), frame,
                       static_cast<float>(options_.margin), filter, scene.periodic);
    std::vector<Pair> duplicates;
    std::vector<Pair> impossible = log_.impossible();
    for (const Pair pair : difference.invalid_pairs) {
      const bool exists = pair.a < pair.b && pair.b < frame.boxes.size();
      (exists ? duplicates : impossible).push_back(pair);
    }
    const std::uint64_t others = difference.invalid_count - difference.duplicate_count;
    ++checked_;
    pairs_ += logged.size();
    wrong_ += difference.isMismatch() || !impossible.empty() ? 1 : 0;
    allowed_ += difference.allowed_extra_count;
    missed_.add(frame.index, difference.missed_count, difference.missed_pairs);
    false_.add(frame.index, difference.false_count, difference.false_pairs);
    duplicate_.add(frame.index, difference.duplicate_count, duplicates);
    impossible_.add(frame.index, others + log_.impossible().size(), impossible);
  }

  int report(Progress& progress) {
    progress.print(fmt::format("{}: {} in {}, of which {} wrong", options_.log.string(),
                               counted(pairs_, "pair"), counted(checked_, "frame"),
                               wrong_ == 0   ? "none is"
                               : wrong_ == 1 ? "1 is"
                                             : fmt::format("{} are", wrong_)));
    if (allowed_ > 0) {
      progress.print(fmt::format("  {} only within the margin", counted(allowed_, "pair")));
    }
    if (wrong_ == 0) return exit_status::success;
    std::vector<std::vector<std::string>> rows = {
        {"", "fault", "pairs", "frames", "first", "pair"}};
    for (const Faults* faults : {&missed_, &false_, &duplicate_, &impossible_}) {
      if (faults->count == 0) continue;
      const auto& first = faults->first;
      rows.push_back({"", faults->name, fmt::format("{}", faults->count),
                      fmt::format("{}", faults->frames),
                      first ? fmt::format("{}", first->frame) : "",
                      first ? fmt::format("{}-{}", first->pair.a, first->pair.b) : ""});
    }
    progress.print(alignColumns(rows, {false, false, true, true, true, false}));
    for (const Faults* faults : {&missed_, &false_, &duplicate_}) {
      if (faults->first) show(*faults, progress);
    }
    progress.print(fmt::format("To see it: broadmark {} --plugin {}", shellQuoted(options_.source),
                               shellQuoted(kPairLogPrefix + options_.log.string())));
    return exit_status::wrong_answer;
  }

  /// Prints the boxes of a fault's first pair, and writes a recording of these two bodies.
  void show(const Faults& faults, Progress& progress) {
    const auto& [frame, pair] = *faults.first;
    const Selection part = selectionOf(
        recording_.scene(), {pair.a, pair.b},
        frame == 0 ? std::vector<std::uint32_t>{0} : std::vector<std::uint32_t>{frame - 1, frame});
    progress.print(fmt::format("{} in frame {}: bodies {} and {}, renumbered 0 and 1", faults.name,
                               frame, pair.a, pair.b));
    progress.print(smallPartText(recording_, part));
    if (options_.output.empty()) return;
    makeDirectory(options_.output);
    const std::string extension(recordingExtension(recording_.scene()));
    const fs::path file = options_.output / (std::string(faults.name) + extension);
    writeSelection(file, recording_, part);
    const std::size_t index = frame == 0 ? 0 : 1;
    std::string rows = "frame,a,b\n";
    for (int i = 0; i < faults.rows; ++i) rows += fmt::format("{},0,1\n", index);
    const fs::path log = fs::path(file).replace_extension(".csv");
    writeTextFile(log, rows);
    progress.print(fmt::format("written: {}, {}", file.string(), log.string()));
  }

  const Options& options_;
  IndexedFrames& recording_;
  PairLog log_;
  Oracle oracle_;
  std::uint64_t checked_ = 0;
  std::uint64_t pairs_ = 0;
  std::uint64_t wrong_ = 0;  ///< frames
  std::uint64_t allowed_ = 0;
  Faults missed_{.name = "missed"};
  Faults false_{.name = "false", .rows = 1};
  Faults duplicate_{.name = "duplicate", .rows = 2};
  Faults impossible_{.name = "impossible"};
};

int run(const Options& options) {
  if (!options.output.empty() && fs::exists(options.output)) {
    throw InputError(
        fmt::format("--output: {} exists: name a new folder", options.output.string()));
  }
  const InterruptGuard guard;
  Source source = fileSource({options.source}, options.reading);
  const auto recording = openForCommand(source, options.quiet);
  return Audit(options, *recording).run();
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option(
         "source", options->source,
         fmt::format("{}; or importable files: {}", recordingKindsText(), importKindsText()))
      ->type_name("SOURCE")
      ->required();
  app.add_option(
         "pairs", options->log,
         "the logged pairs: a table with the columns frame, a, b and, for events, event (begin "
         "or end); or JSON Lines ({\"frame\": 1, \"pairs\": [[0, 1]]}). Frame 0 is the initial "
         "pose, and is checked if the log has it")
      ->type_name("PAIRS")
      ->required();
  addPositive(app, "--margin", "D", options->margin,
              "allow pairs of boxes that overlap once each is enlarged by this much");
  addPath(app, "--output", "FOLDER", options->output,
          "new folder, for the smallest recording of each kind of fault, with its log");
  addReadingOptions(app, options->reading);
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "audit",
          .summary = "Checks the pairs that an engine logged for missed, false and duplicate ones.",
          .examples = {"audit session.aabbs pairs.csv",
                       "audit session.broadmark pairs.jsonl --margin 0.04 --output faults"},
          .add = add};
}

}  // namespace broadmark::commands::audit
