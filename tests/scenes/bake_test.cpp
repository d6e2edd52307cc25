// Baking recordings with sidecars, and detecting existing ones.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "broadmark/error.h"
#include "broadmark/recordings/recording.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<Simulation> simulationOf(const std::string& scene, ParameterValues values = {}) {
  values.insert({{"objects", "40"}, {"frames", "6"}});
  return sceneWith(scene, values);
}

class Bake : public testing::Test {
 protected:
  [[nodiscard]] nlohmann::json sidecar() const {
    return nlohmann::json::parse(std::ifstream(sidecar_));
  }
  void writeSidecar(const std::string& text) const { std::ofstream(sidecar_) << text; }

  TemporaryDirectory directory_;
  fs::path path_ = directory_ / "scene.aabbs";
  fs::path sidecar_ = directory_ / "scene.json";
};

TEST_F(Bake, WritesEveryBuiltInSceneAsAReadableRecording) {
  for (const SceneListing& listing : builtinScenes()) {
    auto simulation = simulationOf(listing.id);
    const std::string_view extension = recordingExtension(simulation->scene());
    path_.replace_extension(extension);
    ASSERT_TRUE(bake(*simulation, {path_}));
    const auto reader = openRecordingFile(path_);
    EXPECT_EQ(reader->scene(), simulation->scene());
    EXPECT_EQ(reader->scene().name, listing.name);
    EXPECT_EQ(reader->hash(), bakedHash(path_));
    if (extension == kAabbsExtension) {
      EXPECT_EQ(fs::file_size(path_), 304U + 32U * 40U * 7U);
    }

    auto again = simulationOf(listing.id);
    EXPECT_EQ(allFrames(*reader), allFrames(*again));
    EXPECT_TRUE(isBaked(path_, *again));
  }
}

TEST_F(Bake, SidecarStatesAllParametersAndTheHash) {
  auto simulation = simulationOf("gravity", {{"density", "0.25"}, {"seed", "12"}});
  bake(*simulation, {path_});
  const nlohmann::json json = sidecar();
  EXPECT_EQ(json["schema"], "broadmark-bake/1");
  EXPECT_EQ(json["scene"], "gravity");
  EXPECT_EQ(json["hash"], RecordingReader(path_).hash());
  const nlohmann::json& parameters = json["parameters"];
  EXPECT_TRUE(parameters["objects"].is_number_integer());
  EXPECT_EQ(parameters["objects"], 40);
  EXPECT_EQ(parameters["density"], 0.25);
  EXPECT_EQ(parameters["seed"], 12);
  EXPECT_EQ(parameters["object_type"], "cubes");
  EXPECT_EQ(parameters["period"], 6.2);
  EXPECT_EQ(parameters.size(), parameterValues(*simulation).size());
}

TEST_F(Bake, TellsItsProgress) {
  std::vector<std::uint32_t> told;
  bake(*simulationOf("brownian"), {path_}, [&](std::uint32_t frame) {
    told.push_back(frame);
    return true;
  });
  EXPECT_EQ(told, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST_F(Bake, LeavesNothingWhenStopped) {
  for (const std::uint32_t last : {0U, 3U, 6U}) {
    EXPECT_FALSE(bake(*simulationOf("brownian"), {path_},
                      [&](std::uint32_t frame) { return frame < last; }));
    EXPECT_TRUE(directory_.empty()) << "stopped at frame " << last;
  }
}

TEST_F(Bake, StoppingKeepsAnOlderRecording) {
  auto older = simulationOf("brownian");
  bake(*older, {path_});
  bake(*simulationOf("brownian", {{"seed", "9"}}), {path_}, [](std::uint32_t) { return false; });
  EXPECT_TRUE(isBaked(path_, *older));
}

TEST_F(Bake, IsRecognisedByItsParameters) {
  auto simulation = simulationOf("brownian");
  EXPECT_FALSE(isBaked(path_, *simulation)) << "nothing there";
  bake(*simulation, {path_});
  EXPECT_TRUE(isBaked(path_, *simulation));
  EXPECT_TRUE(isBaked(path_, *simulationOf("brownian")));
  EXPECT_FALSE(isBaked(path_, *simulationOf("brownian", {{"seed", "2"}})));
  EXPECT_FALSE(isBaked(path_, *simulationOf("brownian", {{"launch_share", "0.02"}})));
  EXPECT_FALSE(isBaked(path_, *simulationOf("brownian", {{"time_step", "0.03333"}})));
  EXPECT_FALSE(isBaked(path_, *simulationOf("gravity")));
}

TEST_F(Bake, ADamagedSidecarMeansNotBaked) {
  auto simulation = simulationOf("brownian");
  bake(*simulation, {path_});
  const nlohmann::json good = sidecar();
  writeSidecar(good.dump());
  EXPECT_TRUE(isBaked(path_, *simulation)) << "the layout of the text does not matter";

  const auto without = [&](const char* key) {
    nlohmann::json json = good;
    json.erase(key);
    return json.dump();
  };
  nlohmann::json wrong_hash = good;
  wrong_hash["hash"] = std::string(32, '0');
  nlohmann::json hash_number = good;
  hash_number["hash"] = 5;
  nlohmann::json other_schema = good;
  other_schema["schema"] = "broadmark-bake/2";
  nlohmann::json fewer_parameters = good;
  fewer_parameters["parameters"].erase("mass");
  nlohmann::json more_parameters = good;
  more_parameters["parameters"]["colour"] = 1;
  nlohmann::json text_for_number = good;
  text_for_number["parameters"]["objects"] = "40";
  const std::string text = good.dump();
  for (const std::string& bad :
       {std::string(), std::string("null"), std::string("[]"), std::string("{}"),
        std::string("\xff\xfe\x00", 3), text.substr(0, text.size() / 2), text + "}",
        std::string(100'000, '['), without("hash"), without("schema"), without("parameters"),
        wrong_hash.dump(), hash_number.dump(), other_schema.dump(), fewer_parameters.dump(),
        more_parameters.dump(), text_for_number.dump()}) {
    writeSidecar(bad);
    EXPECT_FALSE(isBaked(path_, *simulation)) << bad.substr(0, 200);
  }
  fs::remove(sidecar_);
  EXPECT_FALSE(isBaked(path_, *simulation)) << "no sidecar";
}

TEST_F(Bake, AChangedRecordingMeansNotBaked) {
  auto simulation = simulationOf("brownian");
  bake(*simulation, {path_});
  const auto size = fs::file_size(path_);
  {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size - 32 * 20));
    const float changed = -1e5F;
    file.write(reinterpret_cast<const char*>(&changed), sizeof changed);
  }
  EXPECT_FALSE(isBaked(path_, *simulation)) << "one number differs";

  bake(*simulation, {path_});
  EXPECT_TRUE(isBaked(path_, *simulation)) << "baked again";
  fs::resize_file(path_, size - 32);
  EXPECT_FALSE(isBaked(path_, *simulation)) << "cut short";
  fs::remove(path_);
  EXPECT_FALSE(isBaked(path_, *simulation)) << "no recording";
}

TEST_F(Bake, RejectsPathsThatCannotBeWritten) {
  EXPECT_THROW(bake(*simulationOf("brownian"), {directory_ / "none/scene.aabbs"}), InputError);
  // Its sidecar would have the same path.
  EXPECT_THROW(bake(*simulationOf("brownian"), {directory_ / "scene.json"}), InputError);
  // Two recordings cannot share a sidecar.
  EXPECT_THROW(bake(*simulationOf("brownian"), {path_, directory_ / "scene.posrot"}), InputError);
  EXPECT_TRUE(directory_.empty());
}

}  // namespace
}  // namespace broadmark::tests
