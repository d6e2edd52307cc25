// An opened results file: the cases listed, their order, and the cases marked for plotting.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/render/frame_values.h"
#include "broadmark/results/case_columns.h"
#include "broadmark/results/results.h"
#include "compare/comparison.h"

namespace broadmark {

/// Frame time of an algorithm, with fixed parameters and threads, over the number of bodies of a
/// scene.
struct ScalingCurve {
  struct Point {
    std::uint32_t objects = 0;
    double seconds = 0;  ///< mean per frame, over all repetitions; above 0
    std::size_t row = 0;
  };
  std::string algorithm;      ///< id, or the case name if ids are ambiguous
  std::string scene;          ///< "Brownian/Cubes/F9"; "" if all curves share the scene
  std::string case_name;      ///< from caseNameOf()
  std::vector<Point> points;  ///< of at least two sizes, ascending
  double exponent = 0;        ///< of seconds = factor · objects^exponent, fitted to the logarithms
};

class OpenedResults {
 public:
  struct Row {
    CaseResult result;
    std::string algorithm;           ///< from variantOf()
    std::string recording;           ///< from recordingId()
    std::optional<Summary> summary;  ///< nothing without measured times
    std::size_t mismatches = 0;      ///< number of frames
    std::string obstacle;            ///< why the case cannot be opened; "": none known
    bool marked = false;             ///< set by mark()
  };
  /// The frame times of a marked case.
  struct Curve {
    std::size_t row = 0;
    FrameValues seconds;     ///< of a phase: median of the repetitions
    FrameValues mismatches;  ///< 1 in frames with a wrong answer, unknown in others
  };

  /// These results, B, against others, A.
  struct Compared {
    NamedResults before;
    NamedResults after;
    Comparison comparison;
    std::vector<std::vector<std::string>> table;  ///< from comparisonTable()
  };

  /// Marks a few cases of one recording initially. `algorithms`: the available ones.
  OpenedResults(std::filesystem::path file, Results results,
                const std::vector<Algorithm>& algorithms);

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Whether the run was completed.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] std::vector<Row>& rows() { return rows_; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Number of cases with a wrong answer.
  [[nodiscard]] std::size_t wrongCount() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(rows_, [](const Row& row) { return row.mismatches > 0; }));
  }
  void mark(std::size_t row, bool on) {
    rows_[row].marked = on;
    curves_of_.reset();
  }
  /// The curves of the marked rows with times, in the order of the file. Computed on demand.
  const std::vector<Curve>& curves(Phase phase);
  /// The curves of the listed rows, in the order of the file; valid until the list changes. Only
  /// complete, correct cases with a measured time of the phase have points.
  const std::vector<ScalingCurve>& scaling(Phase phase);

  /// Compares the file with a baseline. Reads both. Throws InputError.
  void compareWith(const std::filesystem::path& baseline);
  void endComparison() { compared_.reset(); }
  /// Null: nothing is compared.
  [[nodiscard]] const Compared* compared() const { return compared_.get(); }

  /// Indices of the listed rows, in display order.
  [[nodiscard]] const std::vector<std::size_t>& listed() const { return listed_; }
  /// Sorts by the column with this key; "": as in the file. Cases without a value always come last.
  void sort(std::string_view column, bool descending);
  /// Lists only cases with the text in their id and, if `only_wrong`, with a wrong answer.
  void filter(const std::string& text, bool only_wrong);

 private:
  void updateList();
  [[nodiscard]] std::vector<ScalingCurve> scalingCurves(Phase phase) const;

  std::filesystem::path file_;
  bool complete_ = false;
  std::vector<Row> rows_;
  std::vector<std::size_t> listed_;
  const CaseColumn* sorted_by_ = nullptr;  ///< null: file order
  bool descending_ = false;
  std::string text_;
  bool only_wrong_ = false;
  std::vector<Curve> curves_;
  std::optional<Phase> curves_of_;  ///< nothing: `curves_` are outdated
  std::vector<ScalingCurve> scaling_;
  std::optional<Phase> scaling_of_;  ///< nothing: `scaling_` is outdated
  std::unique_ptr<const Compared> compared_;
};

}  // namespace broadmark
