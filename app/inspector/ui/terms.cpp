#include "inspector/ui/terms.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace broadmark {
namespace {

constexpr std::pair<std::string_view, const char*> kTerms[] = {
    {"mark", "Whether its times are plotted"},
    {"algorithm", "Algorithm, with the parameters that differ from their defaults"},
    {"recording", "Scene, bodies and frames"},
    {"status", "ok, or why it ended early"},
    {"ISA", "Instruction set of its SIMD code"},
    {"threads", "Threads that it uses"},
    // Phases.
    {"total", "Time of a frame: the sum of its four phases"},
    {"update_objects", "Phase: copies the new boxes"},
    {"clean_cache", "Phase: drops the previous answer"},
    {"update_structures", "Phase: brings the structure up to date"},
    {"search_overlaps", "Phase: finds the pairs"},
    {"upload", "Part of the phases: copies to the compute device"},
    {"download", "Part of the phases: copies from the compute device"},
    // Statistics.
    {"mean", "Mean time of a frame, without disturbed frames"},
    {"median", "Half of the frames take less"},
    {"min", "Shortest time of a frame"},
    {"max", "Longest time of a frame"},
    {"sum", "All frames together"},
    {"frames", "Frames that were run undisturbed"},
    {"p95", "95 % of the frames take less"},
    {"5 %", "5 % of the frames take less"},
    {"95 %", "95 % of the frames take less"},
    {"99 %", "99 % of the frames take less"},
    {"rank", "Algorithms with the same rank do not differ significantly"},
    {"ratio", "Time relative to the first algorithm, median of the rounds"},
    {"95 % interval", "95 % confidence interval of the ratio"},
    // Two files.
    {"case", "Recording and algorithm; a click opens it"},
    {"A", "Time of a frame in the baseline"},
    {"B", "Time of a frame in the opened file"},
    {"B/A", "Above 1: slower than the baseline; corrected for the drift of all cases"},
    {"verdict", "Judged by the interval of the ratio, as in broadmark compare"},
    // Answers.
    {"pairs", "Reported pairs"},
    {"missed", "Pairs that overlap and are not reported"},
    {"false", "Reported pairs that do not overlap, beyond the margin"},
    {"invalid", "Reported twice, with a >= b, or with a body that does not exist"},
    {"allowed_extra", "Reported pairs that do not overlap, within the margin: no mismatch"},
    {"mismatches", "Frames with a missed, false or invalid pair"},
};

}  // namespace

const char* termDoc(std::string_view term) {
  const auto* const found =
      std::ranges::find(kTerms, term, &std::pair<std::string_view, const char*>::first);
  return found == std::end(kTerms) ? "" : found->second;
}

}  // namespace broadmark
