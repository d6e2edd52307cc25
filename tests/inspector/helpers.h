// What tests of the session share.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "broadmark/algorithms.h"
#include "inspector/session.h"
#include "support/faulty_algorithm.h"

namespace broadmark::tests {

/// The built-in algorithms, and those that are wrong once in a while.
inline std::vector<Algorithm> algorithmsAndFaultyOnes() {
  std::vector<Algorithm> all = builtinAlgorithms();
  for (const Algorithm& algorithm : faulty::variants()) all.push_back(algorithm);
  return all;
}

/// Commits, waits, and takes note, several times, as pictures do.
inline RunProgress settled(Session& session) {
  RunProgress seen;
  for (int picture = 0; picture < 4; ++picture) {
    session.commit();
    EXPECT_TRUE(session.runs.settle(std::chrono::seconds(60)));
    session.runs.look([&](const RunProgress& progress) {
      session.advance(progress, 0);
      seen = progress;
    });
  }
  return seen;
}

}  // namespace broadmark::tests
