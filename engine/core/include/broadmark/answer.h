// What an algorithm answers in each frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "broadmark/names.h"

namespace broadmark {

/// All pairs; the pairs that began or ended since the frame before; or queries (queries.h).
enum class AnswerKind { pairs, events, boxes, rays, sweeps, nearest };

inline constexpr NameTable kAnswerKinds{
    {NamedValue{AnswerKind::pairs, "pairs"}, {AnswerKind::events, "events"}}};
inline constexpr NameTable kQueryKinds{{NamedValue{AnswerKind::boxes, "boxes"},
                                        {AnswerKind::rays, "rays"},
                                        {AnswerKind::sweeps, "sweeps"},
                                        {AnswerKind::nearest, "nearest"}}};

/// An answer's kind, and for queries their number in each frame.
struct Answer {
  constexpr Answer() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): pairs and events have no number
  constexpr Answer(AnswerKind which) : kind(which) {}
  constexpr Answer(AnswerKind which, std::uint32_t count) : kind(which), queries(count) {}

  AnswerKind kind = AnswerKind::pairs;
  std::uint32_t queries = 0;

  friend constexpr bool operator==(const Answer&, const Answer&) = default;
};

constexpr bool isQuery(Answer answer) {
  return answer.kind != AnswerKind::pairs && answer.kind != AnswerKind::events;
}

/// The largest number of queries in a frame.
inline constexpr std::uint32_t kMaxQueries = 10'000'000;

/// "pairs", "events", "rays:1000"
std::string answerName(Answer);
/// The answer of that name, or nothing.
std::optional<Answer> findAnswer(std::string_view name);

}  // namespace broadmark
