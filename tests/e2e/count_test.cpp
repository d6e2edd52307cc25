// Instruction counts: repeatable, without times, and compared by compare and duel.

#include <cstdlib>

#include "broadmark/harness/processor_counters.h"
#include "e2e/end_to_end.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

bool hasValgrind() { return std::system("valgrind --version > /dev/null 2>&1") == 0; }

class CountedInstructions : public EndToEnd {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "valgrind and sanitizers exclude each other";
    if (!ProcessorCounters::countInstructions() && !hasValgrind()) {
      GTEST_SKIP() << "neither the processor's counters nor valgrind are available";
    }
  }

  /// Counts cases on a small scene.
  ProgramResult count(const std::string& algorithms, const std::string& json,
                      const ProgramEnvironment& around = {},
                      const std::string& what = "instructions") const {
    return run({"--headless", "brownian", "--objects", "200", "--frames", "6", "--check", "hash",
                "--quiet", "--count", what, "--algorithm", algorithms, "--json", json},
               around);
  }
};

TEST_F(CountedInstructions, AreTheSameTwiceAndTheOnlyMeasure) {
  const std::string algorithms = "sap-simd,kd,tide";
  const ProgramResult first = count(algorithms, "a.json");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("instructions per frame"));
  // An environment of another size moves the stack.
  EXPECT_EQ(
      count(algorithms, "b.json", {.environment = {{"PADDING", std::string(1000, 'x')}}}).status,
      0);
  const Json cases = readJson(file("a.json")).at("cases");
  ASSERT_EQ(cases.size(), 3U);
  for (const Json& result : cases) {
    EXPECT_TRUE(result.at("conditions").at("counted_by").is_string());
    EXPECT_TRUE(result.at("summary").at("seconds_per_frame").is_null());
    EXPECT_TRUE(result.at("initialize_ns").at(0).is_null());
    EXPECT_TRUE(result.at("frames").at("total").at(0).empty());
    EXPECT_EQ(result.at("frame_counts").at("pairs").size(), 6U);
    EXPECT_GT(result.at("processor").at("instructions").at(0), 1000);
  }
  const ProgramResult same = run({"compare", "a.json", "b.json", "--count", "instructions"});
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("3 cases: 3 same")) << same.out;
}

TEST_F(CountedInstructions, OfFewerFrames) {
  EXPECT_EQ(count("sap", "a.json", {}, "instructions:2").status, 0);
  const Json result = readJson(file("a.json")).at("cases").at(0);
  EXPECT_EQ(result.at("frame_counts").at("pairs").size(), 2U);
}

TEST_F(CountedInstructions, DuelDecidesAtOnce) {
  const ProgramResult ended =
      run({"duel", "brownian", "--objects", "200", "--frames", "3", "--count", "instructions",
           "--quiet", "--json", "d.json", "bf", "sap"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Json compared = readJson(file("d.json")).at("cases").at(0);
  EXPECT_EQ(compared.at("verdict"), "faster");
  EXPECT_GT(compared.at("instructions_before"), compared.at("instructions_after"));
  EXPECT_TRUE(compared.at("seconds_before").is_null());
}

TEST_F(CountedInstructions, SuiteOfTwoBuildsFails) {
  const ProgramResult ended =
      run({"duel", "brownian", "--objects", "60", "--frames", "3", "--count", "instructions",
           "--quiet", "--algorithm", "repeated-search", "--plugin", places::slowPlugin(),
           "--baseline-plugin", places::quickPlugin()});
  EXPECT_EQ(ended.status, 3) << ended.out << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("REGRESSED"));
}

TEST_F(CountedInstructions, ThreadsAreRefused) {
  expectRefusal({"--headless", "brownian", "--objects", "60", "--frames", "3", "--count",
                 "instructions", "--algorithm", "kd-mt", "--threads", "2"},
                {"--count", "kd-mt", "--threads 1"});
}

TEST_F(CountedInstructions, NeedValgrindOrCounters) {
  if (ProcessorCounters::countInstructions()) GTEST_SKIP() << "the processor counts";
  expectRefusal({"--headless", "brownian", "--objects", "60", "--frames", "3", "--count",
                 "instructions", "--algorithm", "sap"},
                {"--count", "Debian's package valgrind"}, {.environment = {{"PATH", ""}}});
}

}  // namespace
}  // namespace broadmark::tests
