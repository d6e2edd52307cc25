// Every listed algorithm must find the right pairs and events in every frame, on simple and
// degenerate inputs, for every number of bodies, instruction set and team size.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <list>
#include <string>
#include <utility>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

constexpr std::uint32_t kFrames = 4;
constexpr std::size_t kCounts[] = {0, 1, 2, 3, 15, 16, 17, 31, 33, 100, 257, 1000};

class EveryAlgorithm : public testing::TestWithParam<Algorithm> {
 protected:
  /// Runs all configurations over the frames and checks every answer. Skips unsupported ones.
  void check(const std::string& input, const std::vector<std::vector<Aabb>>& frames) {
    const SceneInfo scene = sceneOf(frames);
    std::vector<std::vector<Pair>> right;
    for (const std::vector<Aabb>& boxes : frames) right.push_back(rightPairs(boxes));
    if (GetParam().traits.max_objects < scene.objects) return;
    for (auto& [name, test_run] : test_runs_) {
      SCOPED_TRACE(name + " on " + input + ", n = " + std::to_string(scene.objects));
      try {
        test_run.start(scene, frames[0]);
        for (std::uint32_t i = 1; i < frames.size(); ++i) {
          const PairRuns answer = test_run.step(frames[i]);
          ASSERT_TRUE(isRight(answer, right[i], {i, frames[i]}, test_run.margin()))
              << "in frame " << i;
          ASSERT_EQ(test_run.broadPhase().validate(), "") << "in frame " << i;
        }
      } catch (const UnsupportedError& error) {
        GTEST_SKIP() << error.what();
      } catch (const std::exception& error) {
        FAIL() << error.what();
      }
    }
  }

  void SetUp() override { runOnly(allConfigurations(GetParam())); }

  /// Restricts the test to these configurations.
  void runOnly(const std::vector<Configuration>& selected) {
    test_runs_.clear();
    for (const Configuration& config : selected) {
      test_runs_.emplace_back(describe(GetParam(), config), TestRun(GetParam(), config));
    }
  }

 private:
  std::list<std::pair<std::string, TestRun>> test_runs_;  ///< by name of the configuration
};

TEST_P(EveryAlgorithm, FindsExactlyTheRightPairs) {
  for (const inputs::Input& input : inputs::kAll) {
    for (const std::size_t n : kCounts) {
      if (input.all_overlap && n > 300) continue;  // see ReportsAllPairsOfACrowd
      check(std::string(input.name), framesOf(input, n, kFrames));
      if (HasFatalFailure() || IsSkipped()) return;
    }
  }
}

// More boxes than a library's stack has levels (Box3D: 1,024). Half a million pairs are slow: only
// the widest instruction set with the largest team.
TEST_P(EveryAlgorithm, ReportsAllPairsOfACrowd) {
  runOnly({configurations(GetParam()).back(), eventConfigurations(GetParam()).back()});
  check("a crowd", framesOf({"identical", inputs::identical}, 1100, 3));
}

// Frame 1 is unrelated to the initial pose, and every frame is of another input.
TEST_P(EveryAlgorithm, CopesWithUnrelatedFrames) {
  constexpr std::size_t kCount = 300;
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t i = 0; i < inputs::kAll.size(); ++i) {
    // 7 is coprime to the number of inputs: neighbours in the list are not consecutive frames.
    frames.push_back(inputs::kAll[i * 7 % inputs::kAll.size()].boxes(kCount, i, i));
  }
  check("unrelated frames", frames);
}

// The original's sweep and prune mixed up its bodies after the first frame: the number of pairs was
// right, but the pairs were wrong.
TEST_P(EveryAlgorithm, KeepsBodiesApartOverManyFrames) {
  check("drifting", framesOf({"drifting", inputs::drifting}, 200, 60));
}

// The original's KD tree never reported pairs of bodies that did not move.
TEST_P(EveryAlgorithm, ReportsPairsThatNeverMove) {
  check("still", framesOf({"still", inputs::still}, 600, 5));
}

// The tests above run all configurations that the traits declare.
TEST_P(EveryAlgorithm, IsRunInEveryWayThatItsTraitsName) {
  const AlgorithmTraits& traits = GetParam().traits;
  const std::vector<Configuration> tested = configurations(GetParam());
  const bool several_threads = std::ranges::any_of(tested, [](auto c) { return c.threads > 1; });
  EXPECT_EQ(several_threads, traits.parallel);
  const auto widest = std::ranges::max_element(tested, {}, &Configuration::isa);
  EXPECT_EQ(widest->isa, traits.vectorised ? bestIsa() : Isa::scalar);
  EXPECT_TRUE(traits.parallel || !traits.on_device) << "a device has threads";
  EXPECT_GE(traits.max_objects, kCounts[std::size(kCounts) - 1]) << "tests would be skipped";
}

INSTANTIATE_TEST_SUITE_P(Algorithms, EveryAlgorithm, testing::ValuesIn(pairFinders()),
                         [](const auto& tested) { return testName(tested.param); });

/// Compares the counters of a frame with moving boxes and of a static frame.
void expectLessWork(const Algorithm& algorithm, AnswerKind answer) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 300, 3);
  TestRun test_run(algorithm, {.answer = answer});
  test_run.start(sceneOf(frames), frames[0]);
  test_run.step(frames[1]);
  test_run.step(frames[2]);
  const Counters moving = countersOf(test_run.broadPhase());
  for (int i = 0; i < 3; ++i) test_run.step(frames[2]);
  const Counters still = countersOf(test_run.broadPhase());
  EXPECT_TRUE(std::ranges::any_of(moving, [&](const auto& counter) {
    return counter.second > 0 && still.at(counter.first) == 0;
  })) << "no counter falls to 0";
}

TEST(IncrementalAlgorithms, DoLessWhenNothingMoves) {
  for (const Algorithm& algorithm : pairFinders()) {
    if (!algorithm.traits.incremental) continue;
    SCOPED_TRACE(algorithm.id);
    expectLessWork(algorithm, AnswerKind::pairs);
    if (algorithm.traits.events) expectLessWork(algorithm, AnswerKind::events);
  }
}

/// Lower-case words and numbers, joined by `joint`.
bool isJoinedWords(std::string_view text, char joint) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_word = [&](char c) { return is_lower(c) || (c >= '0' && c <= '9'); };
  if (text.empty() || !is_lower(text.front()) || !is_word(text.back())) return false;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (!is_word(text[i]) && (text[i] != joint || text[i - 1] == joint)) return false;
  }
  return true;
}

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Whether all parts of a list "a, b" are in `allowed`.
bool consistsOf(std::string_view list, std::initializer_list<std::string_view> allowed) {
  for (;;) {
    const std::size_t comma = list.find(", ");
    if (std::ranges::count(allowed, list.substr(0, comma)) == 0) return false;
    if (comma == std::string_view::npos) return true;
    list.remove_prefix(comma + 2);
  }
}

/// A phrase within a sentence: begins with a lower-case letter or a name from the source, and has
/// no full stop.
bool isPhrase(const std::string& text, const std::string& source = {}) {
  const std::string first_word = text.substr(0, text.find_first_of(" ',"));
  if (first_word.empty() || text.ends_with('.')) return false;
  return std::isupper(static_cast<unsigned char>(first_word.front())) == 0 ||
         source.find(first_word) != std::string::npos;
}

/// The margin of an instance before and after setting parameter `name` to its maximum.
std::pair<float, float> marginBeforeAndAfterRaising(BroadPhase& algorithm, std::string_view name) {
  const float before = algorithm.margin();
  algorithm.visitParameters([&](const Parameter& parameter) {
    auto* const* value = std::get_if<double*>(&parameter.value);
    if (parameter.name == name && value != nullptr) **value = parameter.max;
  });
  return {before, algorithm.margin()};
}

/// The table of algorithms, self-checks included.
class EveryListedAlgorithm : public testing::TestWithParam<Algorithm> {};

TEST_P(EveryListedAlgorithm, HasAnIdOfItsOwn) {
  EXPECT_TRUE(isJoinedWords(GetParam().id, '-'));
  EXPECT_EQ(std::ranges::count(builtinAlgorithms(), GetParam().id, &Algorithm::id), 1);
  EXPECT_NE(GetParam().family, "");
}

TEST_P(EveryListedAlgorithm, IsDescribed) {
  const AlgorithmDescription& description = GetParam().description;
  EXPECT_TRUE(isPhrase(GetParam().summary, description.source)) << GetParam().summary;
  if (GetParam().traits.finds_pairs) {
    EXPECT_TRUE(consistsOf(description.principle, {"brute force", "sorting", "grid", "tree"}))
        << description.principle;
  } else {
    EXPECT_EQ(description.principle, "none");
  }
  for (const std::string& complexity : {description.time, description.space}) {
    EXPECT_TRUE(complexity.starts_with("O(")) << complexity;
    EXPECT_NE(complexity.find(')'), std::string::npos) << complexity;
  }
  // The list derives these from the traits.
  for (const char* derived : {"simd", "thread", "opencl", "none"}) {
    EXPECT_EQ(lowered(description.optimisations).find(derived), std::string::npos);
  }
  EXPECT_NE(description.source, "");
  EXPECT_FALSE(description.source.ends_with('.'));
}

TEST_P(EveryListedAlgorithm, ExplainsItsParameters) {
  const std::unique_ptr<BroadPhase> algorithm = GetParam().create();
  const ParameterValues defaults = parameterValues(*algorithm);
  algorithm->visitParameters([&](const Parameter& parameter) {
    EXPECT_TRUE(isJoinedWords(parameter.name, '_')) << parameter.name;
    EXPECT_TRUE(isPhrase(std::string(parameter.doc))) << parameter.name;
    EXPECT_EQ(defaults.count(std::string(parameter.name)), 1U) << parameter.name;
  });
  // Names are unique, and every default is a valid value.
  EXPECT_EQ(parameterNames(*algorithm).size(), defaults.size());
  EXPECT_NO_THROW(setParameters(*algorithm, defaults));
}

// margin() of a conservative algorithm depends on its parameter `margin`.
TEST_P(EveryListedAlgorithm, HasAMarginOnlyFromItsParameter) {
  const std::unique_ptr<BroadPhase> algorithm = GetParam().create();
  if (algorithm->margin() == 0) return;
  ASSERT_EQ(std::ranges::count(parameterNames(*algorithm), "margin"), 1);
  const auto [before, after] = marginBeforeAndAfterRaising(*algorithm, "margin");
  EXPECT_GT(before, 0);
  EXPECT_GT(after, before);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, EveryListedAlgorithm, testing::ValuesIn(builtinAlgorithms()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
