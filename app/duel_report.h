// What a duel has found, for people and for programs.
#pragma once

#include <string>

#include "broadmark/duel.h"
#include "broadmark/results.h"

namespace broadmark {

/// Times, ranking, intervals, and, of two sides, a histogram of the ratios.
std::string formatDuel(const DuelResult&, const SceneInfo&);

/// All times and ratios as JSON (schema "broadmark-duel/1").
std::string duelJson(const DuelResult&, const RecordingReference&);

}  // namespace broadmark
