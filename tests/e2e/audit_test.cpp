// The command 'audit', and a log of pairs as an algorithm.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class Audit : public EndToEnd {
 protected:
  /// Bodies 0 and 1 overlap in all three frames, body 2 touches body 1 in the last one only.
  void SetUp() override {
    const Aabb near = {{1, 0, 0, 0}, {2, 1, 1, 0}};
    const Aabb far = {{5, 0, 0, 0}, {6, 1, 1, 0}};
    const Aabb touching = {{2, 0, 0, 0}, {3, 1, 1, 0}};
    writeFile(
        file("session.aabbs"),
        recordingOf(3, 2, {kUnitBox, near, far, kUnitBox, near, far, kUnitBox, near, touching},
                    {{-5, -5, -5, 0}, {5, 5, 5, 0}}));
  }

  ProgramResult audit(const std::string& log, const Arguments& more = {}) {
    writeFile(file("log"), log);
    Arguments call = {"audit", "session.aabbs", "log", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return run(call);
  }
};

TEST_F(Audit, RightLogsPass) {
  for (const char* log :
       {"frame,a,b\n1,0,1\n2,1,0\n2,2,1\n", "b;frame;a\n1;1;0\n2;2;1\n0;2;1\n",
        "frame,a,b,event\n0,0,1,begin\n2,1,2,Begin\n",
        "{\"frame\": 2, \"pairs\": [[0, 1], [2, 1]]}\n{\"frame\": 1, \"pairs\": [[1, 0]]}\n",
        "{\"frame\": 1, \"began\": [[0, 1]]}\n\n{\"frame\": 2, \"began\": [[1, 2]], \"ended\": "
        "[]}\n"}) {
    const ProgramResult ended = audit(log);
    EXPECT_EQ(ended.status, 0) << log << ended.out << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("none is wrong")) << log;
  }
  EXPECT_THAT(audit("frame,a,b\n0,0,1\n1,0,1\n2,0,1\n2,1,2\n").out, HasSubstr("in 3 frames"));
}

TEST_F(Audit, FaultsOfEachKindAreCountedAndCutOut) {
  const ProgramResult ended =
      audit("frame,a,b\n1,1,0\n1,0,1\n1,0,2\n1,2,7\n2,0,1\n", {"--output", "faults"});
  EXPECT_EQ(ended.status, 1);
  for (const char* words :
       {"2 are wrong", "missed", "false", "duplicate", "impossible", "2-7",
        "missed in frame 2: bodies 1 and 2", "frame 1, body 1: (2, 0, 0)", "--plugin pairs:log"}) {
    EXPECT_THAT(ended.out, HasSubstr(words));
  }
  for (const std::string kind : {"missed", "false", "duplicate"}) {
    const ProgramResult again =
        run({"audit", "faults/" + kind + ".aabbs", "faults/" + kind + ".csv", "--quiet"});
    EXPECT_EQ(again.status, 1) << kind;
    EXPECT_THAT(linesOf(again.out)[2], HasSubstr(kind));
    EXPECT_THAT(again.out, Not(HasSubstr("impossible")));
  }
  EXPECT_EQ(audit("frame,a,b\n", {"--output", "faults"}).status, 2) << "nothing is written over";
}

TEST_F(Audit, CountsAreCompleteBeyondWhatIsListed) {
  std::string log = "frame,a,b\n1,0,1\n2,0,1\n2,1,2\n1,7,8\n";
  for (int i = 0; i < 3000; ++i) log += "1,0,1\n";
  const ProgramResult ended = audit(log);
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, testing::ContainsRegex("duplicate +3000"));
  EXPECT_THAT(ended.out, testing::ContainsRegex("impossible +1 "));
}

TEST_F(Audit, AnEndWithoutABeginningIsImpossible) {
  const ProgramResult ended = audit("frame,event,a,b\n1,begin,0,1\n2,end,2,0\n2,begin,1,2\n");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, HasSubstr("impossible"));
  EXPECT_THAT(ended.out, HasSubstr("0-2"));
}

TEST_F(Audit, AMarginAllowsPairs) {
  const std::string log = "frame,a,b\n1,0,1\n1,1,2\n2,0,1\n2,1,2\n";
  EXPECT_EQ(audit(log, {"--margin", "1"}).status, 1);
  const ProgramResult ended = audit(log, {"--margin", "1.5"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.out, HasSubstr("1 pair only within the margin"));
}

TEST_F(Audit, DamagedLogsAreRefusedWithTheirLine) {
  const auto refuse = [&](const std::string& log, const std::string& words) {
    const ProgramResult ended = audit(log);
    EXPECT_EQ(ended.status, 2) << log;
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(words)) << log;
  };
  refuse("", "is empty");
  refuse("1,0,1\n", "no column 'frame'");
  refuse("frame,a,b\n1,0\n", "line 2: has 2 cells, not 3");
  refuse("frame,a,b\n1,0,-1\n", "line 2: b -1");
  refuse("frame,a,b\n1,0,x\n", "line 2");
  refuse("frame,a,b,event\n1,0,1,start\n", "begin or end");
  refuse("frame,a,b\n3,0,1\n", "has frames 0 to 2");
  refuse("{\"frame\": 1}\n", "neither \"pairs\"");
  refuse("{\"frame\": 1, \"pairs\": [[0, 1, 2]]}\n", "not a pair [a, b]");
  refuse("{\"frame\": 1, \"pairs\": []}\n{\"frame\": 2, \"began\": []}\n",
         "line 2: pairs and events");
}

TEST_F(Audit, ALogIsAnAlgorithm) {
  writeFile(file("log.csv"), "frame,a,b\n1,0,1\n2,0,1\n");
  const ProgramResult ended = run({"--headless", "session.aabbs", "--plugin", "pairs:log.csv",
                                   "--algorithm", "logged", "--print-pairs", "--quiet"});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("frame 2: missed 1-2"));
  expectRefusal({"list", "--plugin", "pairs:none.csv"}, {"none.csv", "cannot read"});
}

}  // namespace
}  // namespace broadmark::tests
