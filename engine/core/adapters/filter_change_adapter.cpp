// Changing collision filters, for algorithms that retain pairs of bodies under a fixed filter.
//
// The algorithm has a LiveFilter. A body with a new layer or new tags disappears, gets them while
// it is absent, and reappears: so no retained pair depends on them. In a frame with such bodies the
// algorithm runs two frames, the first as part of phase 1; all other frames are passed on as they
// are. O(n) for the boxes without these bodies, besides the algorithm's own costs.

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "adapters/adapter.h"
#include "broadmark/adapters.h"

namespace broadmark {
namespace {

class FilterChangeAdapter final : public Adapter {
 public:
  explicit FilterChangeAdapter(std::unique_ptr<BroadPhase> algorithm)
      : Adapter(std::move(algorithm)) {}

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    filter_.emplace(scene.filter, scene.objects);
    SceneInfo live = scene;
    live.filter = filter_->filter();
    live.all_present = false;
    present_.resize(scene.objects);
    for (const std::uint32_t body : first.presentBodies()) present_[body] = 1;
    boxes_.reserve(scene.objects);
    changed_.reserve(scene.objects);
    reinserted_.reserve(scene.objects);
    algorithm_->initialize(live, {first.index, first.boxes, first.changed}, execution);
  }

  void updateObjects(const Frame& frame) override {
    const std::span<const std::uint32_t> refiltered = frame.filter_changed;
    is_split_ =
        std::ranges::any_of(refiltered, [this](std::uint32_t body) { return present_[body] != 0; });
    reinserted_.clear();
    if (is_split_) runWithout(refiltered, frame);
    for (const std::uint32_t body : refiltered) filter_->update(body, *frame.filter);
    for (const std::uint32_t body : *frame.changed) {
      present_[body] = isEmpty(frame.boxes[body]) ? 0 : 1;
    }
    if (!is_split_) {
      algorithm_->updateObjects({frame.index, frame.boxes, frame.changed});
      return;
    }
    std::ranges::copy_if(refiltered, std::back_inserter(reinserted_),
                         [this](std::uint32_t body) { return present_[body] != 0; });
    algorithm_->updateObjects({frame.index, frame.boxes, reinserted_});
  }

  void searchOverlaps() override {
    algorithm_->searchOverlaps();
    if (is_split_ && reports_events_) mergeEvents();
  }
  void reportEvents() override {
    reports_events_ = true;
    algorithm_->reportEvents();
  }
  [[nodiscard]] PairEvents events() const override {
    if (is_split_) return {PairRuns(&began_run_, 1), PairRuns(&ended_run_, 1)};
    return algorithm_->events();
  }
  void visitCounters(const CounterVisitor& visit) const override {
    visit("bodies with a new filter", reinserted_.size());
    algorithm_->visitCounters(visit);
  }

 private:
  /// Runs the frame without these bodies, under their old filters.
  void runWithout(std::span<const std::uint32_t> bodies, const Frame& frame) {
    boxes_.assign(frame.boxes.begin(), frame.boxes.end());
    for (const std::uint32_t body : bodies) boxes_[body] = kEmptyBox;
    changed_.clear();
    std::ranges::set_union(*frame.changed, bodies, std::back_inserter(changed_));
    std::erase_if(changed_, [&](std::uint32_t body) {
      return present_[body] == 0 && std::ranges::binary_search(bodies, body);
    });
    algorithm_->updateObjects({frame.index, boxes_, changed_});
    algorithm_->cleanCache();
    algorithm_->updateStructures();
    algorithm_->searchOverlaps();
    all_began_.clear();
    all_ended_.clear();
    if (reports_events_) appendEvents();
  }

  void appendEvents() {
    const PairEvents events = algorithm_->events();
    for (const PairRun run : events.began)
      all_began_.insert(all_began_.end(), run.begin(), run.end());
    for (const PairRun run : events.ended)
      all_ended_.insert(all_ended_.end(), run.begin(), run.end());
  }

  /// A pair that ended without a body and began with it again has done neither. Duplicates remain.
  void mergeEvents() {
    appendEvents();
    std::ranges::sort(all_began_);
    std::ranges::sort(all_ended_);
    began_.clear();
    ended_.clear();
    std::ranges::set_difference(all_began_, all_ended_, std::back_inserter(began_));
    std::ranges::set_difference(all_ended_, all_began_, std::back_inserter(ended_));
    began_run_ = began_;
    ended_run_ = ended_;
  }

  std::optional<LiveFilter> filter_;
  bool reports_events_ = false;
  std::vector<std::uint8_t> present_;  ///< by body: 1 if present
  // Of the current frame.
  bool is_split_ = false;                  ///< a present body has a new filter
  std::vector<Aabb> boxes_;                ///< without the bodies with a new filter
  std::vector<std::uint32_t> changed_;     ///< in these boxes
  std::vector<std::uint32_t> reinserted_;  ///< present bodies with a new filter
  std::vector<Pair> all_began_;            ///< in both halves
  std::vector<Pair> all_ended_;
  std::vector<Pair> began_;
  std::vector<Pair> ended_;
  PairRun began_run_;
  PairRun ended_run_;
};

}  // namespace

std::unique_ptr<BroadPhase> withFilterChanges(std::unique_ptr<BroadPhase> algorithm) {
  return std::make_unique<FilterChangeAdapter>(std::move(algorithm));
}

}  // namespace broadmark
