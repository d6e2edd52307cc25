// Simulations in processes: the same frames, and an end at any time.
#include "request/simulation_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "broadmark/error.h"
#include "broadmark/plugin.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/registry.h"
#include "inspector/helpers.h"
#include "scenes/scene_runs.h"
#include "support/places.h"

extern "C" {
extern const broadmark::Plugin<broadmark::scenes::EngineEntry> broadmark_engine_plugin;
}

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

const SimulationHost& processes() {
  static const SimulationHost host = simulateInProcesses(places::program());
  return host;
}

/// FreeFall by the engine that fails in the second frame, which both processes have.
std::unique_ptr<Simulation> unruly(const std::string& deed) {
  for (scenes::EngineEntry& entry : broadmark_engine_plugin.entries()) {
    entry.listing.plugin = places::unrulyEngine();
    const auto known = availableEngines();
    if (std::ranges::find(known, entry.listing.id, &EngineListing::id) == known.end()) {
      scenes::addEngine(std::move(entry));
    }
  }
  return sceneWith("freefall", {{"objects", "20"}, {"engine_deed", deed}}, "unruly");
}

scenes::AuthoredScene authored() {
  scenes::AuthoredScene scene{.name = "Three", .bodies = {}};
  scene.bodies.resize(3);
  scene.bodies[1].pose.position = {0, 4, 0};
  scene.bodies[1].shape = scenes::SphereShape{1};
  scene.bodies[2].pose.position = {3, 4, 0};
  scene.bodies[2].linear_velocity = {1e5F, 0, 0};  // it escapes
  scene.bodies[2].appears = 2;
  scene.parameters = {{"frames", "5"}};
  return scene;
}

std::vector<std::unique_ptr<Simulation>> simulations() {
  std::vector<std::unique_ptr<Simulation>> all;
  for (const SceneListing& scene : builtinScenes()) {
    all.push_back(sceneWith(scene.id, {{"objects", "60"}, {"frames", "12"}}));
  }
  all.push_back(scenes::makeAuthoredSimulation(authored()));
  return all;
}

TEST(SimulationProcess, HasTheFramesOfTheSimulation) {
  std::vector<std::unique_ptr<Simulation>> hosted = simulations();
  std::size_t number = 0;
  for (const auto& here : simulations()) {
    const auto there = processes()(std::move(hosted[number++]), {});
    SCOPED_TRACE(here->listing().id);
    EXPECT_EQ(there->scene(), here->scene());
    Frame expected = here->rewind();
    Frame frame = there->rewind();
    EXPECT_TRUE(std::ranges::equal(here->unrotatedBoxes(), there->unrotatedBoxes()));
    while (true) {
      EXPECT_EQ(boxesOf(frame), boxesOf(expected));
      EXPECT_TRUE(std::ranges::equal(*frame.changed, *expected.changed));
      EXPECT_TRUE(std::ranges::equal(frame.filter_changed, expected.filter_changed));
      EXPECT_EQ(frame.filterIn(there->scene()), expected.filterIn(here->scene()));
      EXPECT_TRUE(std::ranges::equal(there->poses(), here->poses()));
      EXPECT_EQ(escapeTexts(*there), escapeTexts(*here));
      const auto next = here->next();
      const auto next_there = there->next();
      ASSERT_EQ(next.has_value(), next_there.has_value());
      if (!next) break;
      expected = *next;
      frame = *next_there;
    }
  }
}

TEST(SimulationProcess, ItsFramesBecomeScenes) {
  const auto here = scenes::makeAuthoredSimulation(authored());
  const auto there = processes()(scenes::makeAuthoredSimulation(authored()), {});
  EXPECT_EQ(scenes::sceneFromFrame(*there, 3), scenes::sceneFromFrame(*here, 3));
  EXPECT_FALSE(there->escapes().empty());
}

TEST(SimulationProcess, ACrashOrAnExceptionIsAnError) {
  for (const auto& [deed, error] : std::initializer_list<std::pair<std::string, std::string>>{
           {"die", "frame 2: engine 'unruly' crashed with SIGSEGV"},
           {"abort", "frame 2: engine 'unruly' crashed with SIGABRT"},
           {"throw", "thrown on purpose"}}) {
    const auto there = processes()(unruly(deed), {});
    there->rewind();
    ASSERT_TRUE(there->next());
    for (const int time : {1, 2}) {  // there are no further frames
      try {
        there->next();
        ADD_FAILURE() << deed << time;
      } catch (const InputError& failure) {
        EXPECT_THAT(failure.what(), HasSubstr(error));
      }
    }
    there->rewind();
    EXPECT_EQ(there->next()->index, 1U);
  }
}

TEST(SimulationProcess, AHangEndsWhenCancelled) {
  std::atomic<bool> hangs = false;
  std::atomic<int> polls = 0;
  const auto there = processes()(unruly("hang"), [&] { return hangs && ++polls > 5; });
  there->rewind();
  there->next();
  hangs = true;
  EXPECT_THROW(there->next(), Cancelled);
}

/// The session is at a frame that never comes.
class HangingSession : public testing::Test {
 protected:
  HangingSession() {
    session.draft.adopt(unruly("hang"));
    session.draft.simulate();
    session.playback.seek(2);
    session.postRequest();
    while (activity().find("simulating frame 2 of 20 bodies") == std::string::npos) {
      std::this_thread::yield();
    }
  }

  std::string activity() {
    std::string text;
    session.runs.readProgress([&](const RunProgress& progress) { text = progress.activity; });
    return text;
  }

  Session session{builtinAlgorithms(), makeInProcessExecutor, processes()};
};

TEST_F(HangingSession, IsClosed) {}

TEST_F(HangingSession, ShowsAnotherScene) {
  session.draft.choose("brownian");
  setParameters(session.draft.scene(), {{"engine", "kinematic"}, {"objects", "30"}});
  session.draft.simulate();
  session.postRequest();
  session.runs.readProgress([](const RunProgress& progress) {
    EXPECT_FALSE(progress.snapshot) << "of the former scene";
    EXPECT_EQ(progress.source, nullptr);
  });
  EXPECT_EQ(waitUntilIdle(session).scene.objects, 30U);
}

TEST_F(HangingSession, SaysWhatItWaitsFor) {
  std::string waits;
  session.runs.readProgress([&](const RunProgress& progress) {
    session.advance(progress, 0.4);
    EXPECT_EQ(session.waitsFor(progress), "");
    session.advance(progress, 0.4);
    waits = session.waitsFor(progress);
  });
  EXPECT_THAT(waits, HasSubstr("simulating frame 2 of 20 bodies"));
}

TEST_F(HangingSession, ItsFrameBecomesNoSceneUntilCancelled) {
  session.document.loadCurrentFrame();
  session.postRequest();
  session.draft.adopt(unruly("none"));
  session.draft.simulate();
  EXPECT_EQ(waitUntilIdle(session).scene.objects, 20U);
}

TEST_F(HangingSession, CancelsABake) {
  const TemporaryDirectory directory;
  auto& bake = session.jobs.get<BackgroundBake>();
  startBake(bake, unruly("hang"), directory / "hang.aabbs", session.jobs.host);
  bake.cancel();
  bake.wait();
  EXPECT_EQ(bake.report().state, TaskState::cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(directory / ""));
}

}  // namespace
}  // namespace broadmark::tests
