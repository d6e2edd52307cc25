#include "inspector/ui/preferences.h"

#include <gtest/gtest.h>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

TEST(Preferences, ComeBackAsTheyWere) {
  const TemporaryDirectory directory;
  Preferences preferences{.dark = false, .scale = 1.5, .window_width = 900, .left = 222};
  preferences.tabs["left"] = "Algorithms";
  preferences.areas["Bodies"] = "bottom";
  preferences.hidden = {"Batch"};
  preferences.folders["Open"] = "/tmp";
  preferences.remember("/tmp/a \"b\".aabbs");
  savePreferences(directory / "deep/er/inspector.json", preferences);
  EXPECT_EQ(loadPreferences(directory / "deep/er/inspector.json"), preferences);
}

TEST(Preferences, AreSavedSoonAfterTheyHaveChanged) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "inspector.json";
  PreferencesFile file(path, {});
  Preferences now{.dark = false};
  file.update(now, 0.9);
  now.left = 250;  // by a drag, in every picture
  EXPECT_FALSE(std::filesystem::exists(path));
  file.update(now, 0.2);
  EXPECT_EQ(loadPreferences(path), now);
  std::filesystem::remove(path);
  file.update(now, 100);
  file.save(now);
  EXPECT_FALSE(std::filesystem::exists(path)) << "nothing has changed since";
}

TEST(Preferences, WhatCannotBeReadIsTheDefault) {
  EXPECT_EQ(loadPreferences("/nowhere/inspector.json"), Preferences{});
  for (const char* text : {"", "{", "[1]", "null", R"({"left": "wide", "recent": 7})",
                           R"({"scale": -3, "left": 1e300, "window_width": -5})"}) {
    const Preferences read = parsePreferences(text);
    EXPECT_EQ(read.scale, 0) << text;
    EXPECT_GE(read.left, 120) << text;
    EXPECT_GE(read.window_width, 320) << text;
  }
}

TEST(Preferences, RecentFilesAreFewAndTheLatestFirst) {
  Preferences preferences;
  for (int i = 0; i < 15; ++i) preferences.remember("/tmp/" + std::to_string(i));
  preferences.remember("/tmp/7");
  EXPECT_EQ(preferences.recent.size(), Preferences::kMaxRecent);
  EXPECT_EQ(preferences.recent[0], "/tmp/7");
  EXPECT_EQ(preferences.recent[1], "/tmp/14");
}

}  // namespace
}  // namespace broadmark::tests
