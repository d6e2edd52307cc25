// Cases in separate processes: a misbehaving algorithm affects its own status and the run's exit
// status, but no other case.

#include <fmt/format.h>
#include <poll.h>

#include <csignal>

#include "e2e/end_to_end.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using ::testing::AllOf;

class Worker : public EndToEnd {
 protected:
  /// A small run of the unruly algorithm, followed by bf.
  [[nodiscard]] static Arguments call(const std::vector<std::string>& parameters,
                                      const Arguments& more = {}) {
    Arguments call = {"--headless",  "brownian",  "--objects", "20",
                      "--frames",    "4",         "--plugin",  places::unrulyPlugin(),
                      "--algorithm", "unruly,bf", "--quiet",   "--json",
                      "r.json"};
    for (const std::string& parameter : parameters) {
      call.insert(call.end(), {"--param", parameter});
    }
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }

  struct Outcome {
    ProgramResult ended;
    Json unruly;
    Json other;
  };
  [[nodiscard]] Outcome outcomeOf(const std::vector<std::string>& parameters,
                                  const Arguments& more = {}) const {
    Outcome outcome{.ended = run(call(parameters, more))};
    const Json results = readJson(file("r.json"));
    for (const Json& result : results.at("cases")) {
      (result.at("algorithm") == "unruly" ? outcome.unruly : outcome.other) = result;
    }
    return outcome;
  }

  /// Expects that these parameters make the unruly case fail, and no other.
  void expectFailure(const std::vector<std::string>& parameters, const std::string& status,
                     const std::vector<std::string>& words, const Arguments& more = {}) const {
    SCOPED_TRACE(fmt::format("{}", parameters.front()));
    const Outcome outcome = outcomeOf(parameters, more);
    EXPECT_EQ(outcome.ended.status, status == "timeout" ? 4 : 1) << outcome.ended.err;
    EXPECT_EQ(outcome.unruly.at("status"), status);
    for (const std::string& word : words) {
      EXPECT_THAT(outcome.unruly.at("reason").get<std::string>(), HasSubstr(word));
    }
    EXPECT_EQ(outcome.other.at("status"), "ok") << "the others go on";
    EXPECT_EQ(outcome.other.at("frames").at("total").at(0).size(), 4U);
  }
};

TEST_F(Worker, ACrashIsAnErrorWithSignalAndFrame) {
  expectFailure({"deed=crash"}, "error", {"frame 2", "SIGSEGV"});
  expectFailure({"deed=crash", "call=initialize"}, "error", {"frame 0", "SIGSEGV"});
  expectFailure({"deed=crash", "call=counters"}, "error", {"frame 2", "SIGSEGV"});
  expectFailure({"deed=crash", "call=destroy"}, "error", {"frame 4", "SIGSEGV"});
}

TEST_F(Worker, AHangEndsAtTheHardLimit) {
  expectFailure({"deed=hang"}, "timeout", {"frame 2", "hard limit of 0.5 s"},
                {"--hard-limit", "0.5"});
}

TEST_F(Worker, WhatIsThrownIsAnError) {
  expectFailure({"deed=throw"}, "error", {"frame 2", "thrown on purpose"});
  expectFailure({"deed=throw-number"}, "error", {"frame 2"});
  expectFailure({"deed=throw"}, "error", {"frame 2", "thrown on purpose"}, {"--in-process"});
}

TEST_F(Worker, AnExitIsAnError) {
  expectFailure({"deed=exit"}, "error", {"frame 2", "exited", "status 3"});
}

TEST_F(Worker, WhoClosesTheChannelIsAnError) {
  expectFailure({"deed=close"}, "error", {"frame 2"});
}

TEST_F(Worker, OutOfMemoryIsAnError) {
  if (tests::kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  expectFailure({"deed=allocate"}, "error", {"frame 2", "out of memory"},
                {"--memory-limit", "0.25"});
}

TEST_F(Worker, WhatItPrintsIsNotAmongTheResults) {
  const Outcome outcome = outcomeOf({"deed=print"});
  EXPECT_EQ(outcome.ended.status, 0);
  EXPECT_EQ(outcome.unruly.at("status"), "ok");
  EXPECT_THAT(outcome.ended.out, Not(HasSubstr("printed on purpose")));
  EXPECT_THAT(outcome.ended.err, HasSubstr("printed on purpose"));
}

TEST_F(Worker, AnotherCountEachTimeIsAMismatch) {
  for (const char* check : {"full", "hash"}) {
    expectFailure({"deed=count"}, "mismatch", {"frame 2"},
                  {"--check", check, "--repetitions", "2"});
  }
}

TEST_F(Worker, AFailureEndsTheRepetitionsOfItsCase) {
  const Outcome outcome = outcomeOf({"deed=crash"}, {"--repetitions", "3"});
  EXPECT_TRUE(outcome.unruly.at("frames").at("total").empty());
  EXPECT_EQ(outcome.other.at("frames").at("total").size(), 3U);
}

TEST_F(Worker, ItsMemoryIsWhatTheAlgorithmTakes) {
  if (tests::kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const Outcome outcome = outcomeOf({"mebibytes=64"});
  const auto peak = outcome.unruly.at("peak_bytes").get<std::uint64_t>();
  EXPECT_GE(peak, 62U << 20);
  EXPECT_LE(peak, 72U << 20);
  EXPECT_LE(outcome.other.at("peak_bytes").get<std::uint64_t>(), 8U << 20);
}

TEST_F(Worker, InThisProcessMemoryIsNotKnown) {
  const Outcome outcome = outcomeOf({}, {"--in-process"});
  EXPECT_EQ(outcome.ended.status, 0);
  EXPECT_TRUE(outcome.unruly.at("peak_bytes").is_null());
  for (const char* option : {"--hard-limit", "--memory-limit"}) {
    expectRefusal(call({}, {"--in-process", option, "1"}), {option, "--in-process"});
  }
}

TEST_F(Worker, CtrlCEndsAHangAtOnce) {
  Program program(directory_, call({"deed=hang"}));
  ASSERT_TRUE(program.waitForText("hanging on purpose"));
  const std::vector<pid_t> workers = program.children();
  EXPECT_THAT(workers, Not(IsEmpty()));
  program.signal(SIGINT);
  const ProgramResult ended = program.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.err, HasSubstr("interrupted"));
  for (const pid_t worker : workers) EXPECT_NE(::kill(worker, 0), 0) << "no process is left";
}

TEST_F(Worker, IsGoneWithTheProcessThatStartedIt) {
  Program program(directory_, call({"deed=hang"}));
  ASSERT_TRUE(program.waitForText("hanging on purpose"));
  std::vector<FileDescriptor> workers;
  for (const pid_t worker : program.children()) workers.push_back(processDescriptor(worker));
  EXPECT_THAT(workers, Not(IsEmpty()));
  program.signal(SIGKILL);
  program.wait();
  for (const FileDescriptor& worker : workers) {
    pollfd ended{worker.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&ended, 1, -1), 1);  // wait for its end
  }
}

TEST_F(Worker, IsNotToBeCalledByHand) { expectRefusal({"worker"}, {"'worker' is internal"}); }

}  // namespace
}  // namespace broadmark::tests
