#include "inspector/ui/glyph_atlas.h"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/render/fonts.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

// Latin, and the dashes, arrows, dots and signs in the texts of the program.
constexpr ImWchar kRanges[] = {0x20,   0xFF,   0x2010, 0x2026, 0x2190, 0x2193, 0x2212,
                               0x2212, 0x2248, 0x2248, 0x2264, 0x2265, 0};
/// Maximum number of system fonts to search for glyphs.
constexpr std::size_t kMaxTried = 40;
constexpr std::uintmax_t kMaxFontBytes = 64 << 20;  // bytes

bool isInRanges(ImWchar letter) {
  for (std::size_t i = 0; kRanges[i] != 0; i += 2) {
    if (letter >= kRanges[i] && letter <= kRanges[i + 1]) return true;
  }
  return false;
}

/// Returns the rank of a font in the search, the lowest first; -1: not used.
int rankOf(const fs::path& font) {
  const std::string extension = font.extension().string();
  if (extension != ".ttf" && extension != ".otf" && extension != ".ttc") return -1;
  const std::string name = font.stem().string();
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  for (const char* style : {"Bold", "Italic", "Oblique", "Thin", "Light", "Black", "Condensed"}) {
    if (has(style)) return -1;
  }
  constexpr std::array kFirst = {"DejaVuSans", "NotoSans", "DroidSans", "wqy", "unifont"};
  for (std::size_t i = 0; i < kFirst.size(); ++i) {
    if (has(kFirst[i])) return static_cast<int>(i);
  }
  return static_cast<int>(kFirst.size());
}

/// Returns the system's fonts in the order of the search.
std::vector<fs::path> systemFonts() {
  std::vector<fs::path> directories = {"/usr/share/fonts", "/usr/local/share/fonts"};
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    directories.push_back(fs::path(home) / ".local/share/fonts");
    directories.push_back(fs::path(home) / ".fonts");
  }
  std::vector<std::pair<int, fs::path>> found;
  for (const fs::path& directory : directories) {
    std::error_code error;
    for (fs::recursive_directory_iterator it(directory, error), end; !error && it != end;
         it.increment(error)) {
      std::error_code unknown;
      const int rank = rankOf(it->path());
      if (rank >= 0 && it->file_size(unknown) <= kMaxFontBytes)
        found.emplace_back(rank, it->path());
    }
  }
  std::ranges::sort(found);
  std::vector<fs::path> fonts;
  for (auto& [rank, path] : found) {
    if (fonts.size() < kMaxTried) fonts.push_back(std::move(path));
  }
  return fonts;
}

}  // namespace

void GlyphAtlas::request(std::string_view text) {
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    if (static_cast<unsigned char>(*at) < 0x80) {
      ++at;
      continue;
    }
    unsigned letter = 0;
    const int length = ImTextCharFromUtf8(&letter, at, end);
    if (length <= 0) return;
    at += length;
    const auto glyph = static_cast<ImWchar>(letter);
    if (letter > IM_UNICODE_CODEPOINT_MAX || isInRanges(glyph)) continue;
    dirty_ |= requested_.insert(glyph).second;
  }
}

ImFont* GlyphAtlas::build(ImFontAtlas& atlas, float size, float large_size) const {
  atlas.Clear();
  ImFontGlyphRangesBuilder builder;
  for (const ImWchar letter : requested_) builder.AddChar(letter);
  ImVector<ImWchar> others;
  builder.BuildRanges(&others);
  builder.AddRanges(kRanges);
  ImVector<ImWchar> all;
  builder.BuildRanges(&all);
  const std::string_view own = interfaceFont();
  const auto add = [&](float pixels) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    return atlas.AddFontFromMemoryTTF(const_cast<char*>(own.data()), static_cast<int>(own.size()),
                                      pixels, &config, all.Data);
  };
  add(size);
  std::vector<std::string> files;  // outlives atlas.Build()
  files.reserve(fallbacks_.size());
  for (const fs::path& fallback : fallbacks_) {
    std::string& file = files.emplace_back(readTextFile(fallback));
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.MergeMode = true;
    atlas.AddFontFromMemoryTTF(file.data(), static_cast<int>(file.size()), size, &config,
                               others.Data);
  }
  ImFont* const large = add(large_size);
  if (!atlas.Build()) return nullptr;
  atlas.ClearInputData();
  return large;
}

std::size_t GlyphAtlas::missingFrom(const ImFont& font) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      requested_, [&](ImWchar letter) { return font.FindGlyphNoFallback(letter) == nullptr; }));
}

ImFont* GlyphAtlas::load(ImFontAtlas& atlas, float size, float large_size) {
  const bool was_dirty = std::exchange(dirty_, false);
  ImFont* large = build(atlas, size, large_size);
  if (missingFrom(*atlas.Fonts[0]) == missing_ || !was_dirty) return large;
  missing_ = missingFrom(*atlas.Fonts[0]);
  for (const fs::path& font : systemFonts()) {
    if (missing_ == 0) break;
    if (std::ranges::find(fallbacks_, font) != fallbacks_.end()) continue;
    fallbacks_.push_back(font);
    bool improves = false;
    try {
      if (build(atlas, size, large_size) != nullptr) {
        const std::size_t missing = missingFrom(*atlas.Fonts[0]);
        improves = missing < missing_;
        missing_ = std::min(missing, missing_);
      }
    } catch (const InputError&) {
      improves = false;  // the font is unreadable
    }
    if (!improves) fallbacks_.pop_back();
  }
  return build(atlas, size, large_size);
}

}  // namespace broadmark
