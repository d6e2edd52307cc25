#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "broadmark/error.h"
#include "broadmark/render/picture.h"

namespace broadmark::tests {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

Picture gradient(int width, int height) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int value : {x * 3, y * 5, x * y, 255 - x}) {
        picture.rgba.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return picture;
}

std::string messageOfReading(const std::filesystem::path& path) {
  try {
    readPng(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Png, ComesBackAsItWasWritten) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 33}}) {
    const auto path = temporary("round-trip.png");
    const Picture picture = gradient(width, height);
    writePng(path, picture);
    const Picture read = readPng(path);
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, height);
    EXPECT_EQ(read.rgba, picture.rgba);
  }
}

TEST(Png, CannotBeWrittenWhereThereIsNoDirectory) {
  EXPECT_THROW(writePng(temporary("no-such-directory") / "a.png", gradient(2, 2)), InputError);
}

TEST(Png, WithoutPixelsIsNotWritten) {
  const auto path = temporary("empty.png");
  std::filesystem::remove(path);
  EXPECT_THROW(writePng(path, Picture{}), InputError);
  EXPECT_THROW(writePng(path, Picture{2, 2, {1, 2, 3}}), InputError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Png, BadFilesAreNamed) {
  const auto missing = temporary("missing.png");
  EXPECT_NE(messageOfReading(missing).find("missing.png"), std::string::npos);

  const auto text = temporary("text.png");
  std::ofstream(text) << "not a picture at all";
  EXPECT_NE(messageOfReading(text).find("text.png: not a readable PNG"), std::string::npos);
}

TEST(Png, CutOffFilesAreNotRead) {
  const auto whole = temporary("whole.png");
  writePng(whole, gradient(40, 30));
  std::ifstream file(whole, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{8}, std::size_t{33}, bytes.size() / 2}) {
    const auto cut = temporary("cut.png");
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, length);
    EXPECT_NE(messageOfReading(cut), "") << length << " bytes";
  }
}

}  // namespace
}  // namespace broadmark::tests
