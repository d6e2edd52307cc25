// Events, for algorithms that know only the set of pairs of each frame.
//
// The pairs of a frame are sorted, by radix, and merged with those of the frame before: what is in
// one of the two lists only has begun or ended. O(k), k the pairs, shared out over the team by the
// lower body. A steady state allocates nothing.

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "broadmark/adapters.h"

namespace broadmark {
namespace {

/// Wraps an algorithm, whose answers it turns into events at the end of phase 4. A fault in an
/// answer is one of the events, too: a pair reported twice begins twice, one that is none begins in
/// every frame.
class EventsFromPairs final : public BroadPhase {
 public:
  explicit EventsFromPairs(std::unique_ptr<BroadPhase> algorithm)
      : algorithm_(std::move(algorithm)) {}

  void visitParameters(const ParameterVisitor& visit) override {
    algorithm_->visitParameters(visit);
  }
  [[nodiscard]] float margin() const override { return algorithm_->margin(); }
  /// The pairs of the initial pose are found as those of a frame in which nothing changed.
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    team_ = &execution.team();
    bodies_ = first.boxes.size();
    body_bits_ = static_cast<int>(std::bit_width(bodies_));
    parts_ = std::vector<Part>(static_cast<std::size_t>(team_->size()));
    for (Part& part : parts_) part.found.resize(parts_.size());
    began_.resize(parts_.size());
    ended_.resize(parts_.size());
    algorithm_->initialize(scene, first, execution);
    updateObjects(first);
    cleanCache();
    updateStructures();
    searchOverlaps();
  }
  void updateObjects(const Frame& frame) override { algorithm_->updateObjects(frame); }
  void cleanCache() override { algorithm_->cleanCache(); }
  void updateStructures() override { algorithm_->updateStructures(); }
  void searchOverlaps() override {
    algorithm_->searchOverlaps();
    const PairRuns answer = algorithm_->overlaps();
    team_->run([&](int worker) { shareOut(answer, static_cast<std::size_t>(worker)); });
    team_->run([&](int worker) {
      gather(static_cast<std::size_t>(worker));
      sort(parts_[static_cast<std::size_t>(worker)]);
      compare(parts_[static_cast<std::size_t>(worker)]);
    });
    for (std::size_t worker = 0; worker < parts_.size(); ++worker) {
      began_[worker] = parts_[worker].began.run();
      ended_[worker] = parts_[worker].ended.run();
    }
  }
  [[nodiscard]] PairRuns overlaps() const override { return algorithm_->overlaps(); }
  [[nodiscard]] PairEvents events() const override { return {began_, ended_}; }
  [[nodiscard]] TransferTimes transfers() const override { return algorithm_->transfers(); }
  void drawStructure(DebugDraw& draw) const override { algorithm_->drawStructure(draw); }
  void visitCounters(const CounterVisitor& visit) const override {
    visit("pairs begun", pairCount(began_));
    visit("pairs ended", pairCount(ended_));
    algorithm_->visitCounters(visit);
  }
  void visitSetup(const CounterVisitor& visit) const override { algorithm_->visitSetup(visit); }
  [[nodiscard]] std::string validate() const override { return algorithm_->validate(); }

 private:
  /// Pairs as numbers, which sort as they do.
  using Keys = std::vector<std::uint64_t>;
  /// A worker's: the pairs of its bodies.
  struct alignas(64) Part {
    std::vector<Keys> found;  ///< in the worker's share of the answer, by whose they are
    Keys now;                 ///< ascending, once sorted
    Keys before;              ///< likewise
    Keys spare;               ///< for sorting
    PairBuffer began;
    PairBuffer ended;
  };

  [[nodiscard]] std::uint64_t keyOf(Pair pair) const {
    return std::uint64_t{pair.a} << body_bits_ | pair.b;
  }

  /// Of every so many blocks of bodies one: low numbers are lower bodies more often than high ones.
  [[nodiscard]] std::size_t ownerOf(Pair pair) const {
    constexpr std::uint32_t kBlock = 64;
    if (parts_.size() == 1) return 0;
    return pair.a / kBlock % static_cast<std::uint32_t>(parts_.size());
  }

  void shareOut(PairRuns answer, std::size_t worker) {
    Part& part = parts_[worker];
    for (Keys& found : part.found) found.clear();
    part.began.clear();
    part.ended.clear();
    auto [begin, end] =
        share(pairCount(answer), static_cast<int>(parts_.size()), static_cast<int>(worker));
    for (const PairRun run : answer) {
      const std::size_t from = std::min(begin, run.size());
      const std::size_t to = std::min(end, run.size());
      for (const Pair pair : run.subspan(from, to - from)) {
        if (pair.a < pair.b && pair.b < bodies_) [[likely]] {
          part.found[ownerOf(pair)].push_back(keyOf(pair));
        } else {
          *part.began.room(1) = pair;  // as wrong as it is
          part.began.advance(1);
        }
      }
      begin -= from;
      end -= to;
    }
  }

  void gather(std::size_t worker) {
    Part& part = parts_[worker];
    part.now.swap(part.before);
    part.now.clear();
    for (const Part& from : parts_) {
      part.now.insert(part.now.end(), from.found[worker].begin(), from.found[worker].end());
    }
  }

  void sort(Part& part) const {
    constexpr int kDigitBits = 11;
    constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
    constexpr std::size_t kFew = 512;  // for these comparing takes less
    if (part.now.size() < kFew) {
      std::ranges::sort(part.now);
      return;
    }
    part.spare.resize(part.now.size());
    for (int shift = 0; shift < 2 * body_bits_; shift += kDigitBits) {
      const auto digit = [shift](std::uint64_t key) { return key >> shift & (kDigits - 1); };
      std::array<std::size_t, kDigits> places{};
      for (const std::uint64_t key : part.now) ++places[digit(key)];
      std::size_t end = 0;
      for (std::size_t& place : places) end += std::exchange(place, end);
      for (const std::uint64_t key : part.now) part.spare[places[digit(key)]++] = key;
      part.now.swap(part.spare);
    }
  }

  void compare(Part& part) const {
    const auto add = [this](std::uint64_t key, PairBuffer& pairs) {
      const std::uint64_t mask = (std::uint64_t{1} << body_bits_) - 1;
      pairs.add(static_cast<std::uint32_t>(key >> body_bits_),
                static_cast<std::uint32_t>(key & mask));
    };
    auto before = part.before.begin();
    for (const std::uint64_t key : part.now) {
      for (; before != part.before.end() && *before < key; ++before) add(*before, part.ended);
      if (before != part.before.end() && *before == key) {
        ++before;
      } else {
        add(key, part.began);
      }
    }
    for (; before != part.before.end(); ++before) add(*before, part.ended);
  }

  std::unique_ptr<BroadPhase> algorithm_;
  ThreadTeam* team_ = nullptr;
  std::size_t bodies_ = 0;
  int body_bits_ = 0;  ///< that a body's number takes
  std::vector<Part> parts_;
  std::vector<PairRun> began_;
  std::vector<PairRun> ended_;
};

}  // namespace

std::unique_ptr<BroadPhase> withEvents(std::unique_ptr<BroadPhase> algorithm) {
  return std::make_unique<EventsFromPairs>(std::move(algorithm));
}

}  // namespace broadmark
