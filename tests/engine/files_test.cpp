// Files that are written atomically.

#include "broadmark/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <thread>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

TEST(AtomicFile, AppearsWithCommit) {
  const TemporaryDirectory directory;
  AtomicFile file(directory / "a.txt");
  file.write("one ");
  file.write("two");
  EXPECT_FALSE(std::filesystem::exists(directory / "a.txt"));
  file.commit();
  EXPECT_EQ(readTextFile(directory / "a.txt"), "one two");
  EXPECT_FALSE(std::filesystem::exists(directory / "a.txt.part"));
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const TemporaryDirectory directory;
  {
    AtomicFile(directory / "a.txt").write("half");
  }
  EXPECT_TRUE(directory.empty());
}

TEST(AtomicFile, ReplacesWhatIsThereAndWhatAKilledWriterLeft) {
  const TemporaryDirectory directory;
  writeTextFile(directory / "a.txt", "a longer old text");
  writeTextFile(directory / "a.txt.part", "what was left, longer than the new text");
  writeTextFile(directory / "a.txt", "new");
  EXPECT_EQ(readTextFile(directory / "a.txt"), "new");
}

TEST(AtomicFile, RefusesWhatIsNoFile) {
  const TemporaryDirectory directory;
  // Instead of /dev/null, which a test must not risk.
  const std::filesystem::path fifo = directory / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  for (const std::filesystem::path& path : {directory / "", fifo}) {
    EXPECT_THAT(inputErrorOf([&] { writeTextFile(path, "text"); }),
                HasSubstr("not a regular file"));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(fifo)) << "it is still there";
}

TEST(AtomicFile, WritesThroughLinks) {
  const TemporaryDirectory directory;
  writeTextFile(directory / "target", "old");
  std::filesystem::create_symlink(directory / "target", directory / "link");
  writeTextFile(directory / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(readTextFile(directory / "target"), "new");
}

// A writer that opens another writer's partial file just before its commit must not truncate the
// committed file.
TEST(AtomicFile, ManyWritersLeaveAWholeFile) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "a.txt";
  const std::string text(10'000, 'x');
  writeTextFile(path, text);
  std::atomic<int> broken = 0;
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i) {
    writers.emplace_back([&] {
      for (int round = 0; round < 200; ++round) {
        try {
          writeTextFile(path, text);
        } catch (const InputError& error) {
          // A refusal is correct; a loss of the file is not.
          if (std::string_view(error.what()).find("another process") == std::string_view::npos) {
            ++broken;
          }
        }
        if (readTextFile(path) != text) ++broken;
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(broken, 0);
}

TEST(ReadTextFile, ReadsWholeFilesUpToTheLimit) {
  const TemporaryDirectory directory;
  const std::string text(200'000, 'x');
  writeTextFile(directory / "a.txt", text);
  EXPECT_EQ(readTextFile(directory / "a.txt"), text);
  EXPECT_EQ(readTextFile(directory / "a.txt", text.size()), text);
  EXPECT_THAT(inputErrorOf([&] { readTextFile(directory / "a.txt", text.size() - 1); }),
              HasSubstr("too large"));
  EXPECT_THAT(inputErrorOf([&] { readTextFile(directory / "missing"); }),
              HasSubstr("No such file"));
  EXPECT_THAT(inputErrorOf([&] { readTextFile("/dev/zero"); }), HasSubstr("not a regular file"));
}

}  // namespace
}  // namespace broadmark::tests
