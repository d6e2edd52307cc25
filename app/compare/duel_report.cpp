#include "compare/duel_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "broadmark/analysis/run_ratio.h"
#include "broadmark/json_fields.h"
#include "compare/comparison.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// "5.3 % slower than", "3.8 times as fast as".
std::string changeText(double ratio) {
  if (ratio >= 2) return fmt::format("{:.2f} times as slow as", ratio);
  if (ratio <= 0.5) return fmt::format("{:.2f} times as fast as", 1 / ratio);
  return fmt::format("{:.1f} % {} than", 100 * std::abs(ratio - 1),
                     ratio > 1 ? "slower" : "faster");
}

std::string table(const DuelResult& result) {
  std::vector<std::vector<std::string>> rows = {
      {"", "variant", "median", "minimum", "ratio to the first variant", "95 % interval"}};
  for (const DuelRank& rank : result.ranking) {
    const DuelResult::Side& side = result.sides[rank.side];
    const bool ties = std::ranges::count(result.ranking, rank.rank, &DuelRank::rank) > 1;
    const bool first = rank.side == 0;
    rows.push_back({fmt::format("{}{}.", ties ? "=" : "", rank.rank), side.name,
                    durationText(quantile(side.seconds, 0.5)),
                    durationText(quantile(side.seconds, 0)),
                    first ? "1" : fmt::format("{:.4f}", rank.ratio.value),
                    first ? "" : intervalText(rank.ratio.ci95, 4)});
  }
  return alignColumns(rows, {true, false, true, true, true, true});
}

/// Histogram of the rounds' ratios, in a few lines.
std::string histogram(const std::vector<double>& ratios) {
  constexpr std::size_t kLines = 9;
  constexpr std::size_t kMaxWidth = 40;
  const Histogram histogram = histogramOf(ratios, kLines);
  std::string text;
  for (std::size_t line = 0; line < histogram.counts.size(); ++line) {
    const std::size_t max = *std::ranges::max_element(histogram.counts);
    text += fmt::format("{:>8.3f} ", histogram.begin(line));
    for (std::size_t i = 0; i < histogram.counts[line] * kMaxWidth / max; ++i) text += "█";
    text += fmt::format(" {}\n", histogram.counts[line]);
  }
  return text;
}

std::string verdictOnTwo(const DuelResult& result) {
  const Estimate& ratio = std::ranges::find(result.ranking, 1U, &DuelRank::side)->ratio;
  const std::string& a = result.sides[0].name;
  const std::string& b = result.sides[1].name;
  const Verdict verdict = verdictOn(ratio.ci95, result.margin);
  if (verdict == Verdict::same) {
    return fmt::format("{} and {}: the same within {:g} %", a, b, 100 * result.margin);
  }
  if (verdict == Verdict::undecided) {
    return fmt::format("{} against {}: undecided; needs more time (--max-seconds)", b, a);
  }
  return fmt::format("{} is {} {}", b, changeText(ratio.value), a);
}

std::string failures(const DuelResult& result) {
  std::string text;
  for (const DuelResult::Side& side : result.sides) {
    if (side.status == Status::ok) continue;
    text += fmt::format("{}: {}: {}\n", side.name, statusName(side.status), side.reason);
  }
  return text;
}

}  // namespace

std::string progressText(const DuelResult& result) {
  std::string text = counted(result.rounds(), "round");
  if (result.sides.size() != 2 || result.rounds() == 0) return text;
  const Estimate ratio = result.ratio(1, 0);
  return text + fmt::format(", ratio {:.3f} ({})", ratio.value, intervalText(ratio.ci95, 3));
}

std::string verdictOf(const DuelResult& result) {
  if (result.sides.size() == 2) return verdictOnTwo(result);
  std::vector<std::string> best;
  for (const DuelRank& rank : result.ranking) {
    if (rank.rank == 1) best.push_back(result.sides[rank.side].name);
  }
  return best.size() == 1 ? fmt::format("{} is the fastest", best.front())
                          : fmt::format("{} share the first rank", fmt::join(best, ", "));
}

std::string formatDuel(const DuelResult& result, const SceneInfo& scene) {
  std::string text =
      fmt::format("{} {} N{}: {} in {}{}\n", scene.name, scene.object_type, scene.objects,
                  counted(result.rounds(), "round"), waitingTime(result.seconds),
                  result.decided || !result.ok() ? "" : ", stopped by the time limit");
  if (!result.ok()) return text + failures(result);
  text += table(result);
  if (result.sides.size() == 2) {
    text += fmt::format("rounds by ratio {} / {}:\n{}", result.sides[1].name, result.sides[0].name,
                        histogram(result.ratios(1, 0)));
  }
  return text + verdictOf(result);
}

std::string duelJson(const DuelResult& result, const RecordingReference& recording) {
  const SceneInfo& scene = recording.scene;
  Json json = {{"schema", "broadmark-duel/1"},
               {"recording",
                {{"name", scene.name},
                 {"object_type", scene.object_type},
                 {"objects", scene.objects},
                 {"frames", scene.frames},
                 {"hash", recording.hash}}},
               {"margin", result.margin},
               {"seconds", result.seconds},
               {"decided", result.decided}};
  for (const DuelResult::Side& side : result.sides) {
    json["sides"].push_back({{"name", side.name},
                             {"status", statusName(side.status)},
                             {"reason", side.reason},
                             {"seconds", side.seconds}});
  }
  for (const DuelRank& rank : result.ranking) {
    const auto [low, high] = rank.ratio.ci95;
    json["ranking"].push_back({{"side", rank.side},
                               {"name", result.sides[rank.side].name},
                               {"place", rank.rank},
                               {"ratio", rank.ratio.value},
                               {"ci95", std::isfinite(high) ? Json{low, high} : Json(nullptr)}});
  }
  return formatJson(json);
}

}  // namespace broadmark
