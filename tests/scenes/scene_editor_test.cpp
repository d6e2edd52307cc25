// Editing with undo and redo: undo restores the scene exactly, after any edits.

#include "broadmark/scenes/scene_editor.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "broadmark/error.h"
#include "engine/helpers.h"

namespace broadmark::scenes {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<AuthoredBody> row(std::size_t count) {
  std::vector<AuthoredBody> bodies(count);
  for (std::size_t i = 0; i < count; ++i) {
    bodies[i].pose.position = {static_cast<float>(2 * i), 0, 0};
  }
  return bodies;
}

/// The x of every body.
std::vector<float> places(const SceneEditor& editor) {
  std::vector<float> places;
  for (const AuthoredBody& body : editor.scene().bodies) places.push_back(body.pose.position[0]);
  return places;
}

TEST(SceneEditor, DeletingAndBringingBackKeepsOrderAndSelection) {
  SceneEditor editor;
  editor.add(row(5));
  EXPECT_THAT(editor.selection(), ElementsAre(0, 1, 2, 3, 4));
  editor.select({3, 1, 1});
  editor.erase();
  EXPECT_THAT(places(editor), ElementsAre(0, 4, 8));
  EXPECT_THAT(editor.selection(), IsEmpty());
  editor.undo();
  EXPECT_THAT(places(editor), ElementsAre(0, 2, 4, 6, 8));
  EXPECT_THAT(editor.selection(), ElementsAre(1, 3));
  editor.redo();
  EXPECT_THAT(places(editor), ElementsAre(0, 4, 8));
  editor.undo();
  editor.undo();
  EXPECT_THAT(places(editor), IsEmpty());
  EXPECT_THAT(editor.selection(), IsEmpty());
  EXPECT_FALSE(editor.canUndo());
  EXPECT_EQ(editor.redoName(), "add 5 bodies");
}

TEST(SceneEditor, EditsActOnTheSelectionAlone) {
  SceneEditor editor;
  editor.add(row(3));
  editor.select({1});
  editor.move({0.5F, 1, 0});
  editor.set("weigh", &AuthoredBody::mass, 4);
  editor.set("freeze", &AuthoredBody::frozen, true);
  editor.set("layer", &AuthoredBody::layer, 7);
  editor.set("end", &AuthoredBody::vanishes, 9);
  editor.set("begin", &AuthoredBody::appears, 8);
  editor.set("push", &AuthoredBody::linear_velocity, {1, 2, 3});
  editor.set("spin", &AuthoredBody::angular_velocity, {4, 5, 6});
  editor.makeSpheres();
  editor.setSize({3, 9, 9});
  const AuthoredBody& body = editor.scene().bodies[1];
  EXPECT_EQ(body.pose.position, (Vec3{2.5F, 1, 0}));
  EXPECT_EQ(body.mass, 4);
  EXPECT_TRUE(body.frozen);
  EXPECT_EQ(body.layer, 7);
  EXPECT_EQ(body.appears, 8U);
  EXPECT_EQ(body.vanishes, 9U);
  EXPECT_EQ(body.linear_velocity, (Vec3{1, 2, 3}));
  EXPECT_EQ(body.angular_velocity, (Vec3{4, 5, 6}));
  EXPECT_EQ(body.shape, Shape(SphereShape{1.5F}));
  EXPECT_EQ(editor.scene().bodies[0], row(3)[0]);
  EXPECT_EQ(editor.scene().bodies[2], row(3)[2]);
  editor.makeBoxes();
  EXPECT_EQ(editor.scene().bodies[1].shape, Shape(BoxShape{{1.5F, 1.5F, 1.5F}}));
}

TEST(SceneEditor, ScalesAndTurnsAboutTheCommonCentre) {
  SceneEditor editor;
  editor.add(row(3));
  editor.scale(2);
  EXPECT_THAT(places(editor), ElementsAre(-2, 2, 6));
  EXPECT_EQ(editor.scene().bodies[0].shape, Shape(BoxShape{{1, 1, 1}}));
  EXPECT_EQ(editor.undoName(), "scale 3 bodies");
  editor.undo();
  EXPECT_EQ(editor.scene().bodies, row(3));
  const float half = std::sqrt(0.5F);
  editor.transform("turn", {.centre = editor.selectionCentre(),
                            .turn = {0, half, 0, half}});  // a quarter about y: x goes to -z
  EXPECT_NEAR(editor.scene().bodies[0].pose.position[2], 2, 1e-5);
  EXPECT_NEAR(editor.scene().bodies[2].pose.position[2], -2, 1e-5);
}

TEST(SceneEditor, AlignsByTightBoxes) {
  using Alignment = SceneEditor::Alignment;
  SceneEditor editor;
  std::vector<AuthoredBody> bodies = row(2);  // cubes of edge 1…
  bodies[1].shape = SphereShape{1};           // …and a sphere of diameter 2
  bodies[1].pose.position = {5, 3, 0};
  editor.add(bodies);
  editor.align(0, Alignment::low);
  EXPECT_THAT(places(editor), ElementsAre(0, 0.5));
  editor.align(0, Alignment::high);
  EXPECT_THAT(places(editor), ElementsAre(1, 0.5));
  editor.align(0, Alignment::middle);
  EXPECT_THAT(places(editor), ElementsAre(0.5, 0.5));
  EXPECT_EQ(editor.scene().bodies[1].pose.position[1], 3) << "along one axis only";
  EXPECT_EQ(editor.undoName(), "align 2 bodies");
}

TEST(SceneEditor, DuplicatesAreSelected) {
  SceneEditor editor;
  editor.add(row(2));
  editor.select({1});
  editor.duplicate({10, 0, 0});
  EXPECT_THAT(places(editor), ElementsAre(0, 2, 12));
  EXPECT_THAT(editor.selection(), ElementsAre(2));
  editor.undo();
  EXPECT_THAT(editor.selection(), ElementsAre(1));
}

/// The group of every body.
std::vector<std::uint32_t> groups(const SceneEditor& editor) {
  std::vector<std::uint32_t> groups;
  for (const AuthoredBody& body : editor.scene().bodies) groups.push_back(body.group);
  return groups;
}

TEST(SceneEditor, GroupsAreSelectedTogether) {
  SceneEditor editor;
  editor.add(row(6));
  editor.select({1, 4});
  editor.group();
  EXPECT_EQ(editor.undoName(), "group 2 bodies");
  editor.select({2, 3, 5});
  editor.group();
  EXPECT_THAT(groups(editor), ElementsAre(0, 1, 2, 2, 1, 2));
  EXPECT_THAT(editor.withGroups({4}), ElementsAre(1, 4));
  EXPECT_THAT(editor.withGroups({5, 0}), ElementsAre(0, 2, 3, 5));
  EXPECT_THAT(editor.withGroups({0}), ElementsAre(0));
  EXPECT_THAT(editor.withGroups({99}), ElementsAre(99)) << "it is only just to be added";
  // A body that joins a group leaves its former one.
  editor.select({3, 0});
  editor.group();
  EXPECT_THAT(groups(editor), ElementsAre(3, 1, 2, 3, 1, 2));
  editor.select({1, 4});
  editor.ungroup();
  EXPECT_EQ(editor.undoName(), "ungroup 2 bodies");
  EXPECT_THAT(groups(editor), ElementsAre(3, 0, 2, 3, 0, 2));
  editor.group();
  EXPECT_THAT(groups(editor), ElementsAre(3, 1, 2, 3, 1, 2)) << "the least free number";
  for (int i = 0; i < 5; ++i) editor.undo();
  EXPECT_THAT(groups(editor), ElementsAre(0, 0, 0, 0, 0, 0));
}

TEST(SceneEditor, OneBodyIsNoGroup) {
  SceneEditor editor;
  editor.add(row(2));
  editor.select({1});
  editor.group();
  editor.select({});
  editor.group();
  EXPECT_EQ(editor.undoName(), "add 2 bodies");
}

TEST(SceneEditor, CopiesOfAGroupAreAGroupOfTheirOwn) {
  SceneEditor editor;
  editor.add(row(5));
  editor.select({0, 1});
  editor.group();
  editor.select({2, 3});
  editor.group();
  editor.selectAll();
  editor.duplicate({0, 1, 0});
  EXPECT_THAT(groups(editor), ElementsAre(1, 1, 2, 2, 0, 3, 3, 4, 4, 0));
  editor.undo();
  EXPECT_THAT(groups(editor), ElementsAre(1, 1, 2, 2, 0));
}

TEST(SceneEditor, AnEditWithoutEffectIsNotAStep) {
  SceneEditor editor;
  editor.move({1, 0, 0});
  editor.erase();
  editor.duplicate({1, 0, 0});
  editor.add({});
  editor.setName("Untitled");
  editor.setParameters({});
  editor.undo();
  editor.redo();
  EXPECT_FALSE(editor.canUndo());
  editor.add(row(1));
  editor.set("weigh", &AuthoredBody::mass, 1);
  editor.move({});
  EXPECT_EQ(editor.undoName(), "add 1 body");
}

TEST(SceneEditor, ARefusedEditChangesNothing) {
  SceneEditor editor;
  editor.add(row(3));
  const AuthoredScene before = editor.scene();
  const auto refuses = [&](auto&& edit, const std::string& word) {
    EXPECT_THAT(tests::inputErrorOf(edit), HasSubstr(word));
    EXPECT_EQ(editor.scene(), before) << word;
    EXPECT_EQ(editor.undoName(), "add 3 bodies");
  };
  refuses([&] { editor.set("weigh", &AuthoredBody::mass, 0); }, "mass");
  refuses([&] { editor.set("layer", &AuthoredBody::layer, 32); }, "layer");
  refuses([&] { editor.set("end", &AuthoredBody::vanishes, 0); }, "vanishes");
  refuses([&] { editor.setSize({1, 0, 1}); }, "size");
  refuses([&] { editor.scale(0); }, "size");
  refuses([&] { editor.scale(std::nanf("")); }, "body 0");
  refuses([&] { editor.move({3e9F, 0, 0}); }, "position");
  refuses([&] { editor.set("push", &AuthoredBody::linear_velocity, {0, INFINITY, 0}); },
          "velocity");
  refuses([&] { editor.transform("turn", {.turn = {0, 0, 0, 0}}); }, "rotation");
  refuses([&] { editor.setName("a/b"); }, "name");
  refuses([&] { editor.setWorld({}); }, "world");
  refuses([&] { editor.setParameters({{"objects", "3"}}); }, "objects");
  refuses([&] { editor.setParameters({{"frames", "0"}}); }, "frames");
  refuses([&] { editor.select({3}); }, "no body 3");
  refuses([&] { editor.add({AuthoredBody{.mass = -1}}); }, "body 3: mass");
  refuses([&] { editor.add({AuthoredBody{.group = 10'000'001}}); }, "body 3: group");
}

TEST(SceneEditor, ParametersOfAnotherEngineAreDropped) {
  SceneEditor editor;
  editor.setParameters({{"engine", "boids"}, {"sight", "5"}, {"frames", "0070"}});
  EXPECT_EQ(editor.scene().parameters,
            (ParameterValues{{"engine", "boids"}, {"frames", "70"}, {"sight", "5"}}));
  editor.setParameters({{"engine", "kinematic"}});
  EXPECT_EQ(editor.scene().parameters,
            (ParameterValues{{"engine", "kinematic"}, {"frames", "70"}}));
  editor.undo();
  EXPECT_EQ(editor.scene().parameters.at("sight"), "5");
}

TEST(SceneEditor, KnowsWhetherItIsSaved) {
  SceneEditor editor;
  EXPECT_FALSE(editor.isModified());
  editor.add(row(2));
  editor.markSaved();
  editor.move({1, 0, 0});
  EXPECT_TRUE(editor.isModified());
  editor.undo();
  EXPECT_FALSE(editor.isModified());
  editor.undo();
  EXPECT_TRUE(editor.isModified());
  editor.setName("Other");
  EXPECT_TRUE(editor.isModified()) << "as many steps as when it was saved, but other ones";
}

TEST(SceneEditor, TheHistoryIsBoundedButKeepsTheLatestStep) {
  constexpr std::size_t kBound = 100'000;
  SceneEditor editor({}, kBound);
  editor.add(row(500));
  for (int i = 0; i < 100; ++i) {
    editor.move({1, 0, 0});
    EXPECT_LE(editor.historyBytes(), kBound);
  }
  editor.add(row(5000));
  EXPECT_EQ(editor.undoName(), "add 5000 bodies");
  editor.undo();
  EXPECT_FALSE(editor.canUndo());
  EXPECT_EQ(editor.scene().bodies.size(), 500U);
  EXPECT_TRUE(editor.isModified());
}

/// Random edits, some of them invalid.
class Monkey {
 public:
  explicit Monkey(unsigned seed) : random_(seed) {}

  void edit(SceneEditor& editor) {
    try {
      chooseBodies(editor);
      editOnce(editor);
    } catch (const InputError&) {
    }
  }

 private:
  unsigned any(unsigned count) { return static_cast<unsigned>(random_() % count); }
  float number() { return static_cast<float>(any(2001)) / 100 - 10; }
  Vec3 vector() { return {number(), number(), number()}; }

  void chooseBodies(SceneEditor& editor) {
    const std::size_t count = editor.scene().bodies.size();
    if (any(3) != 0 || count == 0) return;
    BodyIds ids;
    for (unsigned i = any(12); i > 0; --i) ids.push_back(any(static_cast<unsigned>(count)));
    editor.select(ids);
    if (any(10) == 0) editor.selectAll();
  }

  void editOnce(SceneEditor& editor) {
    const std::size_t count = editor.scene().bodies.size();
    switch (any(20)) {
      case 0:
      case 1:
        return editor.add(std::vector<AuthoredBody>(any(6), AuthoredBody{.mass = 1.0 + any(5)}));
      case 2:
        return editor.erase();
      case 3:
        return count < 200 ? editor.duplicate(vector()) : editor.erase();
      case 4:
        return editor.transform("turn",
                                {.centre = editor.selectionCentre(), .turn = {0, 0.6F, 0, 0.8F}});
      case 5:
        return editor.scale(number());
      case 6:
        return editor.setSize({number(), 1, 2});
      case 7:
        return any(2) == 0 ? editor.makeBoxes() : editor.makeSpheres();
      case 8:
        return editor.set("weigh", &AuthoredBody::mass, number());
      case 9:
        return editor.set("freeze", &AuthoredBody::frozen, any(2) == 0);
      case 10:
        return editor.set("push", &AuthoredBody::linear_velocity, vector());
      case 11:
        return editor.set("spin", &AuthoredBody::angular_velocity, vector());
      case 12:
        return editor.setName(std::string(any(3), 'x'));
      case 13:
        return editor.setWorld({{number(), -20, -20, 0}, {number(), 20, 20, 0}});
      case 14:
        return editor.setParameters(
            {{"frames", std::to_string(any(5))}, {"engine", any(2) == 0 ? "kinematic" : "boids"}});
      case 15:
        return editor.set("layer", &AuthoredBody::layer, static_cast<std::uint8_t>(any(33)));
      case 16:
        return editor.set("begin", &AuthoredBody::appears, any(5));
      case 17:
        return editor.set("end", &AuthoredBody::vanishes, any(2) == 0 ? kNever : any(5));
      case 18:
        return any(2) == 0 ? editor.group() : editor.ungroup();
      default:
        return editor.move(vector());
    }
  }

  std::mt19937 random_;
};

struct State {
  AuthoredScene scene;
  BodyIds selection;
  std::uint64_t revision;
};

State stateOf(const SceneEditor& editor) {
  return {editor.scene(), editor.selection(), editor.revision()};
}

TEST(SceneEditor, AnySequenceIsUndoneAndRedoneExactly) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SceneEditor editor;
    Monkey monkey(seed);
    const AuthoredScene first = editor.scene();
    for (int i = 0; i < 150; ++i) {
      monkey.edit(editor);
      if (i % 29 == 0) editor.undo();
      if (i % 31 == 0) editor.redo();
    }
    const AuthoredScene last = editor.scene();
    const bool could_redo = editor.canRedo();  // false after an edit since the last undo
    std::vector<State> states;
    while (editor.canUndo()) {
      states.push_back(stateOf(editor));
      editor.undo();
      ASSERT_TRUE(editor.selection().empty() ||
                  editor.selection().back() < editor.scene().bodies.size());
    }
    ASSERT_EQ(editor.scene(), first) << seed;
    ASSERT_FALSE(editor.isModified());
    ASSERT_GT(states.size(), 20U);
    while (!states.empty()) {
      editor.redo();
      ASSERT_EQ(editor.scene(), states.back().scene) << seed;
      ASSERT_EQ(editor.revision(), states.back().revision) << seed;
      states.pop_back();
    }
    ASSERT_EQ(editor.scene(), last) << seed;
    ASSERT_EQ(editor.canRedo(), could_redo);
  }
}

TEST(SceneEditor, ASelectionIsThatBeforeAndAfterItsStep) {
  for (unsigned seed = 100; seed < 120; ++seed) {
    SceneEditor editor;
    Monkey monkey(seed);
    for (int i = 0; i < 50; ++i) {
      const State before = stateOf(editor);
      monkey.edit(editor);
      if (editor.revision() == before.revision) continue;
      const State after = stateOf(editor);
      editor.undo();
      ASSERT_EQ(editor.scene(), before.scene);
      ASSERT_EQ(editor.revision(), before.revision);
      editor.redo();
      ASSERT_EQ(editor.scene(), after.scene);
      ASSERT_EQ(editor.selection(), after.selection);
    }
  }
}

}  // namespace
}  // namespace broadmark::scenes
