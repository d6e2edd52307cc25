// What an algorithm answers in each frame: pairs, events, or the hits of queries.
//
// Example:
//
//   const Answer rays(AnswerKind::rays, 1000);
//   const std::string name = answerName(rays);             // "rays:1000"
//   const std::optional<Answer> same = findAnswer(name);   // nothing for an unknown name
//   const bool has_queries = isQuery(AnswerKind::events);  // false
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "broadmark/names.h"

namespace broadmark {

/// All pairs; the pairs that began or ended since the frame before; or the hits of queries
/// (queries.h): bodies that overlap boxes, are crossed by rays, are touched by moving boxes, or are
/// nearest to points.
enum class AnswerKind { pairs, events, boxes, rays, sweeps, nearest };

/// The kinds without queries, by name.
inline constexpr NameTable kAnswerKinds{
    {NamedValue{AnswerKind::pairs, "pairs"}, {AnswerKind::events, "events"}}};
/// The kinds of queries, by name.
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
  std::uint32_t queries = 0;  ///< in each frame, 1 to kMaxQueries; 0 for pairs and events

  friend constexpr bool operator==(const Answer&, const Answer&) = default;
};

/// Whether the answer is that to queries.
constexpr bool isQuery(Answer answer) {
  return answer.kind != AnswerKind::pairs && answer.kind != AnswerKind::events;
}

/// The largest number of queries in a frame.
inline constexpr std::uint32_t kMaxQueries = 10'000'000;

/// The name of an answer: "pairs", "events", "rays:1000".
std::string answerName(Answer);
/// The answer with a name as above; nullopt for any other text, and for a number of queries beyond
/// 1 to kMaxQueries.
std::optional<Answer> findAnswer(std::string_view name);

}  // namespace broadmark
