// What a duel has found, for people and for programs.
#pragma once

#include <string>

#include "broadmark/duel.h"
#include "broadmark/recording.h"

namespace broadmark {

/// Times, ranking, intervals, and, of two sides, a histogram of the ratios. `margin`: within it
/// sides are the same.
std::string formatDuel(const DuelResult&, const SceneInfo&, double margin);

/// All times and ratios as JSON (schema "broadmark-duel/1").
std::string duelJson(const DuelResult&, Recording&, double margin);

}  // namespace broadmark
