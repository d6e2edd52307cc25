// Edit distances, globs and integers.

#include "broadmark/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>
#include <utility>

#include "broadmark/error.h"

namespace broadmark {
namespace {

/// Levenshtein distance, ignoring case.
std::size_t editDistance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) != lower(b[j]) ? 1 : 0);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearestName(std::string_view name, std::span<const std::string> known) {
  // No valid name is longer: avoids the quadratic comparison.
  if (name.size() > 64) return {};
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, name.size() / 2) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(name, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string unknownName(std::string_view kind, std::string_view name,
                        std::span<const std::string> known) {
  const std::string nearest = nearestName(name, known);
  return fmt::format("unknown {} '{}'{} (one of: {})", kind, name,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest),
                     fmt::join(known, ", "));
}

bool globMatches(std::string_view glob, std::string_view word) {
  return ::fnmatch(std::string(glob).c_str(), std::string(word).c_str(), 0) == 0;
}

long long parseInteger(std::string_view text, std::string_view what, long long min, long long max) {
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < min || value > max) {
    throw InputError(fmt::format("{}: '{}' is not an integer from {} to {}", what, text, min, max));
  }
  return value;
}

}  // namespace broadmark
