// The program in a real window under Xvfb, with mouse and keyboard input from xdotool. A script in
// the program asserts the effects.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

/// A private X server without a physical screen.
class Screen {
 public:
  Screen() {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      const int quiet = ::open("/dev/null", O_WRONLY);
      ::dup2(quiet, 2);
      ::execlp("Xvfb", "Xvfb", "-displayfd", std::to_string(ends[1]).c_str(), "-screen", "0",
               "1280x800x24", "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
      ::_exit(127);
    }
    ::close(ends[1]);
    char digit = 0;
    while (::read(ends[0], &digit, 1) == 1 && digit != '\n') name_ += digit;
    ::close(ends[0]);
    if (!name_.empty()) name_ = ":" + name_;
  }
  ~Screen() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// The display's name; "" if the server could not be started.
  [[nodiscard]] const std::string& name() const { return name_; }

  void tool(const std::string& arguments) const {
    const std::string command = "DISPLAY=" + name_ + " xdotool " + arguments;
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }

 private:
  pid_t pid_ = -1;
  std::string name_;
};

class WindowTest : public EndToEnd {
 protected:
  /// Writes scene.json, a scene of one body.
  void writeScene() const {
    writeFile(file("scene.json"), R"({
"schema": "broadmark-scene/1",
"name": "Hands",
"world": {"min": [-10, -10, -10], "max": [10, 10, 10]},
"bodies": [{"box": [4, 4, 4], "position": [0, 0, 0]}]
})");
  }

  void start(const Screen& screen, const Arguments& arguments) {
    program_.emplace(
        directory_, arguments,
        ProgramEnvironment{.environment = {{"DISPLAY", screen.name()},
                                           {"XDG_CONFIG_HOME", file("config").string()},
                                           {"XDG_STATE_HOME", file("state").string()}}});
  }

  /// Waits for the script's file of widget positions, and returns the middle of a widget.
  std::pair<int, int> middleOf(const std::string& places, const std::string& widget) {
    if (!program_->waitUntil([&] { return fs::exists(file(places)); })) {
      ADD_FAILURE() << places << " does not come";
      return {0, 0};
    }
    for (const std::string& line : linesOf(readFile(file(places)))) {
      std::istringstream fields(line);
      int left = 0;
      int top = 0;
      int right = 0;
      int bottom = 0;
      fields >> left >> top >> right >> bottom >> std::ws;
      std::string name;
      std::getline(fields, name);
      if (name == widget) return {(left + right) / 2, (top + bottom) / 2};
    }
    ADD_FAILURE() << places << ": no widget " << widget;
    return {0, 0};
  }

  void click(const Screen& screen, const std::string& places, const std::string& widget) {
    const auto [x, y] = middleOf(places, widget);
    moveTo(screen, x, y);
    screen.tool("click 1");
  }

  /// Drags with the left button, in several steps, as a user does.
  void drag(const Screen& screen, const std::string& places, const std::string& widget, int right,
            int down) {
    constexpr int kSteps = 5;
    const auto [x, y] = middleOf(places, widget);
    moveTo(screen, x, y);
    screen.tool("mousedown 1");
    for (int step = 1; step <= kSteps; ++step) {
      moveTo(screen, x + right * step / kSteps, y + down * step / kSteps);
    }
    screen.tool("mouseup 1");
  }

  static void moveTo(const Screen& screen, int x, int y) {
    screen.tool("mousemove " + std::to_string(x) + " " + std::to_string(y));
  }
  static void press(const Screen& screen, const std::string& keys) {
    screen.tool("key --delay 60 " + keys);
  }

  std::optional<Program> program_;
};

TEST_F(WindowTest, OpenPlayPickChangeTypeSaveClose) {
  const Screen screen;
  ASSERT_FALSE(screen.name().empty()) << "Xvfb does not start";
  writeFile(file("script.txt"),
            "patience 90\n"
            "wait idle\n"
            "expect bodies = 150\n"
            "places opened\n"
            "expect playing = yes\n"
            "expect frame > 3\n"
            "places playing\n"
            "expect playing = no\n"
            "places paused\n"
            "expect selection = 1\n"
            "places picked\n"
            "expect panel.left = Algorithms\n"
            "wait 3\n"
            "places algorithms\n"
            "expect popup = yes\n"
            "wait 5\n"
            "places choice\n"
            "expect algorithms = 1\n"
            "wait idle\n"
            "expect algorithm.sap.status = ok\n"
            "places chosen\n"
            "expect panel.left = Scene\n"
            "wait 5\n"
            "places scene\n"
            "expect scene.objects = 275\n"
            "places typed\n"
            "expect dialog = yes\n"
            "wait 5\n"
            "places saving\n"
            "expect dialog = no\n"
            "expect status ~ recorded\n");
  start(screen, {"brownian", "--objects", "150", "--frames", "40", "--script", "script.txt"});
  click(screen, "opened", "Playback/Play");
  click(screen, "playing", "Playback/Play");
  click(screen, "paused", "View/scene");
  click(screen, "picked", "Algorithms");
  click(screen, "algorithms", "Algorithms/Add…");
  click(screen, "choice", "Algorithms/add/sap");
  click(screen, "chosen", "Scene");
  click(screen, "scene", "Scene/objects");
  press(screen, "ctrl+a");
  screen.tool("type --delay 40 275");
  press(screen, "Return");
  middleOf("typed", "View/scene");
  press(screen, "ctrl+s");
  click(screen, "saving", "File/name");
  press(screen, "ctrl+a");
  screen.tool("type --delay 40 mine.aabbs");
  press(screen, "Return");
  EXPECT_TRUE(program_->waitUntil([&] { return fs::exists(file("mine.aabbs")); }));
  moveTo(screen, 640, 300);
  press(screen, "ctrl+q");
  const ProgramResult ended = program_->wait();
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(run({"verify", "mine.aabbs"}).status, 0);
  EXPECT_THAT(readFile(file("config/broadmark/inspector.json")),
              ::testing::HasSubstr("mine.aabbs"));
}

TEST_F(WindowTest, AKilledWindowLosesNeitherSettingsNorAnUnsavedScene) {
  const Screen screen;
  ASSERT_FALSE(screen.name().empty()) << "Xvfb does not start";
  writeScene();
  start(screen, {"scene.json"});
  const auto appears = [&](const fs::path& path, const std::string& text) {
    return program_->waitUntil(
        [&] { return fs::exists(path) && readFile(path).find(text) != std::string::npos; });
  };
  ASSERT_TRUE(appears(file("config/broadmark/inspector.json"), "scene.json"));
  press(screen, "ctrl+a");
  press(screen, "ctrl+d");
  ASSERT_TRUE(appears(file("state/broadmark/scenes/scene-0.json"), "Hands"));
  program_->signal(SIGKILL);
  program_->wait();

  writeFile(file("script.txt"),
            "expect recoverable = 1\n"
            "click \"Start/Not saved/scene.json\"\n"
            "expect author.bodies = 2\n"
            "expect author.path ~ scene.json\n"
            "expect author.modified = yes\n"
            "click Author/Save\n"
            "expect author.modified = no\n"
            "click File\n"
            "click File/Quit\n");
  start(screen, {"--script", "script.txt"});
  const ProgramResult ended = program_->wait();
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_FALSE(fs::exists(file("state/broadmark/scenes/scene-0.json")));
}

TEST_F(WindowTest, AGizmoMovesABodyAndKeysAnswerDialogs) {
  const Screen screen;
  ASSERT_FALSE(screen.name().empty()) << "Xvfb does not start";
  writeScene();
  writeFile(file("script.txt"),
            "patience 90\n"
            "open scene.json\n"
            "expect author.at_rest = yes\n"
            "wait idle\n"
            "places opened\n"
            "expect selection = 1\n"
            "expect author.tool = move\n"
            "wait idle\n"
            "places selected\n"
            "expect author.undo ~ move\n"
            "expect author.body.position != \"0 0 0\"\n"
            "wait idle\n"
            "places moved\n"
            "expect author.modified = no\n"
            "places saved\n"
            // Cancel typing in a dialog, then the dialog.
            "expect dialog = yes\n"
            "wait 5\n"
            "places opening\n"
            "wait 150\n"
            "expect dialog = yes\n"
            "places typing\n"
            "expect dialog = no\n"
            "places left\n"
            // Close a menu, then the window behind it.
            "expect help = yes\n"
            "places helped\n"
            "expect popup = yes\n"
            "wait 5\n"
            "places listed\n"
            "expect popup = no\n"
            "expect help = yes\n"
            "places unlisted\n"
            "expect help = no\n"
            "places unhelped\n"
            "expect dialog = yes\n"
            "wait 5\n"
            "places again\n"
            "expect author.path ~ before.json\n"
            "expect dialog = no\n"
            "places reopened\n");
  start(screen, {"--script", "script.txt"});
  fs::copy_file(file("scene.json"), file("before.json"));
  click(screen, "opened", "View/scene");
  drag(screen, "selected", "View/gizmo y", 0, -90);
  middleOf("moved", "View/scene");
  press(screen, "ctrl+s");
  middleOf("saved", "View/scene");
  const Json body = readJson(file("scene.json")).at("bodies").at(0);
  EXPECT_EQ(body.at("position").at(0), 0);
  EXPECT_GT(body.at("position").at(1), 0.5);
  EXPECT_EQ(body.at("position").at(2), 0);

  press(screen, "ctrl+o");
  click(screen, "opening", "File/name");
  screen.tool("type --delay 40 some");
  press(screen, "Escape");
  middleOf("typing", "File/name");
  press(screen, "Escape");
  middleOf("left", "View/scene");

  press(screen, "F1");
  click(screen, "helped", "View");
  middleOf("listed", "View/scene");
  press(screen, "Escape");
  middleOf("unlisted", "View/scene");
  press(screen, "Escape");
  middleOf("unhelped", "View/scene");

  press(screen, "ctrl+o");
  click(screen, "again", "File/name");
  press(screen, "ctrl+a");
  screen.tool("type --delay 40 before.json");
  press(screen, "Return");
  middleOf("reopened", "View/scene");
  press(screen, "ctrl+q");
  const ProgramResult ended = program_->wait();
  EXPECT_EQ(ended.status, 0) << ended.err;
}

TEST_F(WindowTest, WithoutADisplayOneLineSaysWhatToDo) {
  Program program(file(""), {"brownian"},
                  {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}});
  const ProgramResult ended = program.wait();
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, ::testing::HasSubstr("--headless"));
  EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
}

}  // namespace
}  // namespace broadmark::tests
