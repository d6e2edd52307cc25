// The table of frames: CSV with one row per case, repetition and frame.
#pragma once

#include <cstdint>
#include <string>

#include "broadmark/results/results.h"

namespace broadmark {

struct FrameRow {
  int repetition = 1;
  std::uint32_t frame = 0;
  FrameTimes times;
  FrameCounts counts;
  bool changes_known = false;  ///< FrameCount::changed_bodies was counted
  bool checked = false;        ///< the counts of wrong pairs are meaningful
  bool disturbed = false;      ///< the frame was drawn during timing
};

class FrameTable {
 public:
  FrameTable();

  /// Sets the case of subsequent rows.
  void begin(const CaseResult& result);
  void add(const FrameRow& row);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string case_;  ///< prefix of each row
  std::string text_;
};

}  // namespace broadmark
