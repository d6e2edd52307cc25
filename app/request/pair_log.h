// Pairs that a program logged while it ran, frame by frame: a table of text, or JSON Lines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

/// The rows of a log by frame, in which a pair may come in either order.
///
/// A table (commas, semicolons or tabs) has a heading with the columns frame, a, b and, for events,
/// event ("begin" or "end"), in any order. A line of JSON Lines is {"frame": 1, "pairs": [[0, 1]]},
/// or {"frame": 1, "began": [[0, 1]], "ended": []}. Frame 0 is the initial pose.
class PairLog {
 public:
  /// Reads a whole file. Throws InputError, naming the line.
  explicit PairLog(const std::filesystem::path& path);

  [[nodiscard]] bool hasFrame(std::uint32_t frame) const { return rows_.contains(frame); }
  /// The largest frame; 0 if there is none.
  [[nodiscard]] std::uint32_t lastFrame() const {
    return rows_.empty() ? 0 : rows_.rbegin()->first;
  }
  /// The pairs of a frame, a <= b, in which a pair occurs as often as it was reported; of events,
  /// those that have begun and not ended, for which each frame must be asked for, in ascending
  /// order. Valid until the next call.
  const std::vector<Pair>& pairsOf(std::uint32_t frame);
  /// The pairs that ended in that frame without having begun.
  [[nodiscard]] const std::vector<Pair>& impossible() const { return impossible_; }

 private:
  struct Row {
    Pair pair;
    bool ends = false;
  };

  std::map<std::uint32_t, std::vector<Row>> rows_;
  bool has_events_ = false;
  std::map<Pair, int> present_;  ///< events: how often each pair has begun and not ended
  std::vector<Pair> pairs_;
  std::vector<Pair> impossible_;
};

}  // namespace broadmark
