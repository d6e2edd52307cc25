// Shrinking a failing case, by delta debugging: parts are left out, large ones first, as long as
// what is left still fails, until no single body and no single frame can go.
// Zeller and Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", 2002.
//
// That alone would begin with the whole recording. But wrong answers mostly have causes nearby. So
// the wrong pair is tried first with few neighbours, then with more and more (and with a short
// history of frames, then a longer one), all in memory. If the pair and k neighbours fail, that
// takes O(log k) passes on up to 2k bodies, and O(k log k) small ones to shrink them; if only the
// whole recording fails, O(n log n) passes on nearly n bodies.

#include "broadmark/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>

#include "broadmark/case_run.h"
#include "broadmark/error.h"

namespace broadmark {
namespace {

/// The memory that a part takes.
std::size_t bytesOf(std::size_t bodies, std::size_t frames) {
  return bodies * frames * sizeof(Aabb);
}

/// Whether all of `part` is in `whole`; both ascend.
bool isWithin(const Part& part, const Part& whole) {
  return std::ranges::includes(whole.bodies, part.bodies) &&
         std::ranges::includes(whole.frames, part.frames);
}

/// The position of each of `numbers` in `all`; both ascend.
std::vector<std::uint32_t> positions(const std::vector<std::uint32_t>& numbers,
                                     const std::vector<std::uint32_t>& all) {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t number : numbers) {
    const auto place = std::ranges::lower_bound(all, number);
    found.push_back(static_cast<std::uint32_t>(place - all.begin()));
  }
  return found;
}

/// Where to look first: the bodies of the first wrong pair whose bodies exist.
std::vector<std::uint32_t> suspects(const FrameDifference& difference, std::uint32_t bodies) {
  for (const auto* pairs :
       {&difference.missed_pairs, &difference.false_pairs, &difference.invalid_pairs}) {
    for (const Pair pair : *pairs) {
      if (pair.a >= bodies || pair.b >= bodies) continue;
      if (pair.a == pair.b) return {pair.a};
      return {pair.a, pair.b};
    }
  }
  return {};
}

/// Squared distance of two boxes, 0 when they overlap.
double squaredGap(const Aabb& a, const Aabb& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double gap = std::max({0.0, static_cast<double>(a.min[axis]) - b.max[axis],
                                 static_cast<double>(b.min[axis]) - a.max[axis]});
    sum += gap * gap;
  }
  return sum;
}

/// Squared distance of two boxes' centres.
double squaredDistance(const Aabb& a, const Aabb& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double twice = (static_cast<double>(a.min[axis]) + a.max[axis]) -
                         (static_cast<double>(b.min[axis]) + b.max[axis]);
    sum += twice * twice / 4;
  }
  return sum;
}

/// The `count` bodies nearest to the suspects, these first.
std::vector<std::uint32_t> nearest(const std::vector<std::uint32_t>& suspects,
                                   std::span<const Aabb> boxes, std::size_t count) {
  using Key = std::tuple<bool, double, double, std::uint32_t>;
  std::vector<Key> keys;
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    Key key = {true, std::numeric_limits<double>::infinity(), 0, body};
    for (const std::uint32_t suspect : suspects) {
      key = std::min(key, Key{body != suspect, squaredGap(boxes[body], boxes[suspect]),
                              squaredDistance(boxes[body], boxes[suspect]), body});
    }
    keys.push_back(key);
  }
  count = std::min(count, keys.size());
  std::ranges::partial_sort(keys, keys.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<std::uint32_t> bodies;
  for (std::size_t i = 0; i < count; ++i) bodies.push_back(std::get<3>(keys[i]));
  return bodies;
}

class Shrinker {
 public:
  Shrinker(const Case& run, IndexedFrames& source, const FrameDifference& known,
           const ShrinkOptions& options)
      : run_(run, RunPolicy::unlimited(CheckMode::full), options.make_host, options.cancelled),
        options_(options),
        whole_(source),
        known_(known) {
    best_.part = wholePart(source.scene(), known.frame);
    best_.difference = known;
  }

  ShrunkCase shrink() {
    try {
      if (!failsAmongNeighbours()) {
        requireFailure();
        shortenHistory();
        failsAmongNeighbours();  // more of them fit into memory now
      }
      shrinkToMinimum();
      best_.minimal = true;
    } catch (const Cancelled&) {
    }
    return std::move(best_);
  }

 private:
  /// A part of the recording that is held in memory.
  struct Held {
    Part origin;
    FrameList frames;

    Held(Part part, FrameSource& source) : origin(std::move(part)), frames(source) {}
  };

  /// Holds a part in memory, if it fits. Whether it is held now.
  bool hold(const Part& part) {
    if (isHeld(part)) return true;
    if (bytesOf(part.bodies.size(), part.frames.size()) > options_.memory_bytes) {
      return false;
    }
    held_.reset();
    SubRecording frames(whole_, part, partName(whole_.scene()));
    held_ = std::make_unique<Held>(part, frames);
    return true;
  }

  [[nodiscard]] bool isHeld(const Part& part) const {
    return held_ && isWithin(part, held_->origin);
  }

  SubRecording framesOf(const Part& part) {
    const std::string name = partName(whole_.scene());
    if (!isHeld(part)) return {whole_, part, name};
    return {held_->frames,
            {positions(part.bodies, held_->origin.bodies),
             positions(part.frames, held_->origin.frames)},
            name};
  }

  /// Runs the case on a part, which becomes the best when it fails there.
  bool fails(const Part& part) {
    std::optional<FrameDifference> difference = lastDifference(part);
    ++best_.trials;
    const bool failed = difference && difference->isMismatch();
    if (failed) {
      best_.part = part;
      best_.difference = std::move(*difference);
    }
    if (options_.progress) {
      options_.progress({.trials = best_.trials,
                         .bodies = best_.part.bodies.size(),
                         .frames = best_.part.frames.size() - 1});
    }
    throwIfCancelled();
    return failed;
  }

  /// How the answer for the last frame of a part differs from the right one; nothing when the case
  /// does not get that far.
  std::optional<FrameDifference> lastDifference(const Part& part) {
    SubRecording source = framesOf(part);
    const std::uint32_t last = source.scene().frames;
    run_.start(source.scene(), source.rewind());
    for (std::uint32_t index = 1; index <= last && run_.running(); ++index) {
      throwIfCancelled();
      const Frame frame = source.at(index);
      if (!run_.step(frame) || index < last) continue;
      Oracle oracle(0);
      return run_.check(frame, oracle);
    }
    return std::nullopt;
  }

  void throwIfCancelled() const {
    if (options_.cancelled && options_.cancelled()) throw Cancelled();
  }

  /// Tries the suspects with more and more of their neighbours, as many as fit into memory. Whether
  /// any of that failed.
  bool failsAmongNeighbours() {
    const Part before = best_.part;
    const std::vector<std::uint32_t> seeds = suspects(known_, whole_.scene().objects);
    const std::size_t limit = options_.memory_bytes / bytesOf(1, before.frames.size());
    if (seeds.empty() || limit < seeds.size()) return false;
    const std::vector<std::uint32_t> order = nearest(seeds, whole_.at(known_.frame).boxes, limit);
    const auto first = [&](std::size_t count) {
      Part part{{order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count)}, before.frames};
      std::ranges::sort(part.bodies);
      return part;
    };
    hold(first(order.size()));
    for (std::size_t count = seeds.size(); count < order.size(); count *= 2) {
      if (fails(first(count))) return true;
    }
    return fails(first(order.size()));
  }

  void requireFailure() {
    if (fails(best_.part)) {
      known_ = best_.difference;
      known_.frame = best_.part.frames.back();
      return;
    }
    throw InputError(fmt::format("{}: {} does not fail in frame {} when it is run again",
                                 whole_.scene().name, caseName(run_.description()), known_.frame));
  }

  /// Tries longer and longer histories before the last frame.
  void shortenHistory() {
    const Part before = best_.part;
    const auto frames = static_cast<std::ptrdiff_t>(before.frames.size());
    for (std::ptrdiff_t history = 2; history < frames; history *= 2) {
      if (fails({before.bodies, {before.frames.end() - history, before.frames.end()}})) return;
    }
  }

  void shrinkToMinimum() {
    bool smaller = true;
    while (smaller) {
      hold(best_.part);
      const bool fewer_frames = removeFrames();
      smaller = removeBodies() || fewer_frames;
    }
  }

  bool removeBodies() {
    return removeChunks(best_.part.bodies, 0, [&](std::vector<std::uint32_t> bodies) {
      return fails({std::move(bodies), best_.part.frames});
    });
  }

  /// The last frame stays, and one before it: the initial pose.
  bool removeFrames() {
    return removeChunks(best_.part.frames, 1, [&](std::vector<std::uint32_t> frames) {
      return frames.size() > 1 && fails({best_.part.bodies, std::move(frames)});
    });
  }

  /// Leaves out chunks, large ones first, until none of the items can go, the last `kept` aside.
  /// Whether any could.
  template <class Fails>
  static bool removeChunks(std::vector<std::uint32_t> items, std::size_t kept,
                           Fails&& still_fails) {
    const std::size_t at_first = items.size();
    std::size_t chunk = std::max<std::size_t>(items.size() / 2, 1);
    while (true) {
      const std::size_t before = items.size();
      for (std::size_t begin = 0; begin + kept < items.size();) {
        const std::size_t end = std::min(begin + chunk, items.size() - kept);
        std::vector<std::uint32_t> fewer = items;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(begin),
                    fewer.begin() + static_cast<std::ptrdiff_t>(end));
        if (still_fails(fewer)) {
          items = std::move(fewer);
        } else {
          begin = end;
        }
      }
      if (chunk == 1 && items.size() == before) return items.size() < at_first;
      chunk = std::max<std::size_t>(chunk / 2, 1);
    }
  }

  CaseRun run_;  ///< of all trials
  const ShrinkOptions& options_;
  IndexedFrames& whole_;
  FrameDifference known_;
  ShrunkCase best_;
  std::unique_ptr<Held> held_;
};

}  // namespace

ShrunkCase shrinkCase(const Case& run, IndexedFrames& source, const FrameDifference& known,
                      const ShrinkOptions& options) {
  const SceneInfo& scene = source.scene();
  if (known.frame < 1 || known.frame > scene.frames) {
    throw InputError(fmt::format("{}: no frame {} to shrink: frames 1 to {} are checked",
                                 scene.name, known.frame, scene.frames));
  }
  if (!run.algorithm.traits.finds_pairs) {
    throw InputError(
        fmt::format("{} finds no pairs: there is nothing to shrink", run.algorithm.id));
  }
  return Shrinker(run, source, known, options).shrink();
}

}  // namespace broadmark
