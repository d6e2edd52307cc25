// Sessions of an engine that is not in Debian, audited by the program.

#include "recorders/session.h"

#include <fmt/format.h>

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class RecordedSession : public EndToEnd, public testing::WithParamInterface<World> {
 protected:
  [[nodiscard]] std::string audit(const char* log) const {
    return run({"audit", "session.broadmark", log, "--margin", kAuditMargin, "--quiet"}).out;
  }
};

TEST_P(RecordedSession, IsAudited) {
  ASSERT_TRUE(recordSession(file("session").c_str(), GetParam()));
  const std::string first = audit("session.csv");
  EXPECT_THAT(first, HasSubstr(fmt::format("in {} frames, of which none is wrong", +kFrames)));
  fmt::print("{}", first);

  // Without this pair, which certainly overlaps:
  writeFile(file("none.csv"), "frame,a,b\n");
  const std::string all_missed = audit("none.csv");
  constexpr std::string_view kFound = "missed in frame ";
  const std::size_t begin = all_missed.find(kFound);
  ASSERT_NE(begin, std::string::npos) << all_missed;
  unsigned frame = 0;
  unsigned a = 0;
  unsigned b = 0;
  ASSERT_EQ(std::sscanf(&all_missed[begin], "missed in frame %u: bodies %u and %u", &frame, &a, &b),
            3);
  std::string log = readFile(file("session.csv"));
  for (const std::string& row :
       {fmt::format("\n{},{},{}\n", frame, a, b), fmt::format("\n{},{},{}\n", frame, b, a)}) {
    if (const std::size_t at = log.find(row); at != std::string::npos)
      log.erase(at, row.size() - 1);
  }
  writeFile(file("less.csv"), log);
  EXPECT_THAT(audit("less.csv"),
              testing::ContainsRegex(fmt::format("missed +1 +1 +{} +{}-{}", frame, a, b)));
}

std::string nameOf(const testing::TestParamInfo<World>& world) {
  constexpr const char* kNames[] = {"falling", "turning", "churning"};
  return kNames[world.param];
}

INSTANTIATE_TEST_SUITE_P(Worlds, RecordedSession, testing::Values(kFalling, kTurning, kChurning),
                         nameOf);

}  // namespace
}  // namespace broadmark::tests
