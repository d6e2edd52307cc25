// What a duel has found, for people and for programs.
#pragma once

#include <string>

#include "broadmark/analysis/duel.h"
#include "broadmark/results/results.h"

namespace broadmark {

/// Times, ranking, intervals, and, of two sides, a histogram of the ratios.
std::string formatDuel(const DuelResult&, const SceneInfo&);

/// "1.012…1.034", or that there were too few rounds for one.
std::string intervalText(const Interval&, int digits);

/// The fastest side, in one line. The duel must be ok() and have at least one round.
std::string verdictOf(const DuelResult&);

/// All times and ratios as JSON (schema "broadmark-duel/1").
std::string duelJson(const DuelResult&, const RecordingReference&);

}  // namespace broadmark
