// Run requests: the file returns the options of the command line; other members are rejected.

#include "command_line/run_requests.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/files.h"
#include "commands/command_line.h"
#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Arguments = std::vector<std::string>;

class RunRequests : public testing::Test {
 protected:
  /// The options of a command line that names a file with this text.
  SessionOptions sessionOn(const std::string& text, const Arguments& beside = {}) {
    writeTextFile(file_, text);
    Arguments arguments = {"--headless", "--request", file_.string()};
    arguments.insert(arguments.end(), beside.begin(), beside.end());
    return parseSession(arguments);
  }

  /// The options of a file with these members and the schema.
  SessionOptions sessionWith(const std::string& members, const Arguments& beside = {}) {
    return sessionOn(R"({"schema": "broadmark-run/1", )" + members + "}", beside);
  }

  std::string complaintAbout(const std::string& members) {
    return inputErrorOf([&] { sessionWith(members); });
  }

  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.json";
};

TEST_F(RunRequests, StateOnlyWhatIsNotAsByDefault) {
  const RunRequest request = parseSession({"--headless", "freefall", "--warmup", "0"});
  EXPECT_EQ(formatRunRequest(request),
            "{\n \"schema\": \"broadmark-run/1\",\n \"source\": [\n  \"freefall\"\n ]\n}\n");
}

TEST_F(RunRequests, KeepEveryOption) {
  const Arguments everything[] = {
      {"freefall", "a,b.aabbs"},
      {"--objects", "20,10", "--object-type", "cubes,spheres", "--frames", "5,6", "--seed", "3"},
      {"--density", "0.1", "--engine", "ode", "--input", "there", "--param", "a=1,2"},
      {"--param", "kd:b=x=y", "--plugin", "p,q.so", "--plugin", "r.so", "--recorder", "posrot"},
      {"--algorithm", "sap*,kd", "--threads", "2,1", "--isa", "sse2", "--device", "0"},
      {"--answer", "events", "--filter", "1e5|x", "--shard", "1/4", "--repetitions", "auto"},
      {"--precision", "1.5%", "--max-seconds", "60", "--order-seed", "7", "--warmup", "2"},
      {"--time-limit", "0.25", "--allow-timeout", "--check", "hash", "--hard-limit", "2.5"},
      {"--pin", "--memory-limit", "0.5", "--json", "r.json", "--csv", "r.csv", "--record", "dir"},
      {"--screenshot", "s.png", "--frame", "0", "--size", "16x9", "--gl", "egl", "--swept",
       "--widen", "0.25", "--periodic=-1:1,-,0:2", "--body-order", "morton"},
      {"--elements", "edges", "--radius", "0.5"}};
  Arguments arguments = {"--headless"};
  for (const Arguments& some : everything) {
    arguments.insert(arguments.end(), some.begin(), some.end());
  }
  const SessionOptions given = parseSession(arguments);
  const std::string text = formatRunRequest(given);
  const SessionOptions read = sessionOn(text);
  EXPECT_EQ(formatRunRequest(read), text);

  EXPECT_THAT(read.sources, ElementsAre("freefall", "a,b.aabbs"));
  EXPECT_THAT(read.plugins, ElementsAre("p,q.so", "r.so"));
  EXPECT_EQ(read.parameters, (ParameterValues{{"a", "1,2"}, {"kd:b", "x=y"}}));
  EXPECT_EQ(read.scene.parameters, given.scene.parameters);
  EXPECT_EQ(read.scene.objects, given.scene.objects);
  EXPECT_EQ(read.cases.threads, given.cases.threads);
  EXPECT_EQ(read.cases.isas, given.cases.isas);
  EXPECT_EQ(read.filter, "1e5|x");
  EXPECT_EQ(read.shard.count, 4);
  EXPECT_EQ(read.repetitions.precision, given.repetitions.precision);
  EXPECT_EQ(read.hosts.memory_limit_gib, 0.5);
  EXPECT_EQ(read.outputs, given.outputs);
  EXPECT_EQ(read.frame, 0U);
  EXPECT_TRUE(read.reading.swept);
  EXPECT_EQ(read.reading.widen, 0.25);
  EXPECT_EQ(read.reading.periodic, "-1:1,-,0:2");
  EXPECT_EQ(read.reading.body_order.value, "morton");
  EXPECT_EQ(read.reading.radius, 0.5);
}

TEST_F(RunRequests, HoldAFlagThatMayHaveAValue) {
  const SessionOptions given = parseSession({"--headless", "--periodic", "freefall"});
  EXPECT_EQ(given.reading.periodic, "source");
  EXPECT_EQ(sessionOn(formatRunRequest(given)).reading.periodic, "source");
  EXPECT_EQ(sessionWith(R"("source": "freefall", "periodic": true)").reading.periodic, "source");
  EXPECT_EQ(sessionWith(R"("source": "freefall", "periodic": "0:1,-,-")").reading.periodic,
            "0:1,-,-");
}

TEST_F(RunRequests, AreUnderstoodHoweverValuesAreWritten) {
  const SessionOptions options = sessionWith(
      R"("source": "freefall", "objects": 20, "threads": [2, 1], "algorithm": "sap,kd",
         "frames": "7", "param": {"margin": [0.5, 1], "shrink": true}, "pin": true,
         "allow_timeout": false, "device": null, "plugin": "one.so")");
  EXPECT_THAT(options.sources, ElementsAre("freefall"));
  EXPECT_THAT(options.scene.objects, ElementsAre(20));
  EXPECT_THAT(options.cases.threads, ElementsAre(1, 2));
  EXPECT_THAT(options.cases.algorithms, ElementsAre("sap", "kd"));
  EXPECT_EQ(options.parameters, (ParameterValues{{"margin", "0.5,1"}, {"shrink", "true"}}));
  EXPECT_TRUE(options.hosts.pin);
  EXPECT_FALSE(options.allow_timeout);
  EXPECT_THAT(options.plugins, ElementsAre("one.so"));
}

TEST_F(RunRequests, MayHoldFormerNames) {
  const SessionOptions options = sessionWith(
      R"("source": "freefall", "repetitions": "auto", "most_seconds": 60, "param": {"crowded": 7})");
  EXPECT_EQ(options.repetitions.max_seconds, 60);
  EXPECT_EQ(options.parameters, (ParameterValues{{"split_threshold", "7"}}));
}

TEST_F(RunRequests, GiveWayToOptionsBesideThem) {
  const SessionOptions options =
      sessionWith(R"("source": "freefall", "objects": 20, "shard": "0/2", "json": "a.json")",
                  {"brownian", "--shard", "1/2", "--json", "b.json"});
  EXPECT_THAT(options.sources, ElementsAre("brownian"));
  EXPECT_THAT(options.scene.objects, ElementsAre(20));
  EXPECT_EQ(options.shard.index, 1);
  EXPECT_EQ(options.outputs.at("json"), "b.json");
}

TEST_F(RunRequests, TellResultsWhichArgumentsAskForTheSame) {
  const SessionOptions options = sessionWith(R"("source": "freefall", "objects": [20, 30])");
  EXPECT_EQ(formatRunRequest(
                parseSession({options.command_line.begin(), options.command_line.end() - 2})),
            formatRunRequest(options))
      << "without --request itself";
}

TEST_F(RunRequests, RefuseWhatTheyDoNotHave) {
  EXPECT_THAT(complaintAbout(R"("source": "freefall", "algoritm": "kd")"),
              AllOf(HasSubstr("run.json"), HasSubstr("'algoritm'"), HasSubstr("'algorithm'")));
  for (const char* key : {"headless", "list", "quiet", "ui", "export_case", "request"}) {
    EXPECT_THAT(complaintAbout(fmt::format(R"("source": "freefall", "{}": true)", key)),
                HasSubstr(fmt::format("'{}'", key)));
  }
  EXPECT_THAT(complaintAbout(R"("source": "freefall", "pin": 1)"), HasSubstr("pin"));
  EXPECT_THAT(complaintAbout(R"("source": "freefall", "threads": {"a": 1})"), HasSubstr("threads"));
  EXPECT_THAT(complaintAbout(R"("source": "freefall", "threads": [[1]])"), HasSubstr("threads"));
  EXPECT_THAT(complaintAbout(R"("source": "freefall", "threads": "two")"),
              AllOf(HasSubstr("--threads"), HasSubstr("'two'")));
  EXPECT_THAT(complaintAbout(R"("source": "freefall", "param": "a=1")"), HasSubstr("param"));
  EXPECT_THAT(complaintAbout(R"("objects": 5)"), HasSubstr("no source"));
  EXPECT_THAT(inputErrorOf([&] { sessionOn(R"({"schema": "broadmark-results/2"})"); }),
              AllOf(HasSubstr("run.json"), HasSubstr("broadmark-run/1")));
  EXPECT_THAT(inputErrorOf([&] { sessionOn("[]"); }), HasSubstr("run.json"));
  EXPECT_THAT(inputErrorOf([&] { sessionOn("{"); }), HasSubstr("run.json"));
}

}  // namespace
}  // namespace broadmark::tests
