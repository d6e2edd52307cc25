#include "broadmark/results/case_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "broadmark/harness/runner.h"
#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

using R = const CaseResult&;
using S = const Summary&;

constexpr const auto& namesOf(Isa) { return kIsas; }
constexpr const auto& namesOf(Status) { return kStatuses; }
constexpr const auto& namesOf(CheckMode) { return kCheckModes; }

/// The names of answers, by the functions of a NameTable.
struct AnswerNames {
  static std::string nameOf(Answer answer) { return answerName(answer); }
  static std::optional<Answer> find(std::string_view name) { return findAnswer(name); }
};
constexpr AnswerNames namesOf(Answer) { return {}; }

template <class T>
concept Named = requires(T value) { namesOf(value); };

template <class T>
ColumnValue valueOf(const T& value) {
  if constexpr (Named<T>) {
    return std::string(namesOf(value).nameOf(value));
  } else if constexpr (std::is_integral_v<T>) {
    return static_cast<std::uint64_t>(value);
  } else {
    return value;
  }
}
ColumnValue valueOf(const ParameterValues& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", name, value);
  }
  return text;
}
template <class T>
ColumnValue valueOf(const std::optional<T>& value) {
  return value ? valueOf(*value) : ColumnValue();
}

std::string withSpaces(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

bool hasFrames(R result) {
  if (!result.timed()) return !result.frames.empty();
  return std::ranges::any_of(result.repetitions,
                             [](const Repetition& pass) { return !pass.frames.empty(); });
}

ColumnUnit unitOf(std::string_view key) {
  if (key.find("seconds") != key.npos) return ColumnUnit::seconds;
  return key.ends_with("_bytes") ? ColumnUnit::bytes : ColumnUnit::none;
}

JsonField optional(std::string path) { return {.path = std::move(path), .optional = true}; }
JsonField derived(std::string path) {
  return {.path = std::move(path), .optional = true, .derived = true};
}

/// A column with the value get(result) or get(result, summary). The title defaults to the key.
template <class Get>
CaseColumn computed(const std::string& key, std::string_view title, JsonField json, Get get,
                    ColumnDisplay shown = {}) {
  const std::string words = withSpaces(title.empty() ? key : title);
  if (shown.heading.empty()) shown.heading = words;
  return {.key = key,
          .title = words,
          .unit = unitOf(key),
          .json = std::move(json),
          .shown = std::move(shown),
          .value = [get](R result, S summary) {
            if constexpr (std::is_invocable_v<Get, R, S>) {
              return valueOf(std::invoke(get, result, summary));
            } else {
              return valueOf(std::invoke(get, result));
            }
          }};
}

/// A column for the member that get(result) refers to; its JSON path defaults to the key.
template <class Get>
CaseColumn stored(const std::string& key, std::string_view title, JsonField json, Get get,
                  ColumnDisplay shown = {}) {
  if (json.path.empty()) json.path = key;
  CaseColumn column = computed(key, title, std::move(json), get, std::move(shown));
  column.read = [get](const JsonFields& fields, const char* field, CaseResult& result) {
    auto& value = std::invoke(get, result);
    if constexpr (Named<std::remove_reference_t<decltype(value)>>) {
      value = fields.named(field, namesOf(value));
    } else {
      fields.read(field, value);
    }
  };
  return column;
}

/// A time of the summary.
CaseColumn summaryTime(const std::string& key, std::string_view title, const char* path,
                       double Summary::* time, ColumnDisplay shown) {
  shown.known = Availability::timed;
  shown.figure = true;
  shown.meaningful = hasFrames;
  const auto get = [time](R result, S summary) {
    return result.timed() ? std::optional(summary.*time) : std::nullopt;
  };
  return computed(key, title, derived(path), get, std::move(shown));
}

/// A bound of the interval around the mean.
CaseColumn ci95Bound(const std::string& key, std::string_view title, const char* path,
                     double Interval::* bound) {
  return computed(key, title, optional(path), [bound](R, S summary) {
    return summary.ci95 ? std::optional((*summary.ci95).*bound) : std::nullopt;
  });
}

ColumnDisplay wrongPairs(int place) {
  return {
      .known = Availability::checked, .terminal = place, .figure = true, .meaningful = hasFrames};
}

std::optional<double> meanInitialisation(R result) {
  if (!result.timed()) return std::nullopt;
  double sum = 0;
  for (const Repetition& repetition : result.repetitions) {
    sum += static_cast<double>(repetition.initialize_ns) * 1e-9;
  }
  return sum / static_cast<double>(result.repetitions.size());
}

/// Sorts recordings by number of bodies, unlike their ids.
ColumnValue recordingOrder(R result) {
  const SceneInfo& scene = result.recording.scene;
  return fmt::format("{}\n{}\n{:010}\n{:010}\n{}", scene.name, scene.object_type, scene.objects,
                     scene.frames, recordingId(result.recording));
}

/// Algorithm, recording and status.
std::vector<CaseColumn> identity() {
  const auto scene = [](auto member) {
    return [member](auto& r) -> auto& { return r.recording.scene.*member; };
  };
  const auto recording = [](auto member) {
    return [member](auto& r) -> auto& { return r.recording.*member; };
  };
  return {
      stored("id", "", {}, &CaseResult::id, {.frames = true}),
      computed("variant", "algorithm", {}, variantOf, {.csv = false, .inspector = 10}),
      computed("recording", "", {}, [](R r) { return recordingId(r.recording); },
               {.csv = false, .inspector = 20, .order = recordingOrder}),
      stored("scene", "", {"recording/name"}, scene(&SceneInfo::name), {.frames = true}),
      stored("object_type", "", {"recording/object_type"}, scene(&SceneInfo::object_type),
             {.frames = true}),
      stored("objects", "bodies", {"recording/objects"}, scene(&SceneInfo::objects),
             {.frames = true, .report = 30}),
      stored("algorithm", "", {}, &CaseResult::algorithm, {.frames = true, .terminal = 10}),
      stored("family", "", {}, &CaseResult::family, {.frames = true}),
      stored("isa", "instruction set", {}, &CaseResult::isa,
             {.frames = true,
              .terminal = 30,
              .inspector = 90,
              .report = 50,
              .rank = 3,
              .heading = "ISA",
              .meaningful = [](R r) { return r.vectorised; },
              .order = [](R r) { return valueOf(static_cast<int>(r.isa)); }}),
      computed("threads", "", {.path = "threads", .derived = true}, &CaseResult::threads,
               {.frames = true, .terminal = 20, .inspector = 100, .report = 40, .rank = 3}),
      computed("params", "parameters", {"params", JsonForm::joined}, &CaseResult::parameters,
               {.frames = true, .terminal = 40}),
      stored("frames", "", {"recording/frames"}, scene(&SceneInfo::frames)),
      stored("seed", "", optional("recording/seed"), recording(&RecordingReference::seed)),
      stored("recording_hash", "", {"recording/hash"}, recording(&RecordingReference::hash)),
      computed("recording_file", "", {"recording/source", JsonForm::text},
               recording(&RecordingReference::path)),
      computed("scene_params", "parameters of the scene", {"recording/source", JsonForm::joined},
               recording(&RecordingReference::scene_parameters)),
      computed("varied_params", "parameters that vary between the recordings",
               {.path = "recording/swept", .form = JsonForm::joined, .optional = true},
               recording(&RecordingReference::swept)),
      stored("device", "", {.optional = true, .if_missing = ""}, &CaseResult::device),
      stored("answer", "", {.optional = true, .if_missing = "pairs"}, &CaseResult::answer),
      stored("status", "", {}, &CaseResult::status,
             {.terminal = 130,
              .inspector = 30,
              .report = 120,
              .order = [](R r) { return valueOf(static_cast<int>(r.status)); }}),
      stored("reason", "", {}, &CaseResult::reason),
      computed("repetitions", "", {"initialize_ns", JsonForm::count},
               [](R r) { return r.repetitions.size(); }),
      computed("repetitions_asked", "repetitions asked for", optional("conditions/repetitions"),
               [](R r) { return r.conditions.repetitions; }),
      computed("check", "", optional("conditions/check"), [](R r) { return r.conditions.check; })};
}

std::vector<CaseColumn> times() {
  std::vector<CaseColumn> columns = {
      summaryTime("seconds_per_frame", "mean", "summary/seconds_per_frame",
                  &Summary::seconds_per_frame, {.terminal = 50, .inspector = 50, .report = 70}),
      summaryTime("median_seconds", "median", "summary/median", &Summary::median,
                  {.terminal = 60, .inspector = 40, .report = 80, .rank = 3}),
      summaryTime("p95_seconds", "95th percentile", "summary/p95", &Summary::p95,
                  {.terminal = 70, .inspector = 60, .report = 90, .rank = 2, .heading = "p95"}),
      summaryTime("p99_seconds", "99th percentile", "summary/p99", &Summary::p99, {}),
      summaryTime("min_seconds", "minimum", "summary/min", &Summary::min, {}),
      summaryTime("stddev_seconds", "standard deviation", "summary/stddev", &Summary::stddev, {}),
      ci95Bound("ci95_low_seconds", "lower end of the 95 % interval", "summary/ci95/0",
                &Interval::low),
      ci95Bound("ci95_high_seconds", "upper end of the 95 % interval", "summary/ci95/1",
                &Interval::high),
      computed("outliers", "", derived("summary/outliers"),
               [](R result, S summary) {
                 return result.timed() ? std::optional(summary.outliers) : std::nullopt;
               },
               {.known = Availability::timed, .figure = true}),
      computed("initialize_seconds", "initialisation", {"initialize_ns", JsonForm::seconds},
               meanInitialisation, {.known = Availability::timed, .figure = true})};
  for (const auto& [phase, name] : kPhases.entries) {
    if (phase == Phase::total) continue;  // covered by seconds_per_frame
    columns.push_back(computed(fmt::format("{}_seconds", name), name,
                               {fmt::format("frames/{}", name), JsonForm::seconds, true},
                               [phase](R r) { return r.meanSeconds(phase); },
                               {.particular = true}));
  }
  return columns;
}

std::vector<CaseColumn> counts() {
  std::vector<CaseColumn> columns = {
      stored("pairs_mean", "pairs", {"pairs/mean"}, &CaseResult::pairs_mean,
             {.terminal = 80,
              .inspector = 70,
              .report = 100,
              .rank = 3,
              .figure = true,
              .meaningful = hasFrames}),
      stored("pairs_max", "maximum of pairs", {"pairs/max"}, &CaseResult::pairs_max,
             {.figure = true}),
      computed("bodies_mean", "bodies present", optional("bodies/mean"),
               [](R r) { return r.bodies ? std::optional(r.bodies->mean) : std::nullopt; },
               {.particular = true}),
      computed("bodies_max", "maximum of bodies present", optional("bodies/max"),
               [](R r) { return r.bodies ? std::optional(r.bodies->max) : std::nullopt; },
               {.particular = true}),
      stored("missed", "", {}, &CaseResult::missed_count, wrongPairs(90)),
      // Early files have the sum of the next two, as "extra".
      computed("false", "", derived("false"), &CaseResult::false_count, wrongPairs(100)),
      computed("allowed_extra", "", derived("allowed_extra"), &CaseResult::allowed_extra_count,
               wrongPairs(110)),
      stored("invalid", "", {}, &CaseResult::invalid_count, wrongPairs(120)),
      computed("mismatches", "", {}, &CaseResult::mismatchedFrames,
               {.csv = false, .known = Availability::checked, .inspector = 80}),
      stored("peak_bytes", "memory", optional("peak_bytes"), &CaseResult::peak_bytes,
             {.report = 110, .rank = 3, .figure = true})};
  for (const auto& [counter, name] : kProcessorCounters.entries) {
    ColumnDisplay shown{.particular = true};
    // Shown instead of times where instructions are counted.
    if (counter == ProcessorCounter::instructions) shown.terminal = 65;
    columns.push_back(computed(
        fmt::format("{}_per_frame", name), "",
        {fmt::format("processor/{}", name), JsonForm::per_frame, true},
        [counter](R r) { return r.perFrame(counter); }, std::move(shown)));
  }
  return columns;
}

std::vector<CaseColumn> makeColumns() {
  std::vector<CaseColumn> columns = identity();
  for (const std::vector<CaseColumn>& more : {times(), counts()}) {
    columns.insert(columns.end(), more.begin(), more.end());
  }
  return columns;
}

}  // namespace

bool CaseColumn::isText() const { return std::holds_alternative<std::string>(value({}, {})); }

ColumnValue CaseColumn::valueOf(R result, S summary) const {
  if (shown.known == Availability::timed && result.repetitions.empty()) return {};
  if (shown.known == Availability::checked && !result.checked) return {};
  return value(result, summary);
}

ColumnValue CaseColumn::shownValueOf(R result, S summary) const {
  if (shown.meaningful != nullptr && !shown.meaningful(result)) return {};
  return valueOf(result, summary);
}

const std::vector<CaseColumn>& caseColumns() {
  static const std::vector<CaseColumn> columns = makeColumns();
  return columns;
}

std::vector<const CaseColumn*> caseColumns(int ColumnDisplay::* place) {
  std::vector<const CaseColumn*> columns;
  for (const CaseColumn& column : caseColumns()) {
    if (column.shown.*place > 0) columns.push_back(&column);
  }
  std::ranges::sort(columns, {}, [&](const CaseColumn* column) { return column->shown.*place; });
  return columns;
}

}  // namespace broadmark
