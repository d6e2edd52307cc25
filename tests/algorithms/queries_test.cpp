// Every algorithm that answers queries, against brute force.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/runs.h"
#include "broadmark/harness/case_run.h"
#include "torture/changing.h"

namespace broadmark::tests {
namespace {

std::vector<Algorithm> answeringQueries() {
  std::vector<Algorithm> all = builtinAlgorithms();
  std::erase_if(all, [](const Algorithm& algorithm) { return algorithm.traits.queries.empty(); });
  return all;
}

class Queries : public testing::TestWithParam<Algorithm> {
 protected:
  /// Expects right answers to 60 queries of each kind in every frame.
  void check(const std::string& name, const std::vector<std::vector<Aabb>>& frames) {
    SceneInfo scene = sceneOf(frames);
    scene.all_present = std::ranges::none_of(
        frames, [](const auto& boxes) { return std::ranges::any_of(boxes, isEmpty); });
    for (const AnswerKind kind : GetParam().traits.queries) {
      for (const int threads : {1, 3}) {
        if (threads > 1 && !GetParam().traits.parallel) continue;
        CaseRun run(makeCase(GetParam(), bestIsa(), threads, "", {}, Answer(kind, 60)),
                    RunPolicy::unlimited(CheckMode::full));
        SCOPED_TRACE(name + " " + caseName(run.description()));
        Oracle oracle;
        if (!run.start(scene, {0, frames[0]}) && run.status() == Status::unsupported) continue;
        for (std::uint32_t i = 1; i < frames.size(); ++i) {
          const Frame frame{i, frames[i]};
          if (!run.step(frame) && run.status() == Status::unsupported) break;
          ASSERT_TRUE(run.running()) << run.reason();
          const auto difference = run.check(frame, oracle);
          ASSERT_TRUE(difference.has_value()) << run.reason();
          ASSERT_FALSE(difference->isMismatch()) << run.reason();
          ASSERT_EQ(run.validate(), "");
        }
      }
    }
  }
};

TEST_P(Queries, FindTheRightHits) {
  for (const inputs::Input& input : inputs::kAll) {
    for (const std::size_t n : {0, 1, 2, 5, 33, 400}) {
      if (input.all_overlap && n > 100) continue;
      check(std::string(input.name), framesOf(input, n, 4));
      if (HasFatalFailure()) return;
    }
  }
}

TEST_P(Queries, FindTheRightHitsAmongBodiesThatComeAndGo) {
  for (const inputs::NamedPresence& presence : inputs::kPresences) {
    auto frames = framesOf({"drifting", inputs::drifting}, 200, 12);
    for (std::uint32_t frame = 0; frame < frames.size(); ++frame) {
      for (std::uint32_t body = 0; body < frames[frame].size(); ++body) {
        if (!presence.present(body, frame)) frames[frame][body] = kEmptyBox;
      }
    }
    check(std::string(presence.name), frames);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, Queries, testing::ValuesIn(answeringQueries()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
