// Reports of a duel: human-readable text, and JSON.
#pragma once

#include <string>

#include "broadmark/analysis/duel.h"
#include "broadmark/results/results.h"

namespace broadmark {

/// Formats times, ranking, intervals and, for two sides, a histogram of the ratios.
std::string formatDuel(const DuelResult&, const SceneInfo&);

/// "120 rounds, ratio 1.021 (1.012…1.034)"; without a ratio unless there are two sides.
std::string progressText(const DuelResult&);

/// States the fastest side in one line. The duel must be ok() and have at least one round.
std::string verdictOf(const DuelResult&);

/// Formats all times and ratios as JSON (schema "broadmark-duel/1").
std::string duelJson(const DuelResult&, const RecordingReference&);

}  // namespace broadmark
