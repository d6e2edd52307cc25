// Events for algorithms that report only the set of pairs of each frame.
//
// The pairs of a frame are radix-sorted and merged with the pairs of the frame before: a pair in
// only one of the two lists has begun or ended. O(k) for k pairs; many are divided among the team's
// workers by the lower body. A steady state allocates nothing.

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

#include "adapters/adapter.h"
#include "adapters/workers_for_pairs.h"
#include "broadmark/adapters.h"

namespace broadmark {
namespace {

/// Converts an algorithm's answers to events at the end of phase 4. Faults in an answer become
/// events, too: a pair reported twice begins twice, an invalid pair begins in every frame.
class EventsFromPairs final : public Adapter {
 public:
  explicit EventsFromPairs(std::unique_ptr<BroadPhase> algorithm) : Adapter(std::move(algorithm)) {}

  /// Finds the pairs of the initial pose as in a frame without changes.
  [[gnu::cold]] void initialize(const SceneInfo& scene, const Frame& first,
                                ExecutionContext& execution) override {
    team_ = &execution.team();
    bodies_ = first.boxes.size();
    body_bits_ = static_cast<int>(std::bit_width(bodies_));
    shares_ = std::vector<WorkerPairs>(static_cast<std::size_t>(team_->size()));
    for (WorkerPairs& own : shares_) own.found.resize(shares_.size());
    began_.reserve(shares_.size());
    ended_.reserve(shares_.size());
    algorithm_->initialize(scene, first, execution);
    updateObjects(first);
    cleanCache();
    updateStructures();
    searchOverlaps();
  }
  void updateObjects(const Frame& frame) override { algorithm_->updateObjects(frame); }
  void searchOverlaps() override {
    algorithm_->searchOverlaps();
    const PairRuns answer = algorithm_->overlaps();
    chooseWorkers(answer);
    const int workers = static_cast<int>(used_workers_);
    team_->runOn(workers,
                 [&](int worker) { distribute(answer, static_cast<std::size_t>(worker)); });
    team_->runOn(workers, [&](int worker) {
      gather(static_cast<std::size_t>(worker));
      sort(shares_[static_cast<std::size_t>(worker)]);
      compare(shares_[static_cast<std::size_t>(worker)]);
    });
    began_.resize(used_workers_);
    ended_.resize(used_workers_);
    for (std::size_t worker = 0; worker < used_workers_; ++worker) {
      began_[worker] = shares_[worker].began.run();
      ended_[worker] = shares_[worker].ended.run();
    }
  }
  [[nodiscard]] PairEvents events() const override { return {began_, ended_}; }
  void visitCounters(const CounterVisitor& visit) const override {
    visit("pairs begun", pairCount(began_));
    visit("pairs ended", pairCount(ended_));
    algorithm_->visitCounters(visit);
  }

 private:
  /// Pairs encoded as integers in the same order.
  using Keys = std::vector<std::uint64_t>;
  /// The pairs owned by a worker.
  struct alignas(64) WorkerPairs {
    std::vector<Keys> found;  ///< in the worker's share of the answer, by owner
    Keys now;                 ///< ascending, once sorted
    Keys before;              ///< the same for the previous frame
    Keys spare;               ///< for sorting
    PairBuffer began;
    PairBuffer ended;
  };

  [[nodiscard]] std::uint64_t keyOf(Pair pair) const {
    return std::uint64_t{pair.a} << body_bits_ | pair.b;
  }
  [[nodiscard]] std::uint32_t lowerBody(std::uint64_t key) const {
    return static_cast<std::uint32_t>(key >> body_bits_);
  }

  /// One worker or all: another number moves the pairs of the previous frame to other owners.
  void chooseWorkers(PairRuns answer) {
    constexpr double kPairNs = 25;
    constexpr double kHysteresis = 2;
    const double pair_ns = kPairNs * (used_workers_ > 1 ? kHysteresis : 1);
    const std::size_t workers = workersForPairs(answer, pair_ns, *team_) > 1 ? shares_.size() : 1;
    if (workers == used_workers_) return;
    Keys& all = shares_[0].spare;
    all.clear();
    for (std::size_t worker = 0; worker < used_workers_; ++worker) {
      Keys& now = shares_[worker].now;
      all.insert(all.end(), now.begin(), now.end());
      now.clear();
    }
    std::ranges::sort(all);
    used_workers_ = workers;
    for (const std::uint64_t key : all) shares_[ownerOf(lowerBody(key))].now.push_back(key);
  }

  /// Blocks of bodies are assigned round-robin: low ids are the lower body of more pairs than high
  /// ids.
  [[nodiscard]] std::size_t ownerOf(std::uint32_t lower_body) const {
    constexpr std::uint32_t kBlock = 64;
    if (used_workers_ == 1) return 0;
    return lower_body / kBlock % static_cast<std::uint32_t>(used_workers_);
  }

  void distribute(PairRuns answer, std::size_t worker) {
    WorkerPairs& own = shares_[worker];
    for (Keys& found : std::span(own.found).first(used_workers_)) found.clear();
    own.began.clear();
    own.ended.clear();
    auto [begin, end] =
        share(pairCount(answer), static_cast<int>(used_workers_), static_cast<int>(worker));
    for (const PairRun chunk : answer) {
      const std::size_t first = std::min(begin, chunk.size());
      const std::size_t last = std::min(end, chunk.size());
      for (const Pair pair : chunk.subspan(first, last - first)) {
        if (pair.a < pair.b && pair.b < bodies_) [[likely]] {
          own.found[ownerOf(pair.a)].push_back(keyOf(pair));
        } else {
          *own.began.room(1) = pair;  // keeps an invalid pair invalid
          own.began.advance(1);
        }
      }
      begin -= first;
      end -= last;
    }
  }

  void gather(std::size_t worker) {
    WorkerPairs& own = shares_[worker];
    own.now.swap(own.before);
    own.now.clear();
    for (const WorkerPairs& source : std::span(shares_).first(used_workers_)) {
      own.now.insert(own.now.end(), source.found[worker].begin(), source.found[worker].end());
    }
  }

  void sort(WorkerPairs& own) const {
    constexpr int kDigitBits = 11;
    constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
    constexpr std::size_t kMinForRadixSort = 512;  // below this a comparison sort is faster
    if (own.now.size() < kMinForRadixSort) {
      std::ranges::sort(own.now);
      return;
    }
    own.spare.resize(own.now.size());
    for (int shift = 0; shift < 2 * body_bits_; shift += kDigitBits) {
      const auto digit = [shift](std::uint64_t key) { return key >> shift & (kDigits - 1); };
      std::array<std::size_t, kDigits> offsets{};
      for (const std::uint64_t key : own.now) ++offsets[digit(key)];
      std::size_t end = 0;
      for (std::size_t& offset : offsets) end += std::exchange(offset, end);
      for (const std::uint64_t key : own.now) own.spare[offsets[digit(key)]++] = key;
      own.now.swap(own.spare);
    }
  }

  void compare(WorkerPairs& own) const {
    const auto add = [this](std::uint64_t key, PairBuffer& pairs) {
      const std::uint64_t mask = (std::uint64_t{1} << body_bits_) - 1;
      pairs.add(lowerBody(key), static_cast<std::uint32_t>(key & mask));
    };
    auto before = own.before.begin();
    for (const std::uint64_t key : own.now) {
      for (; before != own.before.end() && *before < key; ++before) add(*before, own.ended);
      if (before != own.before.end() && *before == key) {
        ++before;
      } else {
        add(key, own.began);
      }
    }
    for (; before != own.before.end(); ++before) add(*before, own.ended);
  }

  ThreadTeam* team_ = nullptr;
  std::size_t bodies_ = 0;
  int body_bits_ = 0;                ///< bits per body id
  std::vector<WorkerPairs> shares_;  ///< by worker
  std::size_t used_workers_ = 1;
  std::vector<PairRun> began_;
  std::vector<PairRun> ended_;
};

}  // namespace

std::unique_ptr<BroadPhase> withEvents(std::unique_ptr<BroadPhase> algorithm) {
  return std::make_unique<EventsFromPairs>(std::move(algorithm));
}

}  // namespace broadmark
