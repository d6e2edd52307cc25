#include "compare/advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>

#include "compare/comparison.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// "1.04", "24.6", "317": a ratio with three digits.
std::string ratioText(double ratio) {
  return fmt::format("{:.{}f}", ratio, ratio < 10 ? 2 : ratio < 100 ? 1 : 0);
}

/// "3.70 times as slow (3.62…3.79)", "as fast as it (1.01 times its time, 0.99…1.02)".
std::string slownessText(const Estimate& ratio) {
  const auto& [low, high] = ratio.ci95;
  const std::string interval = fmt::format("{}…{}", ratioText(low), ratioText(high));
  const Verdict verdict = verdictOn(ratio.ci95, kAdviceMargin);
  if (verdict != Verdict::slower) {
    return fmt::format("{} it ({} times its time, {})",
                       verdict == Verdict::same ? "as fast as" : "indistinguishable from",
                       ratioText(ratio.value), interval);
  }
  if (ratio.value >= 2) {
    return fmt::format("{} times as slow ({})", ratioText(ratio.value), interval);
  }
  return fmt::format("{:.1f} % slower ({:.1f}…{:.1f} %)", 100 * (ratio.value - 1), 100 * (low - 1),
                     100 * (high - 1));
}

/// "columns", "kd with margin=0.1"
std::string choiceText(const Case& test_case) {
  std::vector<std::string> settings;
  for (const auto& [name, value] : test_case.parameters) {
    settings.push_back(fmt::format("{}={}", name, value));
  }
  return test_case.algorithm.id +
         (settings.empty() ? "" : fmt::format(" with {}", fmt::join(settings, ", ")));
}

std::string commandLine(const Case& test_case, const std::string& source) {
  std::string text = fmt::format("broadmark --headless {} --algorithm {}", source,
                                 shellQuoted(test_case.algorithm.id));
  if (test_case.algorithm.traits.parallel) text += fmt::format(" --threads {}", test_case.threads);
  if (test_case.algorithm.traits.vectorised && test_case.isa != bestIsa()) {
    text += fmt::format(" --isa {}", isaName(test_case.isa));
  }
  if (isQuery(test_case.answer)) {
    text += " --queries " + answerName(test_case.answer);
  } else if (test_case.answer.kind != AnswerKind::pairs) {
    text += " --answer " + answerName(test_case.answer);
  }
  if (!test_case.device.empty()) text += " --device " + shellQuoted(test_case.device);
  for (const auto& [name, value] : test_case.parameters) {
    text += " --param " + shellQuoted(fmt::format("{}:{}={}", test_case.algorithm.id, name, value));
  }
  return text;
}

/// The library's method by the family of an algorithm; "": the library lacks it.
std::string libraryMethod(const Algorithm& algorithm) {
  if (!algorithm.plugin.empty()) return {};
  if (algorithm.family == "Columns") return "columns";
  return algorithm.family == "Tide" ? "tide" : "";
}

std::string codeLines(const Case& test_case) {
  const Algorithm& algorithm = test_case.algorithm;
  const std::string method = libraryMethod(algorithm);
  if (!method.empty() && !isQuery(test_case.answer)) {
    return fmt::format(
        "broadmark::broadphase::BroadPhase broad_phase(\n"
        "    {{.method = broadmark::broadphase::Method::{},\n"
        "     .answer = broadmark::broadphase::Answer::{}, .threads = {}}});{}",
        method, answerName(test_case.answer), test_case.threads,
        test_case.parameters.empty() ? "" : "  // with default parameters");
  }
  if (!algorithm.plugin.empty()) return {};
  std::string text = fmt::format(
      "const std::vector<broadmark::Algorithm> all = broadmark::builtinAlgorithms();\n"
      "const auto broad_phase = std::ranges::find(all, \"{}\", "
      "&broadmark::Algorithm::id)->create();",
      algorithm.id);
  for (const auto& [name, value] : test_case.parameters) {
    text += fmt::format("\nbroadmark::setParameters(*broad_phase, {{{{\"{}\", \"{}\"}}}});", name,
                        value);
  }
  const bool has_events = test_case.answer == AnswerKind::events && algorithm.traits.events;
  return text + (has_events ? "\nbroad_phase->reportEvents();" : "");
}

std::string indented(const std::string& lines) {
  std::string text;
  forEachPart('\n', lines, [&](std::string_view line) { text += fmt::format("    {}\n", line); });
  return text;
}

std::string paragraph(const Advice& advice) {
  const std::string answer = answerName(advice.answer);
  std::string text = fmt::format("{}, {}: ", answer, counted(advice.threads, "thread"));
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (advice.finalists.empty()) return text + "no algorithm gave correct answers.";
  const Finalist& first = advice.finalists.front();
  const bool is_level =
      advice.finalists.size() > 1 &&
      verdictOn(advice.finalists[1].ratio.ratio.ci95, kAdviceMargin) != Verdict::slower;
  text += fmt::format("{} is {}the fastest, with {} a frame.", choiceText(first.test_case),
                      is_level ? "among " : "", durationText(first.ratio.after));
  constexpr const char* kPlaces[] = {"Second is", "Third", "Fourth"};
  for (std::size_t i = 1; i < advice.finalists.size() && i <= std::size(kPlaces); ++i) {
    const auto& [test_case, ratio] = advice.finalists[i];
    text += fmt::format(" {} {}, {}, {}.", kPlaces[i - 1], choiceText(test_case),
                        durationText(ratio.after), slownessText(ratio.ratio));
  }
  if (advice.finalists.size() == 1) text += " There is no runner-up.";
  if (advice.untuned) {
    const Case& untuned = advice.untuned->test_case;
    text += fmt::format(" {}{} is {}.", choiceText(untuned),
                        untuned.parameters.empty() ? " with default parameters" : " alone",
                        slownessText(advice.untuned->ratio.ratio));
  }
  const float margin = makeInstance(first.test_case)->margin();
  if (margin > 0) {
    text += fmt::format(
        " It is conservative: besides all pairs that overlap it reports some that do so once each "
        "box is enlarged by {:g}.",
        margin);
  }
  return text;
}

}  // namespace

std::vector<std::size_t> halve(std::size_t count, std::size_t keep, const MeasureCosts& measure) {
  std::vector<std::size_t> left(count);
  std::iota(left.begin(), left.end(), std::size_t{0});
  do {
    const std::vector<double> costs = measure(left);
    std::map<std::size_t, double> cost_of;
    for (std::size_t i = 0; i < left.size(); ++i) cost_of[left[i]] = costs[i];
    const std::size_t most = std::max(keep, (left.size() + 1) / 2);
    std::erase_if(left, [&](std::size_t candidate) { return std::isinf(cost_of[candidate]); });
    std::ranges::stable_sort(left, {}, [&](std::size_t candidate) { return cost_of[candidate]; });
    left.resize(std::min(left.size(), most));
  } while (left.size() > keep);
  return left;
}

Excerpt excerptOf(std::uint32_t frames, std::uint32_t wanted) {
  constexpr std::uint32_t kMaxStretches = 8;
  constexpr std::uint32_t kMinStretch = 8;
  Excerpt excerpt{.frames = {0}};
  if (wanted >= frames) {
    for (std::uint32_t frame = 1; frame <= frames; ++frame) excerpt.frames.push_back(frame);
    excerpt.counts.assign(frames, true);
    return excerpt;
  }
  const std::uint32_t stretches = std::clamp(wanted / kMinStretch, 1U, kMaxStretches);
  const std::uint32_t length = std::max(wanted / stretches, 1U);
  const std::uint32_t uncounted = length / 4;
  excerpt.stretches = stretches;
  excerpt.frames.clear();
  for (std::uint32_t i = 0; i < stretches; ++i) {
    // In the middle of its share of the recording. The first one begins with the initial pose.
    const auto share = [&](std::uint32_t part) {
      return static_cast<std::uint32_t>(std::uint64_t{frames} * part /
                                        (std::uint64_t{2} * stretches));
    };
    const std::uint32_t begin =
        std::min(share(2 * i + 1) - std::min(share(2 * i + 1), length / 2), frames - length);
    if (i == 0) excerpt.frames.push_back(begin);
    for (std::uint32_t j = 1; j <= length; ++j) {
      if (begin + j <= excerpt.frames.back()) continue;
      excerpt.frames.push_back(begin + j);
      excerpt.counts.push_back(i == 0 || j > uncounted);
    }
  }
  return excerpt;
}

std::vector<std::string> valuesAround(const Parameter& parameter, double length) {
  std::vector<std::string> values;
  const std::string present = parameterText(parameter);
  Parameter changed = parameter;
  const auto add = [&](auto value) {
    changed.value = &value;
    std::string text = parameterText(changed);
    if (text != present && std::ranges::find(values, text) == values.end()) {
      values.push_back(std::move(text));
    }
  };
  const auto add_scaled = [&](double value, auto&& convert) {
    constexpr double kFactors[] = {0.25, 0.5, 2, 4};
    constexpr double kShares[] = {0.01, 0.05, 0.2};
    const auto add_clamped = [&](double scaled) {
      add(convert(std::clamp(scaled, parameter.min, parameter.max)));
    };
    for (const double factor : kFactors) add_clamped(factor * value);
    if (value != 0) return;
    for (const double share : kShares) add_clamped(share * length);
  };
  if (const auto* const* flag = std::get_if<bool*>(&parameter.value)) {
    add(!**flag);
  } else if (const auto* const* integer = std::get_if<std::int64_t*>(&parameter.value)) {
    add_scaled(static_cast<double>(**integer),
               [](double value) { return static_cast<std::int64_t>(std::llround(value)); });
  } else if (const auto* const* number = std::get_if<double*>(&parameter.value)) {
    // Few digits: the text becomes part of a command.
    add_scaled(**number, [](double value) { return std::stod(fmt::format("{:.3g}", value)); });
  } else if (const auto* const* choice = std::get_if<Choice*>(&parameter.value)) {
    for (const std::string& option : (*choice)->options) {
      if (option != present) values.push_back(option);
    }
  }
  return values;
}

std::vector<Repetition> repetitionsOf(const DuelResult::Side& side, const Excerpt& excerpt,
                                      std::size_t processes) {
  const std::size_t frames = excerpt.counts.size();
  const std::size_t passes = side.seconds.size() / frames;
  std::vector<Repetition> repetitions(std::min(processes, passes));
  for (std::size_t pass = 0; pass < passes; ++pass) {
    std::vector<FrameTimes> times;
    for (std::size_t frame = 0; frame < frames; ++frame) {
      if (!excerpt.counts[frame]) continue;
      times.emplace_back()[Phase::total] = std::llround(side.seconds[pass * frames + frame] * 1e9);
    }
    std::vector<FrameTimes>& least = repetitions[pass * repetitions.size() / passes].frames;
    if (least.empty()) least = times;
    for (std::size_t i = 0; i < times.size(); ++i) {
      least[i][Phase::total] = std::min(least[i][Phase::total], times[i][Phase::total]);
    }
  }
  return repetitions;
}

std::string adviceText(const Advice& advice, const std::string& source) {
  std::string text = wrapped(paragraph(advice), 0, 0) + '\n';
  for (const std::string& wrong : advice.wrong) {
    text += wrapped("  DISQUALIFIED: " + wrong, 0, 4) + '\n';
  }
  if (!advice.effort.empty()) text += wrapped(advice.effort, 0, 0) + '\n';
  if (advice.finalists.empty()) return text;
  const Case& first = advice.finalists.front().test_case;
  text += indented(commandLine(first, source));
  const std::string code = codeLines(first);
  return code.empty() ? text : text + indented(code);
}

}  // namespace broadmark
