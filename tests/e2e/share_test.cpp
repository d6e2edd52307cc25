// A page that the inspector writes for others.
#include "e2e/end_to_end.h"
#include "parts.h"

namespace broadmark::tests {
namespace {

class Share : public EndToEnd {
 protected:
  /// Steps to frame 2 and shares it. Returns the page.
  [[nodiscard]] std::string pageOf(const Arguments& opened) const {
    writeFile(file("share.txt"),
              "wait idle\nkey Right\nkey Right\nwait idle\n"
              "click File\nclick File/Share…\nenter File/name page.html\nwait idle\n"
              "expect status ~ page.html\n");
    Arguments call = {"--headless", "--ui", "--script", "share.txt", "--size", "800x600"};
    call.insert(call.end(), opened.begin(), opened.end());
    const ProgramResult ended = run(call);
    EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
    return readFile(file("page.html"));
  }
  /// Runs the page's command, with a script that expects this.
  void expectOpens(const std::string& page, const std::string& expectations) const {
    const std::size_t begin = page.find("<pre>");
    ASSERT_NE(begin, page.npos) << page.substr(0, 2000);
    const std::string command = page.substr(begin + 5, page.find("</pre>") - begin - 5);
    writeFile(file("again.txt"), "wait idle\n" + expectations);
    EXPECT_EQ(shell(command + " --headless --ui --script again.txt"), 0)
        << command << readFile(file("shell.out"));
  }
  void SetUp() override {
    EndToEnd::SetUp();
    if (!parts::kInspector.included) GTEST_SKIP() << "the inspector is left out of this build";
  }
};

TEST_F(Share, ShowsThePictureAndTheCommandThatOpensItAgain) {
  const std::string page = pageOf({"brownian", "--objects", "50", "--frames", "5", "--engine",
                                   "kinematic", "--algorithm", "kd,bf", "--param", "kd:margin=0.5",
                                   "--select", "7,3", "--camera", "0.1,-0.2,0,30,-12.5,1.5"});
  EXPECT_THAT(page, HasSubstr("<h1>Brownian, frame 2</h1>"));
  EXPECT_THAT(page, HasSubstr("kd reports "));
  EXPECT_THAT(page, HasSubstr("base64,iVBORw0KGgo")) << "the first bytes of a PNG";
  expectOpens(page,
              "expect title = Brownian\nexpect frame = 2\nexpect algorithms = 2\n"
              "expect open.objects = 50\nexpect open.engine = kinematic\n"
              "expect algorithm.kd.margin = 0.5\n"
              "expect selection = 2\nexpect view.pair ~ 3\nexpect view.pair ~ 7\n"
              "expect camera.yaw = 0.5236\nexpect camera.pitch = -0.2182\n"
              "expect camera.distance = 1.5000\n");
}

TEST_F(Share, NamesARecordingByItsFile) {
  runQuietly(
      {"bake", "--scenes", "freefall", "--objects", "30", "--frames", "3", "--output", "out"});
  const std::string page = pageOf({recordingIn("out", "FreeFall Cubes N30 F3frames"), "--swept"});
  EXPECT_THAT(page, HasSubstr("--swept"));
  expectOpens(page, "expect frame = 2\nexpect scene ~ swept\n");
}

}  // namespace
}  // namespace broadmark::tests
