// A results file that has been opened: which of its cases are listed, in which order, and which are
// marked to be plotted.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/render/frame_values.h"
#include "broadmark/results/case_columns.h"
#include "broadmark/results/results.h"

namespace broadmark {

/// How the time of a frame of one algorithm, with the same parameters and threads, grows with the
/// number of bodies of one scene.
struct ScalingCurve {
  struct Point {
    std::uint32_t objects = 0;
    double seconds = 0;  ///< mean per frame, over all repetitions; above 0
    std::size_t row = 0;
  };
  std::string algorithm;      ///< as short as tells it from all others
  std::string scene;          ///< "Brownian/Cubes/F9"; "" where all curves are of the same
  std::string case_name;      ///< as caseNameOf()
  std::vector<Point> points;  ///< of at least two sizes, the smallest first
  double exponent = 0;  ///< of seconds = factor · objects^exponent, by least squares of logarithms
};

class OpenedResults {
 public:
  struct Row {
    CaseResult result;
    std::string algorithm;           ///< as variantOf()
    std::string recording;           ///< as recordingId()
    std::optional<Summary> summary;  ///< nothing without any time
    std::size_t mismatches = 0;      ///< frames
    std::string obstacle;            ///< why it cannot be opened; "": nothing is known
    bool marked = false;             ///< set by mark()
  };
  /// A marked case over its frames.
  struct Curve {
    std::size_t row = 0;
    FrameValues seconds;     ///< of a phase: the median of the repetitions
    FrameValues mismatches;  ///< 1 in frames that are one, unknown in others
  };

  /// Marks a few cases of one recording to begin with. `algorithms`: those that can be run.
  OpenedResults(std::filesystem::path file, Results results,
                const std::vector<Algorithm>& algorithms);

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Whether the run came to its end.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] std::vector<Row>& rows() { return rows_; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// How many cases gave a wrong answer.
  [[nodiscard]] std::size_t wrong() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(rows_, [](const Row& row) { return row.mismatches > 0; }));
  }
  void mark(std::size_t row, bool on) {
    rows_[row].marked = on;
    curves_of_.reset();
  }
  /// Of the marked rows that have times, in the order of the file. Made when first asked for.
  const std::vector<Curve>& curves(Phase phase);
  /// Curves of the listed rows, in the order of the file; valid until the list changes. Only
  /// complete cases with right answers have points, and only where the phase took time.
  const std::vector<ScalingCurve>& scaling(Phase phase);

  /// The numbers of the rows to be shown, in order.
  [[nodiscard]] const std::vector<std::size_t>& listed() const { return listed_; }
  /// By the column with this key; "": as in the file. Cases without the value come last, either
  /// way.
  void sort(std::string_view column, bool descending);
  /// Lists only cases with the text in their id and, if `only_wrong`, with a wrong answer.
  void filter(const std::string& text, bool only_wrong);

 private:
  void list();
  [[nodiscard]] std::vector<ScalingCurve> scalingCurves(Phase phase) const;

  std::filesystem::path file_;
  bool complete_ = false;
  std::vector<Row> rows_;
  std::vector<std::size_t> listed_;
  const CaseColumn* sorted_by_ = nullptr;  ///< null: as in the file
  bool descending_ = false;
  std::string text_;
  bool only_wrong_ = false;
  std::vector<Curve> curves_;
  std::optional<Phase> curves_of_;  ///< nothing: `curves_` are outdated
  std::vector<ScalingCurve> scaling_;
  std::optional<Phase> scaling_of_;  ///< nothing: `scaling_` is outdated
};

}  // namespace broadmark
