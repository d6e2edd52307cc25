// The timed phases of a frame, and their durations.
//
// Example:
//
//   FrameTimes times;
//   times[Phase::search_overlaps] = 1'500'000;
//   for (const auto& [phase, name] : kPhases.entries) {
//     const double milliseconds = static_cast<double>(times[phase]) * 1e-6;  // of phase `name`
//   }
#pragma once

#include <cstdint>

#include "broadmark/names.h"

namespace broadmark {

/// The timed phases of a frame. A phase names the call, not the work: only the total is comparable
/// across algorithm families. Upload and download are the times within the first four
/// spent on copies to and from a compute device; without a device they are 0. The total is the sum
/// of the first four.
enum class Phase {
  update_objects,
  clean_cache,
  update_structures,
  search_overlaps,
  upload,
  download,
  total
};
/// All phases, in order.
inline constexpr NameTable kPhases{{NamedValue{Phase::update_objects, "update_objects"},
                                    {Phase::clean_cache, "clean_cache"},
                                    {Phase::update_structures, "update_structures"},
                                    {Phase::search_overlaps, "search_overlaps"},
                                    {Phase::upload, "upload"},
                                    {Phase::download, "download"},
                                    {Phase::total, "total"}}};

/// Durations of one frame's phases in nanoseconds of a steady clock; 0 unless measured.
using FrameTimes = ValueOfEach<Phase, std::int64_t, kPhases.entries.size()>;

}  // namespace broadmark
