// The class around the algorithms `columns` and `tide`: what they trust their caller to do (changed
// bodies, finite boxes, a fixed number of bodies, one thread) is checked or done here.

#include "broadmark/broadphase.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "box_reader.h"
#include "broadmark/adapters.h"
#include "broadmark/broad_phase.h"
#include "broadmark/large_array.h"
#include "columns.h"
#include "queries/query_tree.h"
#include "query_checks.h"
#include "sorted_pairs.h"
#include "tide.h"

namespace broadmark::broadphase {
namespace {

static_assert(sizeof(Pair) == sizeof(broadmark::Pair));
static_assert(Filter::kNoTag == BodyGroups::kNoTag);

using Body = std::uint32_t;

std::span<const Pair> published(PairRun run) {
  return {reinterpret_cast<const Pair*>(run.data()), run.size()};
}

[[gnu::cold]] std::string numbered(const char* what, std::size_t number) {
  return std::string(what).append(" ").append(std::to_string(number));
}

Isa isaOf(InstructionSet set) {
  constexpr std::pair<InstructionSet, Isa> kIsaOf[] = {
      {InstructionSet::scalar, Isa::scalar}, {InstructionSet::sse2, Isa::sse2},
      {InstructionSet::neon, Isa::neon},     {InstructionSet::simd128, Isa::simd128},
      {InstructionSet::avx2, Isa::avx2},     {InstructionSet::avx512, Isa::avx512},
  };
  if (set == InstructionSet::best) return bestIsa();
  for (const auto& [option, isa] : kIsaOf) {
    if (option == set && isaSupported(isa)) return isa;
  }
  throw std::invalid_argument("instruction_set: not supported by this processor");
}

[[gnu::cold]] LayerMatrix matrixOf(const Options& options) {
  LayerMatrix matrix;
  for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
    for (std::size_t b = 0; b < LayerMatrix::kLayers; ++b) {
      const auto collide = [&](std::size_t row, std::size_t bit) {
        return (options.collides[row] >> bit & 1) != 0;
      };
      if (collide(a, b) != collide(b, a)) {
        throw std::invalid_argument("collides: not symmetric: " + numbered("layers", a) +
                                    numbered(" and", b));
      }
      matrix.set(a, b, collide(a, b));
    }
  }
  return matrix;
}

/// Throws unless `value` is a value of its enum, of which `last` is the last.
template <class Enum>
void checkChoice(Enum value, Enum last, const char* name) {
  if (static_cast<int>(value) < 0 || value > last) {
    throw std::invalid_argument(name +
                                (": invalid value " + std::to_string(static_cast<int>(value))));
  }
}

[[gnu::cold]] Options checked(const Options& options) {
  constexpr int kMaxThreads = 1024;
  checkChoice(options.method, Method::columns, "method");
  checkChoice(options.answer, Answer::events, "answer");
  checkChoice(options.order, Order::any, "order");
  checkChoice(options.changes, Changes::trusted, "changes");
  checkChoice(options.instruction_set, InstructionSet::simd128, "instruction_set");
  if (options.threads < 1 || options.threads > kMaxThreads) {
    throw std::invalid_argument("threads: must be 1 to " + std::to_string(kMaxThreads));
  }
  if (!(options.margin >= 0) || !std::isfinite(options.margin)) {
    throw std::invalid_argument("margin: must be finite and not negative");
  }
  return options;
}

/// Marks an object as being used by a call.
class Use {
 public:
  explicit Use(std::atomic<bool>& in_use) : in_use_(in_use) {
    if (in_use_.exchange(true, std::memory_order_acquire)) throwInUse();
  }
  ~Use() { in_use_.store(false, std::memory_order_release); }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

  [[noreturn]] static void throwInUse() {
    throw std::logic_error("a concurrent call on the same object, from another thread or a job");
  }

 private:
  std::atomic<bool>& in_use_;
};

/// What precedes a saved state's boxes, filters and events.
struct StateHeader {
  std::array<char, 8> magic = {'b', 'm', 's', 't', 'a', 't', 'e', '1'};
  std::uint32_t answer = 0;
  float margin = 0;
  std::array<std::uint32_t, 32> collides{};
  std::uint64_t bodies = 0;
  std::uint64_t filters = 0;
  std::uint64_t began = 0;
  std::uint64_t ended = 0;
};

/// A saved filter.
struct FilterBytes {
  std::uint32_t layer;
  std::array<std::uint32_t, 3> tags;
};
static_assert(std::has_unique_object_representations_v<FilterBytes>);

/// Copies values to `next`, and advances it.
template <class T>
void write(std::byte*& next, const T* values, std::size_t count) {
  if (count > 0) std::memcpy(next, values, count * sizeof(T));
  next += count * sizeof(T);
}

}  // namespace

/// The caller's job system, which must run each job once.
class CheckedJobs {
 public:
  CheckedJobs(ParallelFor parallel_for, int jobs)
      : parallel_for_(std::move(parallel_for)), started_(static_cast<std::size_t>(jobs)) {}

  void run(int jobs, const std::function<void(int)>& job) {
    for (std::atomic<bool>& started : started_) started = false;
    finished_ = 0;
    misused_ = false;
    jobs_ = jobs;
    job_ = &job;
    parallel_for_(jobs, [this](int i) { runJob(i); });
    if (misused_ || finished_ != jobs) {
      throw std::logic_error(
          "parallel_for: must call the job exactly once for each number, and return afterwards");
    }
  }

 private:
  void runJob(int i) {
    if (i < 0 || i >= jobs_ || started_[static_cast<std::size_t>(i)].exchange(true)) {
      misused_ = true;
      return;
    }
    (*job_)(i);
    ++finished_;
  }

  ParallelFor parallel_for_;
  const std::function<void(int)>* job_ = nullptr;
  int jobs_ = 0;  ///< in this run; up to the size of started_
  std::vector<std::atomic<bool>> started_;
  std::atomic<int> finished_{0};
  std::atomic<bool> misused_{false};
};

class BroadPhase::Implementation {
 public:
  [[gnu::cold]] explicit Implementation(const Options& options)
      : options_(checked(options)),
        isa_(isaOf(options.instruction_set)),
        matrix_(matrixOf(options)) {
    derives_pairs_from_events_ = options_.answer == Answer::pairs &&
                                 options_.method == Method::tide && options_.order == Order::sorted;
  }

  void update(const Boxes& boxes, std::optional<std::span<const Body>> listed);
  void setFilter(Body body, const Filter& filter);
  void requireWhole() const {
    if (failed_) throw std::logic_error("an update has failed: only restore() is allowed");
  }
  std::span<const Pair> answer(Answer kind, const PairRun& run) const {
    if (in_use_.load(std::memory_order_acquire)) Use::throwInUse();
    requireWhole();
    if (options_.answer != kind) {
      throw std::logic_error(kind == Answer::pairs ? "the answer is events: use began() and ended()"
                                                   : "the answer is pairs: use pairs()");
    }
    return published(run);
  }
  std::span<const Pair> pairs() const { return answer(Answer::pairs, pairs_run_); }
  std::span<const Pair> began() const { return answer(Answer::events, began_run_); }
  std::span<const Pair> ended() const { return answer(Answer::events, ended_run_); }
  template <class Query, class T, class Answer>
  void query(std::span<const Query> queries, QueryResults<T>& results, Answer answer);
  std::size_t size() const { return size_; }
  void save(std::vector<std::byte>& state) const;
  void restore(std::span<const std::byte> state);

 private:
  [[nodiscard]] bool usesEvents() const {
    return options_.answer == Answer::events || derives_pairs_from_events_;
  }

  void detectChanges(const BoxReader& boxes, std::size_t count);
  void checkListed(std::span<const Body> listed, std::size_t count);
  void selectListed(const BoxReader& boxes, std::span<const Body> listed, std::size_t count);
  void checkChanged(const BoxReader& boxes, std::size_t count);
  void apply(const BoxReader& boxes, std::size_t count);
  void storeChanged(const BoxReader& boxes, std::size_t count);
  // These are rare, and take less space so.
  [[gnu::cold]] void resizeSlots(std::size_t count);
  [[gnu::cold]] void createInstance();
  [[gnu::cold]] void createExecution();
  void assign(PairRuns runs, PairArray& into, PairRun& run) const;
  void runFrame();
  void takeAnswer();
  void takeEvents(PairRuns began, PairRuns ended);
  [[nodiscard, gnu::cold]] PairArray initialPairs();
  [[nodiscard]] std::size_t filterCount() const;

  Options options_;
  Isa isa_;
  LayerMatrix matrix_;
  /// Keeping ascending pairs by means of the events costs nothing where nothing moves.
  bool derives_pairs_from_events_;

  mutable std::atomic<bool> in_use_{false};
  bool failed_ = false;  ///< an update was not finished

  std::size_t size_ = 0;
  bool has_answer_ = false;
  std::vector<Filter> filters_;  ///< default beyond the end
  bool filters_changed_ = false;
  std::vector<Aabb> boxes_;    ///< by slot; those from size_ on are empty
  std::vector<Body> changed_;  ///< ascending
  bool vanishes_ = false;      ///< one of the changed bodies is absent now
  std::vector<Body> listed_;   ///< ascending

  /// All bodies are present, and their number is fixed, which the algorithms make use of.
  bool all_present_ = true;
  CollisionFilter filter_;  ///< of all slots
  std::optional<CheckedJobs> jobs_;
  std::unique_ptr<ExecutionContext> execution_;
  std::unique_ptr<broadmark::BroadPhase> instance_;  ///< null: to be created
  std::uint32_t frame_ = 0;
  std::unique_ptr<QueryTree> queries_;  ///< null before the first query

  PairArray pairs_;
  PairArray began_;
  PairArray ended_;
  PairRun pairs_run_;
  PairRun began_run_;
  PairRun ended_run_;
};

// Which bodies changed.

void BroadPhase::Implementation::detectChanges(const BoxReader& boxes, std::size_t count) {
  const std::size_t known = std::min(count, boxes_.size());
  changed_.resize(std::max(count, size_));
  std::size_t changes = 0;
  for (std::size_t body = 0; body < known; ++body) {
    changed_[changes] = static_cast<Body>(body);
    changes += boxes.differs(body, boxes_[body]) ? 1 : 0;
  }
  for (std::size_t body = known; body < count; ++body)
    changed_[changes++] = static_cast<Body>(body);
  for (std::size_t body = count; body < size_; ++body) {
    changed_[changes] = static_cast<Body>(body);
    changes += isEmpty(boxes_[body]) ? 0 : 1;
  }
  changed_.resize(changes);
}

/// The changed bodies must be listed, except new ones and those beyond the end.
void BroadPhase::Implementation::checkListed(std::span<const Body> listed, std::size_t count) {
  listed_.assign(listed.begin(), listed.end());
  if (!std::ranges::is_sorted(listed_)) std::ranges::sort(listed_);
  if (!listed_.empty() && listed_.back() >= count) {
    throw std::invalid_argument("changed: " + numbered("no body", listed_.back()) +
                                numbered(": there are", count));
  }
  if (options_.changes == Changes::trusted) return;
  auto next = listed_.begin();
  for (const Body body : changed_) {
    if (body >= std::min(count, size_)) break;
    while (next != listed_.end() && *next < body) ++next;
    if (next == listed_.end() || *next != body) {
      throw std::invalid_argument("changed: " + numbered("body", body) +
                                  " is not listed, but its box has changed");
    }
  }
}

void BroadPhase::Implementation::selectListed(const BoxReader& boxes, std::span<const Body> listed,
                                              std::size_t count) {
  checkListed(listed, count);
  changed_.clear();
  const std::size_t known = std::min(count, size_);
  for (const Body body : listed_) {
    if (body >= known) break;
    if (!changed_.empty() && changed_.back() == body) continue;
    if (boxes.differs(body, boxes_[body])) changed_.push_back(body);
  }
  for (std::size_t body = known; body < count; ++body) changed_.push_back(static_cast<Body>(body));
  for (std::size_t body = count; body < size_; ++body) {
    if (!isEmpty(boxes_[body])) changed_.push_back(static_cast<Body>(body));
  }
}

void BroadPhase::Implementation::checkChanged(const BoxReader& boxes, std::size_t count) {
  bool valid = true;
  vanishes_ = false;
  for (const Body body : changed_) {
    const Aabb box = body < count ? boxes.raw(body) : broadmark::kEmptyBox;
    valid &= isValid(box);
    vanishes_ |= isEmpty(box);
  }
  if (valid) return;
  for (const Body body : changed_) {
    const Aabb box = boxes.raw(body);
    if (isValid(box)) continue;
    const std::string fault = faultOf(box);
    throw std::invalid_argument(numbered("body", body) + ": " + fault +
                                (fault == "min > max" ? "; absent bodies have kNoBox" : ""));
  }
}

// Updates.

void BroadPhase::Implementation::update(const Boxes& boxes,
                                        std::optional<std::span<const Body>> listed) {
  const Use use(in_use_);
  requireWhole();
  if (boxes.count > kMaxBodies) {
    throw std::invalid_argument(numbered("", boxes.count).substr(1) + " bodies: at most " +
                                std::to_string(kMaxBodies) + " are supported");
  }
  if (boxes.count > 0 && (boxes.min == nullptr || boxes.max == nullptr)) {
    throw std::invalid_argument("boxes: must not be null");
  }
  if (boxes.count > 1 && boxes.stride < 3 * sizeof(float)) {
    throw std::invalid_argument("boxes: the stride must be at least three floats");
  }
  const BoxReader reader(boxes.min, boxes.max, boxes.stride, options_.margin);
  if (listed && options_.changes == Changes::trusted) {
    selectListed(reader, *listed, boxes.count);
  } else {
    detectChanges(reader, boxes.count);
    if (listed) checkListed(*listed, boxes.count);
  }
  checkChanged(reader, boxes.count);
  failed_ = true;
  apply(reader, boxes.count);
  failed_ = false;
}

/// Applies the changes. What the algorithms do not support, another number of slots or another
/// filter, needs a new instance.
void BroadPhase::Implementation::apply(const BoxReader& boxes, std::size_t count) {
  const bool is_first = instance_ == nullptr;
  const bool outgrown = count > boxes_.size() || (all_present_ && (vanishes_ || count != size_));
  if (!is_first && !filters_changed_ && !outgrown) {
    storeChanged(boxes, count);
    runFrame();
    takeAnswer();
    return;
  }
  if (is_first && count == 0) {
    storeChanged(boxes, count);
    pairs_run_ = began_run_ = ended_run_ = {};
    filters_changed_ = false;
    has_answer_ = true;
    return;
  }

  const bool diffs_events = !is_first && filters_changed_ && options_.answer == Answer::events;
  PairArray before;
  if (diffs_events) before = initialPairs();
  instance_.reset();
  if (is_first) {
    all_present_ = !vanishes_ && std::ranges::none_of(boxes_, isEmpty);
  } else if (outgrown) {
    all_present_ = false;
  }
  resizeSlots(count);
  if (!is_first && !filters_changed_) {
    createInstance();  // with the boxes of the update before
    storeChanged(boxes, count);
    runFrame();
    takeAnswer();
    return;
  }
  storeChanged(boxes, count);
  filters_changed_ = false;
  createInstance();
  if (!usesEvents()) {
    changed_.clear();
    runFrame();
    takeAnswer();
    return;
  }
  const PairEvents initial = instance_->events();
  if (options_.answer == Answer::pairs) {
    pairs_.assignSorted(initial.began, boxes_.size());
    pairs_run_ = pairs_.run();
  } else if (diffs_events) {
    PairArray now;
    now.assignSorted(initial.began, boxes_.size());
    began_.assignDifference(now.run(), before.run());
    ended_.assignDifference(before.run(), now.run());
    began_run_ = began_.run();
    ended_run_ = ended_.run();
  } else {
    takeEvents(initial.began, {});
  }
  has_answer_ = true;
}

/// All pairs of the stored boxes, ascending.
PairArray BroadPhase::Implementation::initialPairs() {
  createInstance();
  PairArray pairs;
  pairs.assignSorted(instance_->events().began, boxes_.size());
  return pairs;
}

void BroadPhase::Implementation::storeChanged(const BoxReader& boxes, std::size_t count) {
  if (queries_ != nullptr) queries_->markDirty(changed_);
  for (const Body body : changed_) {
    if (body < count) {
      boxes.store(body, boxes_[body]);
    } else {
      boxes_[body] = broadmark::kEmptyBox;
    }
  }
  size_ = count;
}

/// Exactly `count` if all bodies are present, else with room for more.
void BroadPhase::Implementation::resizeSlots(std::size_t count) {
  if (all_present_) {
    boxes_.resize(count, broadmark::kEmptyBox);
  } else if (count > boxes_.size() || boxes_.size() < size_ + 1) {
    boxes_.resize(std::min(kMaxBodies, std::max(count, size_) + count / 4 + 64),
                  broadmark::kEmptyBox);
  }
  changed_.reserve(boxes_.size());
  listed_.reserve(boxes_.size());
  std::vector<BodyGroups> groups(boxes_.size());
  for (std::size_t body = 0; body < std::min(filters_.size(), groups.size()); ++body) {
    groups[body].layer = static_cast<std::uint8_t>(filters_[body].layer);
    groups[body].tags = filters_[body].tags;
  }
  filter_ = CollisionFilter(groups, matrix_);
  if (queries_ != nullptr) queries_->markAllDirty();
}

void BroadPhase::Implementation::createExecution() {
  const int threads = options_.threads;
  if (execution_ != nullptr) return;
  if (threads > 1 && options_.parallel_for) {
    jobs_.emplace(options_.parallel_for, threads);
    execution_ = std::make_unique<ExecutionContext>(
        threads, isa_,
        [this](int jobs, const std::function<void(int)>& job) { jobs_->run(jobs, job); });
  } else {
    execution_ = std::make_unique<ExecutionContext>(threads, isa_);
  }
}

void BroadPhase::Implementation::createInstance() {
  SceneInfo scene;
  scene.objects = static_cast<std::uint32_t>(boxes_.size());
  scene.frames = std::numeric_limits<std::uint32_t>::max();
  scene.all_present = all_present_;
  scene.filter = filter_;
  scene.world = boxes_[0];
  for (const Aabb& box : boxes_) scene.world = merged(scene.world, box);
  if (isEmpty(scene.world)) scene.world = {};

  instance_.reset();
  createExecution();
  if (options_.method == Method::tide) {
    instance_ = tide::create();
    if (usesEvents()) instance_->reportEvents();
  } else {
    instance_ = columns::create();
    if (isChangingWorld(scene)) instance_ = compacted(std::move(instance_));
    if (usesEvents()) instance_ = withEvents(std::move(instance_));
  }
  frame_ = 0;
  instance_->initialize(scene, {frame_, boxes_, std::span<const Body>()}, *execution_);
}

void BroadPhase::Implementation::runFrame() {
  instance_->updateObjects({++frame_, boxes_, changed_});
  instance_->cleanCache();
  instance_->updateStructures();
  instance_->searchOverlaps();
}

// Answers.

void BroadPhase::Implementation::assign(PairRuns runs, PairArray& into, PairRun& run) const {
  if (options_.order == Order::any && runs.size() == 1) {
    run = runs[0];
    return;
  }
  if (options_.order == Order::any) {
    into.assign(runs);
  } else {
    into.assignSorted(runs, boxes_.size());
  }
  run = into.run();
}

void BroadPhase::Implementation::takeEvents(PairRuns began, PairRuns ended) {
  assign(began, began_, began_run_);
  assign(ended, ended_, ended_run_);
}

void BroadPhase::Implementation::takeAnswer() {
  if (!usesEvents()) {
    assign(instance_->overlaps(), pairs_, pairs_run_);
  } else {
    const PairEvents events = instance_->events();
    takeEvents(events.began, events.ended);
    if (derives_pairs_from_events_) {
      pairs_.apply(began_run_, ended_run_);
      pairs_run_ = pairs_.run();
    }
  }
  has_answer_ = true;
}

void BroadPhase::Implementation::setFilter(Body body, const Filter& filter) {
  const Use use(in_use_);
  requireWhole();
  if (body >= kMaxBodies) {
    throw std::invalid_argument(numbered("body", body) +
                                numbered(": the last one is", kMaxBodies - 1));
  }
  if (filter.layer >= LayerMatrix::kLayers) {
    throw std::invalid_argument(numbered("layer", filter.layer) + ": there are layers 0 to 31");
  }
  const Filter present = body < filters_.size() ? filters_[body] : Filter{};
  if (filter == present) return;
  if (body >= filters_.size()) filters_.resize(body + std::size_t{1});
  filters_[body] = filter;
  filters_changed_ = true;
}

// Queries.

/// By the function of QueryTree, which is given the queries, `results` and threads.
template <class Query, class T, class Answer>
void BroadPhase::Implementation::query(std::span<const Query> queries, QueryResults<T>& results,
                                       Answer answer) {
  const Use use(in_use_);
  requireWhole();
  checkQueries(queries);
  if (boxes_.empty() || execution_ == nullptr) {  // no body is present
    results.items.clear();
    results.starts.assign(queries.size() + 1, 0);
    return;
  }
  if (queries_ == nullptr) queries_ = std::make_unique<QueryTree>(isa_);
  queries_->refresh({boxes_, filter_}, execution_->team());
  answer(*queries_, execution_->team());
}

// States. Boxes are saved as stored, with their margin, so that they are restored exactly.

/// Without default ones at the end.
std::size_t BroadPhase::Implementation::filterCount() const {
  std::size_t count = filters_.size();
  while (count > 0 && filters_[count - 1] == Filter{}) --count;
  return count;
}

void BroadPhase::Implementation::save(std::vector<std::byte>& state) const {
  const Use use(in_use_);
  requireWhole();
  if (filters_changed_ && has_answer_) {
    throw std::logic_error("save: filters have been set since the last update: update first");
  }
  StateHeader header;
  header.answer = static_cast<std::uint32_t>(options_.answer);
  header.margin = options_.margin + 0.0F;  // no -0
  header.collides = options_.collides;
  header.bodies = size_;
  header.filters = filterCount();
  header.began = began_run_.size();
  header.ended = ended_run_.size();
  if (options_.answer == Answer::pairs) header.began = header.ended = 0;
  state.resize(sizeof(StateHeader) + size_ * sizeof(Box) + header.filters * sizeof(FilterBytes) +
               (header.began + header.ended) * sizeof(Pair));
  std::byte* next = state.data();
  write(next, &header, 1);
  for (std::size_t body = 0; body < size_; ++body) {
    write(next, boxes_[body].min.data(), 3);
    write(next, boxes_[body].max.data(), 3);
  }
  for (std::size_t body = 0; body < header.filters; ++body) {
    const FilterBytes filter = {filters_[body].layer, filters_[body].tags};
    write(next, &filter, 1);
  }
  write(next, began_run_.data(), header.began);
  write(next, ended_run_.data(), header.ended);
}

/// An update to the saved boxes.
void BroadPhase::Implementation::restore(std::span<const std::byte> state) {
  const Use use(in_use_);
  StateHeader header;
  const StateHeader expected;
  if (state.size() < sizeof(header)) throw std::invalid_argument("state: too few bytes");
  std::memcpy(&header, state.data(), sizeof(header));
  if (header.magic != expected.magic)
    throw std::invalid_argument("state: not saved by this library");
  if (header.answer != static_cast<std::uint32_t>(options_.answer) ||
      header.margin != options_.margin || header.collides != options_.collides) {
    throw std::invalid_argument("state: saved with another answer, margin or layers");
  }
  std::size_t left = state.size() - sizeof(header);
  const std::byte* next = state.data() + sizeof(header);
  const auto take = [&](std::uint64_t count, std::size_t size) {
    if (count > left / size) throw std::invalid_argument("state: too few bytes");
    left -= count * size;
    return std::exchange(next, next + count * size);
  };
  const std::byte* const boxes = take(header.bodies, sizeof(Box));
  const std::byte* const filter_bytes = take(header.filters, sizeof(FilterBytes));
  const std::byte* const events[] = {take(header.began, sizeof(Pair)),
                                     take(header.ended, sizeof(Pair))};
  if (left != 0) throw std::invalid_argument("state: too many bytes");
  if (header.bodies > kMaxBodies) throw std::invalid_argument("state: too many bodies");
  std::vector<Filter> filters(header.filters);
  for (std::size_t body = 0; body < filters.size(); ++body) {
    FilterBytes filter;
    std::memcpy(&filter, filter_bytes + body * sizeof(filter), sizeof(filter));
    if (filter.layer >= LayerMatrix::kLayers) throw std::invalid_argument("state: no such layer");
    filters[body] = {filter.layer, filter.tags};
  }
  PairArray saved[2];
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<broadmark::Pair> pairs(i == 0 ? header.began : header.ended);
    if (!pairs.empty()) std::memcpy(pairs.data(), events[i], pairs.size() * sizeof(Pair));
    for (const broadmark::Pair pair : pairs) {
      if (pair.a >= pair.b || pair.b >= kMaxBodies)
        throw std::invalid_argument("state: invalid pair");
    }
    const PairRun run = pairs;
    saved[i].assign({&run, 1});
  }
  const auto count = static_cast<std::size_t>(header.bodies);
  const BoxReader reader(boxes, boxes + 3 * sizeof(float), sizeof(Box), 0);
  detectChanges(reader, count);
  checkChanged(reader, count);

  filters_.resize(filterCount());
  if (failed_ || filters_changed_ || filters != filters_) instance_.reset();
  failed_ = true;
  filters_ = std::move(filters);
  filters_changed_ = false;
  apply(reader, count);
  if (options_.answer == Answer::events) {
    began_ = std::move(saved[0]);
    ended_ = std::move(saved[1]);
    began_run_ = began_.run();
    ended_run_ = ended_.run();
  }
  failed_ = false;
}

// The public class.

BroadPhase::BroadPhase(const Options& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
BroadPhase::~BroadPhase() = default;
BroadPhase::BroadPhase(BroadPhase&&) noexcept = default;
BroadPhase& BroadPhase::operator=(BroadPhase&&) noexcept = default;

BroadPhase::Implementation& BroadPhase::implementation() const {
  if (implementation_ == nullptr) throw std::logic_error("use of a moved-from BroadPhase");
  return *implementation_;
}

void BroadPhase::update(const Boxes& boxes) { implementation().update(boxes, std::nullopt); }
void BroadPhase::update(const Boxes& boxes, std::span<const std::uint32_t> changed) {
  implementation().update(boxes, changed);
}
void BroadPhase::setFilter(std::uint32_t body, const Filter& filter) {
  implementation().setFilter(body, filter);
}
std::span<const Pair> BroadPhase::pairs() const { return implementation().pairs(); }
std::span<const Pair> BroadPhase::began() const { return implementation().began(); }
std::span<const Pair> BroadPhase::ended() const { return implementation().ended(); }
void BroadPhase::overlapping(std::span<const BoxQuery> queries,
                             QueryResults<std::uint32_t>& results) {
  implementation().query(queries, results, [&](QueryTree& tree, ThreadTeam& team) {
    tree.overlapping(queries, results, team);
  });
}
void BroadPhase::cast(std::span<const Cast> casts, Hits hits, QueryResults<CastHit>& results) {
  checkChoice(hits, Hits::all, "hits");
  implementation().query(casts, results, [&](QueryTree& tree, ThreadTeam& team) {
    tree.cast(casts, hits, results, team);
  });
}
void BroadPhase::nearest(std::span<const NearestQuery> queries, QueryResults<Neighbour>& results) {
  implementation().query(queries, results, [&](QueryTree& tree, ThreadTeam& team) {
    tree.nearest(queries, results, team);
  });
}
std::size_t BroadPhase::size() const { return implementation().size(); }
void BroadPhase::save(std::vector<std::byte>& state) const { implementation().save(state); }
void BroadPhase::restore(std::span<const std::byte> state) { implementation().restore(state); }

}  // namespace broadmark::broadphase
