// Glyphs of the user interface: Latin from the embedded font, others on demand from that font or
// the system's. There is no text shaping: the letters of cursive scripts are not joined.
#pragma once

#include <imgui.h>

#include <cstddef>
#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

namespace broadmark {

class GlyphAtlas {
 public:
  /// Requests the glyphs of a text in UTF-8.
  void request(std::string_view text);
  /// Whether glyphs were requested since load().
  [[nodiscard]] bool dirty() const { return dirty_; }
  /// Builds the atlas with all glyphs in two fonts: the default font of this size in pixels, and
  /// the large one, which it returns.
  ImFont* load(ImFontAtlas& atlas, float size, float large_size);
  /// Number of requested glyphs that no font has.
  [[nodiscard]] std::size_t missing() const { return missing_; }

 private:
  ImFont* build(ImFontAtlas& atlas, float size, float large_size) const;
  [[nodiscard]] std::size_t missingFrom(const ImFont& font) const;

  std::set<ImWchar> requested_;  ///< beyond Latin
  std::vector<std::filesystem::path> fallbacks_;
  std::size_t missing_ = 0;
  bool dirty_ = false;
};

}  // namespace broadmark
