// The command 'advise'.

#include <sstream>

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using ::testing::AllOf;

class Advise : public EndToEnd {
 protected:
  /// Advice on a small scene.
  [[nodiscard]] static Arguments adviceOn(const Arguments& more) {
    Arguments call = {"advise",  "freefall",      "--objects", "50",        "--frames", "30",
                      "--quiet", "--max-seconds", "1",         "--threads", "1"};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }
};

TEST_F(Advise, NamesAnAlgorithmForEachAnswerAndACommandThatRunsIt) {
  const ProgramResult ended =
      run(adviceOn({"--algorithm", "sap,kd", "--swept", "--param", "kd:objects_per_leaf=16",
                    "--param", "density=0.2", "--json", "advice.json"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* part : {"Pairs, 1 thread: ", "Events, 1 thread: ", " the fastest, with ",
                           "Second is ", "the last duel ran on "}) {
    EXPECT_THAT(onOneLine(ended.out), HasSubstr(part));
  }
  std::size_t commands = 0;
  for (const std::string& line : linesOf(ended.out)) {
    const std::size_t begin = line.find("broadmark --headless ");
    if (begin == std::string::npos) continue;
    ++commands;
    Arguments arguments;
    for (std::istringstream words(line.substr(begin + std::string("broadmark ").size()));
         words >> arguments.emplace_back();) {
    }
    arguments.pop_back();
    EXPECT_THAT(line, AllOf(HasSubstr("freefall --objects 50 --frames 30 --swept"),
                            HasSubstr("--param density=0.2")));
    if (line.find("--algorithm kd") != std::string::npos) {
      EXPECT_THAT(line, HasSubstr("--param kd:objects_per_leaf=16"));
    }
    EXPECT_EQ(run(arguments).status, 0) << line;
  }
  EXPECT_EQ(commands, 2U);
  const Json cases = readJson(file("advice.json")).at("cases");
  ASSERT_EQ(cases.size(), 4U);  // two for each answer, the first choice first
  EXPECT_EQ(cases[0].at("id"), cases[0].value("baseline", cases[0].at("id")));
  EXPECT_EQ(cases[1].at("baseline"), cases[0].at("id"));
}

TEST_F(Advise, AWrongAlgorithmIsOutOfTheQuestion) {
  const ProgramResult ended = run(adviceOn({"--plugin", places::faultyPlugin(), "--algorithm",
                                            "sap,faulty-extra", "--answer", "pairs"}));
  EXPECT_EQ(ended.status, 1) << ended.err;
  const std::string text = onOneLine(ended.out);
  for (const char* part : {"Pairs, 1 thread: sap is the fastest", "There is no runner-up.",
                           "DISQUALIFIED: faulty-extra: mismatch: frame"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("Events")));

  const ProgramResult none = run(adviceOn(
      {"--plugin", places::faultyPlugin(), "--algorithm", "faulty-extra", "--answer", "pairs"}));
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.out, HasSubstr("no algorithm gave correct answers"));
}

TEST_F(Advise, ACrashOrAHangCostsOnlyItsAlgorithm) {
  for (const char* deed : {"deed=crash", "deed=hang"}) {
    const ProgramResult ended =
        run(adviceOn({"--plugin", places::unrulyPlugin(), "--algorithm", "sap,unruly", "--param",
                      deed, "--answer", "pairs", "--hard-limit", "2"}));
    EXPECT_THAT(ended.out, HasSubstr("sap is the fastest")) << ended.err;
  }
}

TEST_F(Advise, SaysThatAChoiceIsConservative) {
  const ProgramResult ended = run(adviceOn({"--algorithm", "dbvt-d", "--answer", "pairs"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("dbvt-d"), HasSubstr("conservative")));
}

TEST_F(Advise, OnQueries) {
  const ProgramResult ended = run(adviceOn({"--queries", "rays:10", "--algorithm", "bvh8"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(StartsWith("Rays:10, 1 thread: bvh8"),
                               HasSubstr("--algorithm bvh8 --queries rays:10")));
}

TEST_F(Advise, BadInputIsRefused) {
  expectRefusal(adviceOn({"--algorithm", "sapp"}), {"--algorithm", "'sapp'", "'sap'"});
  expectRefusal({"advise", "freefall", "--max-seconds", "0"}, {"--max-seconds", "'0'"});
  expectRefusal(adviceOn({"--param", "densty=1"}), {"'densty'", "'density'"});
  expectRefusal(adviceOn({"--plugin", "gone.so"}), {"gone.so"});
  expectRefusal({"advise", "gone.aabbs"}, {"gone.aabbs"});
  expectRefusal({"advise", "freefall", "--objects", "20,30"}, {"advise", "2 recordings"});
  expectRefusal({"advise", "freefall", "--frames", "0"}, {"frame"});
}

}  // namespace
}  // namespace broadmark::tests
