// Processor counters: counted events and intervals, and their storage in results. Few test machines
// allow hardware counters; page faults are counted in the same way.

#include "broadmark/harness/processor_counters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/perf_event.h>
#include <sys/mman.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "broadmark/execution.h"
#include "broadmark/results/results.h"
#include "engine/spoilt_cases.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

constexpr std::size_t kFaults = 200;

/// Page faults as "cycles"; all other counters have an invalid type.
ProcessorCounters::Events pageFaults() {
  constexpr std::uint32_t kUnknownType = 0xffffff;
  ProcessorCounters::Events events;
  events.fill({kUnknownType, 0});
  events[0] = {PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS};
  return events;
}

/// Touches kFaults new pages: each causes a page fault.
void makeFaults() {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t size = kFaults * page;
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  ::madvise(memory, size, MADV_NOHUGEPAGE);
  auto* bytes = static_cast<volatile char*>(memory);
  for (std::size_t i = 0; i < kFaults; ++i) bytes[i * page] = 1;
  ::munmap(memory, size);
}

class CountedFaults : public testing::Test {
 protected:
  void SetUp() override {
    if (!counters_.counts()[ProcessorCounter::cycles]) {
      GTEST_SKIP() << "this system allows no performance events";
    }
  }
  [[nodiscard]] std::uint64_t count() const {
    return counters_.counts()[ProcessorCounter::cycles].value();
  }

  ProcessorCounters counters_{pageFaults()};
};

TEST_F(CountedFaults, CountOnlyWhileTheyAreToldTo) {
  makeFaults();
  EXPECT_EQ(count(), 0U);
  {
    const ProcessorCounters::Counting counting(counters_);
    makeFaults();
  }
  const std::uint64_t counted = count();
  EXPECT_GE(counted, kFaults);
  makeFaults();
  EXPECT_EQ(count(), counted);
  counters_.restart();
  EXPECT_EQ(count(), 0U);
}

TEST_F(CountedFaults, IncludeThreadsStartedLater) {
  constexpr int kThreads = 4;
  ThreadTeam team(kThreads);
  {
    const ProcessorCounters::Counting counting(counters_);
    team.run([](int) { makeFaults(); });
  }
  EXPECT_GE(count(), kThreads * kFaults);
}

TEST_F(CountedFaults, WhatTheSystemRefusesIsUnknown) {
  EXPECT_FALSE(counters_.counts()[ProcessorCounter::instructions]);
  EXPECT_FALSE(counters_.counts()[ProcessorCounter::branch_misses]);
}

// Counters depend on the machine; if there are any, a frame has cycles and instructions.
TEST(ProcessorCountersOfARun, AreKeptPerRepetition) {
  const CaseResult result = runOnChain(caseOf(), {}, 2);
  ASSERT_EQ(result.repetitions.size(), 2U);
  for (const Repetition& repetition : result.repetitions) {
    for (const auto counter : {ProcessorCounter::cycles, ProcessorCounter::instructions}) {
      EXPECT_GT(repetition.processor[counter].value_or(1), 0U);
    }
  }
}

/// Two repetitions of two frames; only the second has cycles.
Results countedResults() {
  Results results;
  results.environments.emplace_back();
  CaseResult& result = results.cases.emplace_back();
  result.repetitions.resize(2);
  for (Repetition& repetition : result.repetitions) repetition.frames.resize(2);
  result.repetitions[1].processor[ProcessorCounter::cycles] = 31;
  return results;
}

std::string textOf(const Results& results, std::string_view name) {
  for (const ResultWriter& writer : resultWriters()) {
    if (writer.name == name) return writer.format(results);
  }
  return {};
}

TEST(ProcessorCountersInResults, JsonAndBack) {
  const std::string text = textOf(countedResults(), "json");
  const Json processor = Json::parse(text).at("cases").at(0).at("processor");
  EXPECT_EQ(processor.dump(),
            R"({"cycles":[null,31],"instructions":[null,null],"cache_misses":[null,null],)"
            R"("branches":[null,null],"branch_misses":[null,null]})");
  const Results back = parseResults(text, "r.json");
  const auto& repetitions = back.cases.at(0).repetitions;
  EXPECT_FALSE(repetitions.at(0).processor[ProcessorCounter::cycles]);
  EXPECT_EQ(repetitions.at(1).processor[ProcessorCounter::cycles], 31U);
  EXPECT_FALSE(repetitions.at(1).processor[ProcessorCounter::branches]);
}

TEST(ProcessorCountersInResults, EarlierFilesHaveNone) {
  Json file = Json::parse(textOf(countedResults(), "json"));
  file.at("cases").at(0).erase("processor");
  const Results back = parseResults(file.dump(), "r.json");
  EXPECT_FALSE(back.cases.at(0).repetitions.at(1).processor[ProcessorCounter::cycles]);
}

TEST(ProcessorCountersInResults, BadOnesAreRefused) {
  Json file = Json::parse(textOf(countedResults(), "json"));
  Json& cycles = file.at("cases").at(0).at("processor").at("cycles");
  const auto refusal = [&] { return inputErrorOf([&] { parseResults(file.dump(), "r.json"); }); };
  cycles = {1};
  EXPECT_THAT(refusal(), HasSubstr("cycles: one count per repetition"));
  cycles = {1, -1};
  EXPECT_THAT(refusal(), HasSubstr("cycles"));
}

TEST(ProcessorCountersInResults, CsvHasTheMeanPerFrame) {
  const std::string csv = textOf(countedResults(), "csv");
  EXPECT_THAT(csv, HasSubstr(",cycles_per_frame,instructions_per_frame,cache_misses_per_frame,"
                             "branches_per_frame,branch_misses_per_frame\n"));
  EXPECT_THAT(csv, HasSubstr(",15.5,,,,\n"));
}

}  // namespace
}  // namespace broadmark::tests
