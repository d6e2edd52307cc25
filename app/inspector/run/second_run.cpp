#include "inspector/run/second_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>

namespace broadmark {
namespace {

std::vector<Pair> sorted(std::span<const Pair> pairs) {
  std::vector<Pair> copy(pairs.begin(), pairs.end());
  std::ranges::sort(copy);
  const auto twice = std::ranges::unique(copy);
  copy.erase(twice.begin(), twice.end());
  return copy;
}

}  // namespace

PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second) {
  const std::vector<Pair> a = sorted(first);
  const std::vector<Pair> b = sorted(second);
  PairComparison comparison;
  std::ranges::set_difference(a, b, std::back_inserter(comparison.first_only));
  std::ranges::set_difference(b, a, std::back_inserter(comparison.second_only));
  comparison.both = a.size() - comparison.first_only.size();
  return comparison;
}

std::uint32_t SecondRun::frameOfFirst(const SecondWish& wish, const SceneInfo& scene) {
  return wish.footage || !wish.frame ? 0 : std::min(*wish.frame, scene.frames);
}

void SecondRun::clear() {
  opened_.reset();
  footage_.reset();
  lane_.reset();
  failure_.clear();
}

void SecondRun::open(const std::shared_ptr<const FootageRequest>& request) {
  clear();
  opened_ = request;
  try {
    if (opened_) footage_ = opened_->open();
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
}

Footage* SecondRun::footage(const First& first) {
  return opened_ ? footage_.get() : &first.footage;
}

std::uint32_t SecondRun::frame(const SecondWish& wish, const First& first) {
  return std::min(wish.frame.value_or(first.frame), footage(first)->scene().frames);
}

Lane* SecondRun::lane(const SecondWish& wish, const First& first) {
  const auto found = std::ranges::find_if(
      first.lanes, [&](const auto& lane) { return lane->spec().number == wish.lane; });
  if (found == first.lanes.end()) {
    lane_.reset();
    return nullptr;
  }
  const std::uint32_t frame = this->frame(wish, first);
  if (frame == 0) return nullptr;  // which has no answer
  Lane& of_first = **found;
  if (!opened_ && frame == first.frame) return &of_first;
  if (!lane_ || lane_->spec() != of_first.spec()) {
    const LaneSpec spec = of_first.spec();
    lane_ = std::make_unique<Lane>(spec, make_host_, [this, spec] { return unwanted_(spec); });
  }
  return lane_.get();
}

bool SecondRun::advance(const SecondWish& wish, const First& first, DrawGate& gate) {
  if (wish.footage != opened_) {
    doing_ = fmt::format("opening {}", wish.footage ? wish.footage->title : "");
    open(wish.footage);
    return true;
  }
  Footage* const shown = footage(first);
  if (shown == nullptr) return false;
  const std::uint32_t wanted = frame(wish, first);
  if (shown->known() < wanted) {
    shown->extend();
    return true;
  }
  Lane* const lane = this->lane(wish, first);
  if (lane != lane_.get() || lane == nullptr) return false;  // the first view's thread sees to it
  if (lane->report().ended || lane->standsAt(wanted)) return false;
  doing_ = fmt::format("{} for the second view: frame {}", lane->spec().run.algorithm.id,
                       lane->report().frame + 1);
  if (lane->report().frame > wanted || !lane->standsAt(lane->report().frame)) {
    lane->restart(shown->scene(), shown->at(0));
  } else {
    lane->advance(shown->at(lane->report().frame + 1), gate);
  }
  return true;
}

std::shared_ptr<const Snapshot> SecondRun::take(const SecondWish& wish, const First& first) {
  Footage* const shown = footage(first);
  if (shown == nullptr) return nullptr;
  const std::uint32_t wanted = frame(wish, first);
  Lane* const lane = this->lane(wish, first);
  return takeSnapshot({.request = opened_ ? opened_ : first.request,
                       .footage = *shown,
                       .frame = wanted,
                       .lane = lane != nullptr && lane->standsAt(wanted) ? lane : nullptr,
                       .check = first.check,
                       .structure = first.structure,
                       .tracked = first.tracked},
                      oracle_);
}

}  // namespace broadmark
