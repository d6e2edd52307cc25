// The letters of the user interface: Latin from its own font, others as they turn up, from that
// font or from those of the system. (Letters stand beside each other as they are: scripts that join
// them look spelled out.)
#pragma once

#include <imgui.h>

#include <cstddef>
#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

namespace broadmark {

class Letters {
 public:
  /// Takes note of the letters of a text in UTF-8.
  void need(std::string_view text);
  /// Whether some have turned up since they were loaded.
  [[nodiscard]] bool stale() const { return stale_; }
  /// Puts all letters into the atlas: those of normal size, which become the default, and large
  /// ones, which are returned. Sizes in pixels.
  ImFont* load(ImFontAtlas& atlas, float size, float large_size);
  /// How many letters no font has.
  [[nodiscard]] std::size_t missing() const { return missing_; }

 private:
  ImFont* build(ImFontAtlas& atlas, float size, float large_size) const;
  [[nodiscard]] std::size_t missingFrom(const ImFont& font) const;

  std::set<ImWchar> needed_;  ///< beyond Latin
  std::vector<std::filesystem::path> fallbacks_;
  std::size_t missing_ = 0;
  bool stale_ = false;
};

}  // namespace broadmark
