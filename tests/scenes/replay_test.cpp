// Recorded poses compared with recorded boxes, and the engines that replay recordings.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "broadmark/recordings/posrot.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

double volume(const Aabb& box) {
  double product = 1;
  for (int axis = 0; axis < 3; ++axis) product *= double{box.max[axis]} - double{box.min[axis]};
  return product;
}

/// The path of the recording of poses beside a recording of boxes.
fs::path posrotOf(const fs::path& aabbs) {
  return aabbs.parent_path().parent_path() / "Recordings_PositionRotation" /
         fs::path(aabbs.filename()).replace_extension(kPosrotExtension);
}

class Replays : public testing::Test {
 protected:
  /// Bakes a small scene as .aabbs and .posrot below `small_`. Returns the path of the .aabbs.
  fs::path bakeSmall(const std::string& type, const std::string& objects = "64",
                     const std::string& frames = "5", const std::string& scene = "brownian") {
    auto simulation = sceneWith(
        scene,
        {{"objects", objects}, {"frames", frames}, {"object_type", type}, {"density", "0.2"}},
        "kinematic");
    return bakeBoth(*simulation, small_);
  }

  static fs::path bakeBoth(Simulation& simulation, const fs::path& directory) {
    fs::path path = directory / "Recordings_AABBs" / recordingFileName(simulation.scene());
    fs::create_directories(path.parent_path());
    fs::create_directories(posrotOf(path).parent_path());
    bake(simulation, {path, posrotOf(path)});
    return path;
  }

  [[nodiscard]] std::unique_ptr<Simulation> replay(const std::string& engine,
                                                   ParameterValues values) const {
    values.insert({"input", small_.string()});
    return sceneWith("brownian", values, engine);
  }

  TemporaryDirectory directory_;
  fs::path small_ = directory_ / "small";
  fs::path out_ = directory_ / "out";
};

TEST_F(Replays, PosesGiveTheBoxesThatTheSimulationHad) {
  // Scenes with bodies in the sizes of their object type, initially unrotated.
  const std::set<std::string> usual_scenes = {"freefall", "brownian", "gravity"};
  for (const SceneListing& scene : builtinScenes()) {
    if (!fitsAabbs(makeSimulation(scene.id)->scene())) continue;
    for (const std::string type : {"cubes", "spheres", "assorted"}) {
      SCOPED_TRACE(scene.id + " " + type);
      const fs::path path = bakeSmall(type, "80", "12", scene.id);
      RecordingReader boxes(path);
      PosrotReader poses(posrotOf(path));
      EXPECT_EQ(poses.scene(), boxes.scene());
      const Frames recorded = allFrames(boxes);
      const Frames replayed = allFrames(poses);
      // Eight ulps of the farthest corner, for bodies of arbitrary sizes.
      const float uncertain = 8 * 0x1p-23F * 2 * boxes.scene().world.max[0];
      const bool usual = type != "assorted" && usual_scenes.contains(scene.id);
      // The initial boxes of bodies with an initial rotation are unrotated, so skip them.
      for (std::size_t f = usual_scenes.contains(scene.id) ? 0 : 1; f < recorded.size(); ++f) {
        for (std::size_t i = 0; i < recorded[f].size(); ++i) {
          if (!usual) {
            expectNear(replayed[f][i], recorded[f][i], uncertain);
          } else {
            ASSERT_EQ(replayed[f][i], recorded[f][i]) << "frame " << f << ", body " << i;
          }
        }
      }
    }
  }
}

TEST_F(Replays, ViewerBakesTheRecordingAnew) {
  for (const std::string type : {"cubes", "spheres"}) {
    const fs::path path = bakeSmall(type);
    auto viewer = replay("viewer", {{"objects", "64"}, {"object_type", type}});
    EXPECT_EQ(viewer->input(), posrotOf(path));
    const fs::path again = bakeBoth(*viewer, out_);
    EXPECT_EQ(bytesOf(again), bytesOf(path));
    EXPECT_EQ(bytesOf(posrotOf(again)), bytesOf(posrotOf(path)));
  }
}

TEST_F(Replays, ViewerTakesTheFramesAskedFor) {
  bakeSmall("cubes", "64", "9");
  const fs::path path = bakeSmall("cubes", "64", "5");
  bakeSmall("cubes", "72", "5");
  auto viewer = replay("viewer", {{"objects", "64"}, {"frames", "3"}});
  EXPECT_EQ(viewer->input(), posrotOf(path)) << "the shortest that is long enough";
  EXPECT_EQ(viewer->scene().frames, 3U);
  const Frames first = allFrames(*viewer);
  EXPECT_EQ(first.size(), 4U);
  EXPECT_EQ(allFrames(*viewer), first) << "from the start again";
  EXPECT_EQ(replay("viewer", {{"objects", "64"}})->scene().frames, 9U) << "all there are";
}

TEST_F(Replays, ViewerAcceptsBoxesWithoutPoses) {
  const fs::path path = bakeSmall("assorted");
  fs::remove(posrotOf(path));
  auto viewer = replay("viewer", {{"objects", "64"}, {"object_type", "assorted"}});
  fs::create_directories(out_);
  bake(*viewer, {out_ / path.filename()});
  EXPECT_EQ(bytesOf(out_ / path.filename()), bytesOf(path));
  EXPECT_THAT(inputErrorOf([&] { bake(*viewer, {out_ / "a.posrot"}); }),
              AllOf(HasSubstr(path.string()), HasSubstr("only boxes")));
}

TEST_F(Replays, TheInputMayBeAFile) {
  const fs::path path = bakeSmall("cubes");
  fs::rename(posrotOf(path), directory_ / "other name.posrot");
  auto viewer =
      replay("viewer", {{"objects", "64"}, {"input", (directory_ / "other name.posrot").string()}});
  EXPECT_EQ(allFrames(*viewer), allFrames(*openRecordingFile(path)));
}

TEST_F(Replays, SplitterStartsWithPartsThatTileTheDoubledBody) {
  for (const std::string type : {"cubes", "assorted"}) {
    const fs::path path = bakeSmall(type);
    auto splitter = replay("splitter", {{"objects", "512"}, {"object_type", type}});
    RecordingReader whole(path);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(splitter->scene().world.min[axis], 2 * whole.scene().world.min[axis]);
      EXPECT_EQ(splitter->scene().world.max[axis], 2 * whole.scene().world.max[axis]);
    }
    EXPECT_EQ(splitter->scene().objects, 512U);
    EXPECT_EQ(splitter->scene().frames, 5U);
    const Frame parts = splitter->rewind();
    ASSERT_EQ(parts.boxes.size(), 512U);
    const Frame bodies = whole.rewind();
    for (std::size_t i = 0; i < 64; ++i) {
      Aabb doubled = bodies.boxes[i];
      for (int axis = 0; axis < 3; ++axis) {
        doubled.min[axis] *= 2;
        doubled.max[axis] *= 2;
      }
      const auto eight = parts.boxes.subspan(8 * i, 8);
      Aabb hull = eight[0];
      double sum = 0;
      for (std::size_t a = 0; a < 8; ++a) {
        hull = merged(hull, eight[a]);
        sum += volume(eight[a]);
        for (std::size_t b = 0; b < a; ++b) {
          EXPECT_TRUE(overlaps(eight[a], eight[b])) << "all eight meet in the middle";
          // Closed boxes that only touch: their interiors are disjoint on some axis.
          bool apart = false;
          for (int axis = 0; axis < 3; ++axis) {
            apart |= eight[a].max[axis] == eight[b].min[axis] ||
                     eight[b].max[axis] == eight[a].min[axis];
          }
          EXPECT_TRUE(apart);
        }
      }
      EXPECT_EQ(hull, doubled);
      EXPECT_NEAR(sum, volume(doubled), 1e-5 * volume(doubled));
    }
  }
}

TEST_F(Replays, SplitterMovesThePartsAsTheBodyMoves) {
  for (const std::string type : {"cubes", "spheres", "assorted"}) {
    const fs::path path = bakeSmall(type);
    auto splitter = replay("splitter", {{"objects", "512"}, {"object_type", type}});
    PosrotReader whole(posrotOf(path));
    const float tolerance = 16 * 0x1p-23F * splitter->scene().world.max[0];
    splitter->rewind();
    whole.rewind();
    while (const auto bodies = whole.next()) {
      const auto parts = splitter->next();
      ASSERT_TRUE(parts);
      const std::span<const Pose> poses = splitter->poses();
      ASSERT_EQ(poses.size(), 512U);
      for (std::size_t i = 0; i < 64; ++i) {
        const Pose& pose = whole.poses()[i];
        Vec3 middle{};
        Aabb hull = parts->boxes[8 * i];
        for (std::size_t part = 8 * i; part < 8 * i + 8; ++part) {
          EXPECT_EQ(poses[part].rotation, pose.rotation);
          for (int axis = 0; axis < 3; ++axis) {
            middle[axis] += poses[part].position[axis] / 8;
          }
          // A part has the size of the original body.
          const Vec3 half = whole.extents(i, pose.rotation);
          EXPECT_EQ(parts->boxes[part], boxAround(poses[part].position, half));
          hull = merged(hull, parts->boxes[part]);
        }
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_NEAR(middle[axis], 2 * pose.position[axis], tolerance);
        }
        if (type == "spheres") continue;  // parts rotate about the middle, a ball does not
        Aabb doubled = boxAround({}, whole.extents(i, pose.rotation));
        for (int axis = 0; axis < 3; ++axis) {
          doubled.min[axis] = 2 * (doubled.min[axis] + pose.position[axis]);
          doubled.max[axis] = 2 * (doubled.max[axis] + pose.position[axis]);
        }
        expectNear(hull, doubled, tolerance);
      }
    }
    EXPECT_FALSE(splitter->next());
  }
}

// Parts of a rotated body: the first pair shares a face, so their boxes overlap in every frame.
TEST_F(Replays, PartsOfOneBodyStayTogether) {
  bakeSmall("cubes");
  auto splitter = replay("splitter", {{"objects", "512"}});
  for (const std::vector<Aabb>& boxes : allFrames(*splitter)) {
    for (std::size_t i = 0; i < boxes.size(); i += 8) {
      for (std::size_t a = i; a < i + 8; ++a) {
        for (std::size_t b = i; b < a; ++b) {
          EXPECT_TRUE(overlaps(enlarged(boxes[a], 1e-5F), enlarged(boxes[b], 1e-5F)));
        }
      }
    }
  }
}

TEST_F(Replays, SplitterCanBeChained) {
  bakeSmall("cubes");
  auto once = replay("splitter", {{"objects", "512"}});
  const fs::path eightfold = bakeBoth(*once, small_);
  EXPECT_EQ(allFrames(*openRecordingFile(posrotOf(eightfold))),
            allFrames(*openRecordingFile(eightfold)))
      << "what the splitter records is what it shows";

  auto twice = replay("splitter", {{"objects", "4096"}});
  EXPECT_EQ(twice->input(), posrotOf(eightfold));
  EXPECT_EQ(
      twice->scene().world.max[0],
      4 * sceneWith("brownian", {{"objects", "64"}, {"density", "0.2"}})->scene().world.max[0]);
  const Frames frames = allFrames(*twice);
  ASSERT_EQ(frames.size(), 6U);
  RecordingReader parents(eightfold);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    ASSERT_EQ(frames[f].size(), 4096U);
    const Frame bodies = parents.at(static_cast<std::uint32_t>(f));
    for (std::size_t i = 0; i < 512; ++i) {
      Point middle{};
      for (std::size_t part = 8 * i; part < 8 * i + 8; ++part) {
        ASSERT_NEAR(volume(frames[f][part]), volume(bodies.boxes[i]), 1e-3);
        for (int axis = 0; axis < 3; ++axis) middle[axis] += centreOf(frames[f][part])[axis] / 8;
      }
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(middle[axis], 2 * centreOf(bodies.boxes[i])[axis], 1e-4);
      }
    }
  }
}

TEST_F(Replays, AreRecognisedByTheContentsOfTheirInput) {
  bakeSmall("cubes");
  const ParameterValues values = {{"objects", "512"}, {"frames", "4"}};
  auto splitter = replay("splitter", values);
  const fs::path path = bakeBoth(*splitter, out_);
  const auto sidecar = nlohmann::json::parse(bytesOf(fs::path(path).replace_extension(".json")));
  EXPECT_EQ(sidecar.at("scene"), "brownian");
  EXPECT_EQ(sidecar.at("parameters").at("engine"), "splitter");
  EXPECT_FALSE(sidecar.at("parameters").contains("input")) << "the path does not matter";
  EXPECT_EQ(sidecar.at("input_hash"), openRecordingFile(splitter->input())->hash());
  EXPECT_TRUE(isBaked(path, *replay("splitter", values)));
  EXPECT_TRUE(isBaked(posrotOf(path), *replay("splitter", values)));
  EXPECT_FALSE(isBaked(path, *replay("splitter", {{"objects", "512"}, {"frames", "5"}})));

  fs::rename(small_, directory_ / "moved");
  EXPECT_FALSE(isBaked(path, *replay("splitter", values))) << "no input";
  fs::rename(directory_ / "moved", small_);
  EXPECT_TRUE(isBaked(path, *replay("splitter", values)));
  auto other =
      sceneWith("brownian", {{"objects", "64"}, {"frames", "5"}, {"seed", "9"}}, "kinematic");
  bakeBoth(*other, small_);
  EXPECT_FALSE(isBaked(path, *replay("splitter", values))) << "another input";
}

TEST_F(Replays, RefusalsListTheRecordingsThatExist) {
  bakeSmall("cubes", "64", "5");
  bakeSmall("cubes", "80", "7");
  const auto refusal = [&](const std::string& engine, const ParameterValues& values) {
    return inputErrorOf([&] { (void)replay(engine, values)->scene(); });
  };
  EXPECT_THAT(refusal("viewer", {{"objects", "65"}}),
              AllOf(HasSubstr("Brownian Cubes N65"), HasSubstr("N64 F5, N80 F7")));
  EXPECT_THAT(refusal("viewer", {{"objects", "64"}, {"frames", "6"}}),
              AllOf(HasSubstr("at least 6 frames"), HasSubstr("N64 F5")));
  EXPECT_THAT(refusal("viewer", {{"objects", "64"}, {"object_type", "spheres"}}),
              HasSubstr("none of Brownian Spheres"));
  EXPECT_THAT(refusal("splitter", {{"objects", "513"}}),
              AllOf(HasSubstr("multiple of 8"), HasSubstr("N64 F5 (gives 512 bodies)"),
                    HasSubstr("N80 F7 (gives 640 bodies)")));
  EXPECT_THAT(refusal("splitter", {{"objects", "800"}}), HasSubstr("gives 512"));
  EXPECT_THAT(refusal("viewer", {{"input", ""}}), HasSubstr("--input"));
  EXPECT_THAT(refusal("viewer", {{"input", (directory_ / "none").string()}}),
              HasSubstr("No such file"));
  const fs::path aabbs = small_ / "Recordings_AABBs" / "Brownian Cubes N64 F5frames.aabbs";
  EXPECT_THAT(refusal("splitter", {{"objects", "512"}, {"input", aabbs.string()}}),
              AllOf(HasSubstr(aabbs.string()), HasSubstr("reads .posrot")));
  EXPECT_THAT(refusal("viewer", {{"objects", "63"}, {"input", aabbs.string()}}),
              AllOf(HasSubstr("contains Brownian Cubes N64 F5"), HasSubstr("N63")));
  EXPECT_THAT(inputErrorOf([&] { (void)replay("viewer", {{"seed", "3"}}); }),
              HasSubstr("unknown parameter 'seed'"));
  EXPECT_THAT(inputErrorOf([&] { makeSimulation("brownian", "viewr"); }),
              HasSubstr("did you mean 'viewer'"));
}

TEST_F(Replays, ABrokenOrRenamedInputIsRefused) {
  const fs::path path = posrotOf(bakeSmall("cubes"));
  fs::copy_file(path, small_ / "Brownian Cubes N72 F5frames.posrot");
  EXPECT_THAT(inputErrorOf([&] { (void)replay("viewer", {{"objects", "72"}})->scene(); }),
              AllOf(HasSubstr("N72 F5frames.posrot"), HasSubstr("contains Brownian Cubes N64")));
  fs::resize_file(path, 1000);
  EXPECT_THAT(inputErrorOf([&] { (void)replay("viewer", {{"objects", "64"}})->scene(); }),
              AllOf(HasSubstr(path.string()), HasSubstr("too short")));
}

TEST_F(Replays, NothingIsWrittenOverTheInput) {
  const fs::path path = posrotOf(bakeSmall("cubes"));
  const std::string sidecar = bytesOf(fs::path(path).replace_extension(".json"));
  auto viewer = replay("viewer", {{"objects", "64"}});
  EXPECT_THAT(inputErrorOf([&] { bake(*viewer, {path}); }), HasSubstr("another folder"));
  EXPECT_EQ(bytesOf(fs::path(path).replace_extension(".json")), sidecar);
}

}  // namespace
}  // namespace broadmark::tests
