// Every kind of source is recognised and opened; errors for others list the valid kinds.

#include "sources/source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "app/session_files.h"
#include "broadmark/algorithms.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

class Sources : public testing::Test {
 protected:
  /// A file with this text.
  std::string write(const std::string& name, const std::string& text) const {
    const auto path = directory_ / name;
    writeTextFile(path, text);
    return path.string();
  }
  [[nodiscard]] std::string recording(const std::string& name = "small.aabbs") const {
    const auto path = directory_ / name;
    writeRecording(path);
    return path.string();
  }

  static OpenedSource open(const std::string& name, OpeningOptions options = {}) {
    options.algorithms = builtinAlgorithms();
    return openSource(name, options);
  }
  /// The only entry of a source.
  static PlanEntry entryOf(const std::string& name, OpeningOptions options = {}) {
    OpenedSource opened = open(name, std::move(options));
    EXPECT_FALSE(opened.results);
    EXPECT_THAT(opened.entries, SizeIs(1));
    return std::move(opened.entries.at(0));
  }

  TemporaryDirectory directory_;
};

TEST_F(Sources, KindsAreDescribed) {
  std::set<std::string> texts;
  for (const SourceKind& kind : sourceKinds()) {
    EXPECT_TRUE(texts.insert(kind.what).second) << kind.what;
    EXPECT_THAT(sourceKindsText(), HasSubstr(kind.what));
  }
}

TEST_F(Sources, ImportedFiles) {
  OpeningOptions options;
  options.reading.radius = 2;
  options.reading.swept = true;
  const PlanEntry entry = entryOf(write("p.xyz", "1\n\nA 0 0 0\n"), options);
  ASSERT_TRUE(entry.source.imported);
  EXPECT_FALSE(entry.source.simulation);
  EXPECT_EQ(entry.source.reference.scene.name, "p swept");
  EXPECT_EQ(entry.source.reference.reading, (ParameterValues{{"radius", "2"}, {"swept", "on"}}));
  std::filesystem::create_directory(directory_ / "more");
  write("more/a.csv", "0,0,0,0,0,1,1,1\n");
  EXPECT_EQ(entryOf((directory_ / "more").string()).source.reference.scene.name, "a");
}

TEST_F(Sources, AnythingCanBeSwept) {
  OpeningOptions options;
  options.reading.swept = true;
  for (const std::string& name : {std::string("freefall"), recording()}) {
    const RecordingReference reference = entryOf(name, options).source.reference;
    EXPECT_THAT(reference.scene.name, testing::EndsWith(" swept"));
    EXPECT_EQ(reference.reading, (ParameterValues{{"swept", "on"}}));
  }
}

TEST_F(Sources, ReadingOptionsMustMeanSomething) {
  ReadingOptions reading;
  reading.frame_rate = 5;
  // A sequence of meshes has no rate.
  const std::string mesh = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string& name : {std::string("freefall"), mesh}) {
    std::vector<PlanEntry> entries;
    entries.push_back(entryOf(name, {.reading = reading}));
    EXPECT_THAT(inputErrorOf([&] { requireReadingUsed(reading, entries); }),
                HasSubstr("--frame-rate"));
  }
}

TEST_F(Sources, BuiltInScenes) {
  for (const SceneListing& scene : builtinScenes()) {
    const PlanEntry entry = entryOf(scene.id);
    ASSERT_TRUE(entry.source.simulation);
    EXPECT_EQ(entry.source.simulation->listing().id, scene.id);
    EXPECT_EQ(entry.source.reference.scene.name, scene.name);
    EXPECT_TRUE(entry.source.reference.seed);
    EXPECT_THAT(entry.cases, IsEmpty());
    EXPECT_TRUE(isSource(scene.id));
  }
}

TEST_F(Sources, EveryCombinationOfAScenesOptions) {
  const OpenedSource opened =
      open("freefall", {.scene = {.objects = {10, 20},
                                  .object_types = {"spheres", "cubes"},
                                  .parameters = {{"frames", "3"}}},
                        .parameters = {{"density", "0.05"}, {"objects_per_cell", "7"}}});
  std::vector<std::string> made;
  for (const PlanEntry& entry : opened.entries) {
    const SceneInfo& scene = entry.source.reference.scene;
    EXPECT_EQ(scene.frames, 3U);
    EXPECT_EQ(entry.source.reference.scene_parameters.at("density"), "0.05");
    made.push_back(scene.object_type + std::to_string(scene.objects));
  }
  EXPECT_THAT(made, testing::ElementsAre("Spheres10", "Spheres20", "Cubes10", "Cubes20"));
}

TEST_F(Sources, EveryEngineWithItsOwnParameters) {
  const OpenedSource opened = open(
      "brownian",
      {.scene = {.parameters = {{"engine", "boids,bullet"}}}, .parameters = {{"sight", "2,3"}}});
  std::vector<ParameterValues> swept;
  for (const PlanEntry& entry : opened.entries) swept.push_back(entry.source.reference.swept);
  EXPECT_THAT(swept, testing::ElementsAre(ParameterValues{{"engine", "boids"}, {"sight", "2"}},
                                          ParameterValues{{"engine", "boids"}, {"sight", "3"}},
                                          ParameterValues{{"engine", "bullet"}}));
  EXPECT_THAT(inputErrorOf([&] {
                open("brownian", {.scene = {.parameters = {{"engine", "boids,bulet"}}}});
              }),
              HasSubstr("'bulet'"));
}

TEST_F(Sources, Recordings) {
  const std::string path = recording();
  const PlanEntry entry = entryOf(path);
  EXPECT_FALSE(entry.source.simulation);
  EXPECT_EQ(entry.source.reference.path, path);
  EXPECT_EQ(entry.source.reference.scene.name, "Small");
  EXPECT_THAT(entry.source.expected_hash, IsEmpty());
  EXPECT_FALSE(entry.knownDifference());
}

TEST_F(Sources, AuthoredScenes) {
  const std::string path = write("mine.json", kAuthoredSceneText);
  const PlanEntry entry = entryOf(path);
  ASSERT_TRUE(entry.source.simulation);
  EXPECT_EQ(entry.source.simulation->listing().id, kAuthoredSceneId);
  EXPECT_EQ(entry.source.reference.scene.objects, 1U);
  EXPECT_EQ(entry.source.reference.scene_parameters.at("scene_file"), path);
  EXPECT_FALSE(entry.source.reference.seed);
  EXPECT_EQ(
      entryOf(path, {.scene = {.parameters = {{"frames", "9"}}}}).source.reference.scene.frames,
      9U);
}

TEST_F(Sources, AuthoredScenesStateTheirBodies) {
  const std::string path = write("mine.json", kAuthoredSceneText);
  const auto refuses = [&](const SceneOptions& scene, const std::string& option) {
    EXPECT_THAT(inputErrorOf([&] { open(path, {.scene = scene}); }),
                AllOf(HasSubstr("mine.json"), HasSubstr(option)));
  };
  refuses({.objects = {5}}, "--objects");
  refuses({.object_types = {"cubes"}}, "--object-type");
  refuses({.parameters = {{"density", "0.1"}}}, "--density");
}

TEST_F(Sources, SceneParameters) {
  const std::string path = write("scene.json", kSceneParametersText);
  const PlanEntry entry = entryOf(path);
  ASSERT_TRUE(entry.source.simulation);
  EXPECT_EQ(entry.source.reference.scene.name, "Brownian");
  EXPECT_EQ(entry.source.reference.scene.objects, 5U);
  EXPECT_EQ(entry.source.reference.seed, 8U);
  EXPECT_THAT(open(path, {.scene = {.objects = {2, 3}}}).entries, SizeIs(2));
}

TEST_F(Sources, OriginalSettings) {
  writeRecording(directory_ / "small.aabbs");  // the name without a folder
  const PlanEntry entry = entryOf(write("settings.json", originalSettingsText("small.aabbs")));
  ASSERT_TRUE(entry.original);
  EXPECT_EQ(entry.original->output_log, "log.json");
  ASSERT_THAT(entry.cases, SizeIs(1));
  EXPECT_EQ(entry.cases.front().algorithm.id, "bf-simd");
  EXPECT_EQ(entry.cases.front().isa, Isa::sse2);
  EXPECT_EQ(entry.source.reference.scene.objects, 2U);
}

TEST_F(Sources, OriginalSettingsThreadsAndParameters) {
  writeRecording(directory_ / "small.aabbs");
  const auto path_of = [this](const std::string& settings) {
    return write("settings.json",
                 R"({"m_inputScene": "small.aabbs", "m_outputLog": "log.json", )" + settings + "}");
  };
  const auto case_of = [&](const std::string& settings) {
    return entryOf(path_of(settings)).cases.at(0);
  };
  const Case kd = case_of(R"("m_algorithm": "KD", "m_KD_ObjectsPerLeaf": 20,
                             "m_margin": {"x": 0.25, "y": 0.5, "z": 0.125})");
  EXPECT_EQ(kd.algorithm.id, "kd");
  EXPECT_EQ(kd.parameters, (ParameterValues{{"margin", "0.5"}, {"objects_per_leaf", "20"}}));

  const Case bf = case_of(R"("m_algorithm": "BF_SSE_Parallel", "m_numThreads": 9000)");
  EXPECT_EQ(bf.algorithm.id, "bf-simd-mt");
  EXPECT_EQ(bf.isa, Isa::sse2);
  EXPECT_EQ(bf.threads, 1024);

  const Case tracy = case_of(R"("m_algorithm": "Tracy_Parallel", "m_Grid_ObjectsPerCell": 7)");
  EXPECT_EQ(tracy.parameters.at("objects_per_cell"), "7");

  EXPECT_THAT(inputErrorOf([&] { open(path_of(R"("m_algorithm": "BF_SS")")); }),
              AllOf(HasSubstr("m_algorithm"), HasSubstr("'BF_SS'"), HasSubstr("BF_SSE")));
}

TEST_F(Sources, ResultsWithAChosenCase) {
  const std::string path = recording();
  const CaseResult right = resultOn(path, "sap");
  const CaseResult wrong = resultOn(path, "bf-simd-mt", 3);
  const std::string results = (directory_ / "results.json").string();
  writeResults(results, {right, wrong});
  const PlanEntry entry = entryOf(results, {.case_id = wrong.id});
  ASSERT_TRUE(entry.known);
  EXPECT_EQ(entry.known->id, wrong.id);
  ASSERT_THAT(entry.cases, SizeIs(1));
  EXPECT_EQ(entry.cases.front().algorithm.id, "bf-simd-mt");
  EXPECT_EQ(entry.cases.front().threads, 2);
  EXPECT_THAT(entry.cases.front().parameters, IsEmpty()) << "none differs from its default";
  EXPECT_EQ(entry.source.expected_hash, wrong.recording.hash);
  ASSERT_TRUE(entry.knownDifference());
  EXPECT_EQ(entry.knownDifference()->frame, 3U) << "the first, wherever it is listed";
  EXPECT_FALSE(entryOf(results, {.case_id = right.id}).knownDifference());
}

TEST_F(Sources, OfSeveralCasesOfOneIdTheFirstWithAMismatch) {
  const std::string path = recording();
  const std::string results = (directory_ / "results.json").string();
  writeResults(results,
               {resultOn(path, "sap"), resultOn(path, "sap", 5), resultOn(path, "sap", 6)});
  const PlanEntry entry = entryOf(results, {.case_id = resultOn(path, "sap").id});
  EXPECT_EQ(entry.knownDifference()->frame, 5U);
}

TEST_F(Sources, ResultsWithoutAChosenCase) {
  const std::string results = (directory_ / "results.json").string();
  writeResults(results, {resultOn(recording(), "sap")});
  const OpenedSource opened = open(results);
  ASSERT_TRUE(opened.results);
  EXPECT_THAT(opened.results->cases, SizeIs(1));
  EXPECT_THAT(opened.entries, IsEmpty());
}

TEST_F(Sources, CasesThatCannotBeOpenedAreNamed) {
  const std::string results = (directory_ / "results.json").string();
  CaseResult result = resultOn(recording(), "sap");
  CaseResult foreign = result;
  foreign.id = "foreign";
  foreign.algorithm = "mine";
  foreign.plugin = "libmine.so";
  CaseResult unknown = foreign;
  unknown.id = "unknown";
  unknown.plugin.clear();
  writeResults(results, {result, foreign, unknown});
  const auto error = [&](const std::string& id) {
    return inputErrorOf([&] { open(results, {.case_id = id}); });
  };
  EXPECT_THAT(error(result.id + "y"), AllOf(HasSubstr("results.json"), HasSubstr(result.id)));
  EXPECT_THAT(error("foreign"),
              AllOf(HasSubstr("'mine'"), HasSubstr("--plugin"), HasSubstr("libmine.so")));
  EXPECT_THAT(error("unknown"), AllOf(HasSubstr("'mine'"), Not(HasSubstr("--plugin"))));
}

TEST_F(Sources, UnknownOnesAreRefusedWithWhatWouldBeRight) {
  EXPECT_THAT(inputErrorOf([] { open("freefal"); }),
              AllOf(HasSubstr("'freefal'"), HasSubstr("'freefall'")));
  EXPECT_FALSE(isSource("freefal"));
  EXPECT_TRUE(isSource("freefal.json"));
  EXPECT_THAT(inputErrorOf([] { open("missing.json"); }), HasSubstr("missing.json"));
  EXPECT_THAT(inputErrorOf([] { open("missing.aabbs"); }), HasSubstr("missing.aabbs"));
  for (const char* text : {"{}", "[]", "5", R"({"schema": "something/9"})", R"({"schema": 5})"}) {
    const std::string error = inputErrorOf([&] { open(write("unknown.json", text)); });
    for (const char* word : {"unknown.json", "broadmark-scene/1", "broadmark-results/2",
                             "broadmark-scene-parameters/1", "m_inputScene"}) {
      EXPECT_THAT(error, HasSubstr(word)) << text;
    }
  }
  EXPECT_THAT(inputErrorOf([&] { open(write("unknown.json", R"({"schema": "something/9"})")); }),
              HasSubstr("'something/9'"));
  EXPECT_THAT(inputErrorOf([&] { open(write("broken.json", "{")); }), HasSubstr("broken.json"));
}

TEST_F(Sources, ATextIsReadOnce) {
  const std::string path = write("scene.json", kSceneParametersText);
  NamedSource source(path);
  EXPECT_TRUE(source.isFile());
  EXPECT_TRUE(source.isJson());
  EXPECT_EQ(source.schema(), kSceneParametersSchema);
  std::filesystem::remove(path);
  EXPECT_EQ(source.text(), kSceneParametersText);
  EXPECT_EQ(source.schema(), kSceneParametersSchema);
}

}  // namespace
}  // namespace broadmark::tests
