// Shrinks a failing case by delta debugging (delta_debugging.h): removes parts, large ones first,
// as long as the rest still fails, until nothing can be removed: no single body, no frame, no
// absence (filled with the body's box before or after), no change of a body's filter, nothing of
// the collision filter.
//
// Plain delta debugging would start with the whole recording. But most wrong answers have local
// causes. So the wrong pair is tried first with few neighbours, then with increasingly many (and
// with a short history of frames, then a longer one), all in memory. If the pair and k neighbours
// fail, this takes O(log k) passes on up to 2k bodies, and O(k log k) small ones to shrink them; if
// only the whole recording fails, O(n log n) passes on nearly n bodies.

#include "broadmark/fuzz/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/harness/case_run.h"
#include "delta_debugging.h"
#include "simpler_filter.h"

namespace broadmark {
namespace {

/// Memory of a part.
std::size_t bytesOf(std::size_t bodies, std::size_t frames) {
  return bodies * frames * sizeof(Aabb);
}

/// Whether `part` is a subset of `whole`; both are ascending.
bool isWithin(const Selection& part, const Selection& whole) {
  return std::ranges::includes(whole.bodies, part.bodies) &&
         std::ranges::includes(whole.frames, part.frames);
}

/// Index of the first element of `all`, which is ascending, that is not below `number`.
std::uint32_t positionOf(std::uint32_t number, const std::vector<std::uint32_t>& all) {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(all, number) - all.begin());
}

/// Index of each number in `all`; both lists are ascending.
std::vector<std::uint32_t> positions(const std::vector<std::uint32_t>& numbers,
                                     const std::vector<std::uint32_t>& all) {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t number : numbers) found.push_back(positionOf(number, all));
  return found;
}

/// The part restricted to some of its bodies.
Selection withBodies(const Selection& part, std::vector<std::uint32_t> bodies) {
  Selection remaining = part;
  remaining.filter = part.filter.of(positions(bodies, part.bodies));
  remaining.bodies = std::move(bodies);
  const auto is_removed = [&](std::uint32_t body) {
    return !std::ranges::binary_search(remaining.bodies, body);
  };
  std::erase_if(remaining.filled, [&](const Filling& filling) { return is_removed(filling.body); });
  std::erase_if(remaining.filter_changes, is_removed);
  return remaining;
}

/// The part restricted to some of its frames.
Selection withFrames(const Selection& part, std::vector<std::uint32_t> frames) {
  Selection remaining = part;
  remaining.frames = std::move(frames);
  return remaining;
}

/// The part with ids relative to another part that contains it.
Selection renumbered(const Selection& part, const Selection& origin) {
  Selection same = part;
  same.bodies = positions(part.bodies, origin.bodies);
  same.frames = positions(part.frames, origin.frames);
  same.filter_changes = positions(part.filter_changes, origin.bodies);
  same.filled.clear();
  for (const Filling& filling : part.filled) {
    const std::uint32_t begin = positionOf(filling.first, origin.frames);
    const std::uint32_t end = positionOf(filling.last + 1, origin.frames);
    if (begin == end) continue;
    same.filled.push_back({positionOf(filling.body, origin.bodies), begin, end - 1, filling.box});
  }
  return same;
}

/// Squared distance of two boxes, 0 when they overlap; infinite if one is empty.
double squaredGap(const Aabb& a, const Aabb& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double gap = std::max({0.0, static_cast<double>(a.min[axis]) - b.max[axis],
                                 static_cast<double>(b.min[axis]) - a.max[axis]});
    sum += gap * gap;
  }
  return sum;
}

/// The `count` bodies nearest to the suspects, suspects first.
std::vector<std::uint32_t> nearest(const std::vector<std::uint32_t>& suspects,
                                   std::span<const Aabb> boxes, std::size_t count) {
  using Key = std::tuple<bool, double, std::uint32_t>;
  std::vector<Key> keys;
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    Key key = {true, std::numeric_limits<double>::infinity(), body};
    for (const std::uint32_t suspect : suspects) {
      key = std::min(key, Key{body != suspect, squaredGap(boxes[body], boxes[suspect]), body});
    }
    keys.push_back(key);
  }
  count = std::min(count, keys.size());
  std::ranges::partial_sort(keys, keys.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<std::uint32_t> bodies;
  for (std::size_t i = 0; i < count; ++i) bodies.push_back(std::get<2>(keys[i]));
  return bodies;
}

class Shrinker {
 public:
  Shrinker(IndexedFrames& source, std::uint32_t last, const SuspectQuery& suspects,
           const FailingTrial& trial, const ShrinkOptions& options)
      : suspects_(suspects), trial_(trial), options_(options), whole_(source), last_(last) {
    best_.part = selectAll(source.scene(), last);
  }

  ShrunkPart shrink() {
    try {
      if (!failsAmongNeighbours()) {
        requireFailure();
        shortenHistory();
        failsAmongNeighbours();  // the smaller part leaves memory for more neighbours
      }
      shrinkToMinimum();
      best_.minimal = true;
    } catch (const Cancelled&) {
      best_.minimal = false;
    }
    return std::move(best_);
  }

 private:
  /// Loads a part into memory if it fits. Returns whether the part is loaded.
  bool load(const Selection& part) {
    if (isHeld(part)) return true;
    if (bytesOf(part.bodies.size(), part.frames.size()) > options_.memory_bytes) {
      return false;
    }
    held_.reset();
    origin_ = selectionOf(whole_.scene(), part.bodies, part.frames);
    SubRecording frames(whole_, origin_, partName(whole_.scene()));
    held_.emplace(frames);
    return true;
  }

  [[nodiscard]] bool isHeld(const Selection& part) const {
    return held_ && isWithin(part, origin_);
  }

  SubRecording framesOf(const Selection& part) {
    const std::string name = partName(whole_.scene());
    if (!isHeld(part)) return {whole_, part, name};
    return {*held_, renumbered(part, origin_), name};
  }

  /// Tries a part, and stores it as the best one if it fails.
  bool fails(const Selection& part) {
    SubRecording source = framesOf(part);
    const bool failed = trial_(source);
    ++best_.trials;
    if (failed) best_.part = part;
    if (options_.progress) {
      options_.progress({.trials = best_.trials,
                         .bodies = best_.part.bodies.size(),
                         .frames = best_.part.frames.size() - 1});
    }
    throwIfCancelled();
    return failed;
  }

  void throwIfCancelled() const {
    if (options_.cancelled && options_.cancelled()) throw Cancelled();
  }

  /// Tries the suspects with increasingly many neighbours, as many as fit into memory. Returns
  /// whether any trial failed.
  bool failsAmongNeighbours() {
    const Selection before = best_.part;
    const std::vector<std::uint32_t> seeds = suspects_();
    const std::size_t limit = options_.memory_bytes / bytesOf(1, before.frames.size());
    if (seeds.empty() || limit < seeds.size()) return false;
    const std::vector<std::uint32_t> order = nearest(seeds, whole_.at(last_).boxes, limit);
    const auto first = [&](std::size_t count) {
      std::vector bodies(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
      std::ranges::sort(bodies);
      return withBodies(before, std::move(bodies));
    };
    load(first(order.size()));
    for (std::size_t count = seeds.size(); count < order.size(); count *= 2) {
      if (fails(first(count))) return true;
    }
    return fails(first(order.size()));
  }

  void requireFailure() {
    if (fails(best_.part)) return;
    throw InputError(fmt::format("{}: {} does not fail in frame {} when it is run again",
                                 whole_.scene().name, options_.subject, last_));
  }

  /// Tries increasingly long histories before the last frame.
  void shortenHistory() {
    const Selection before = best_.part;
    const auto frames = static_cast<std::ptrdiff_t>(before.frames.size());
    for (std::ptrdiff_t history = 2; history < frames; history *= 2) {
      if (fails(withFrames(before, {before.frames.end() - history, before.frames.end()}))) return;
    }
  }

  void shrinkToMinimum() {
    bool smaller = true;
    while (smaller) {
      load(best_.part);
      smaller = removeFrames();
      smaller = removeBodies() || smaller;
      smaller = fillAbsences() || smaller;
      smaller = removeFilterChanges() || smaller;
      smaller = simplifyFilterOfBest() || smaller;
    }
  }

  bool removeBodies() {
    return minimize(best_.part.bodies, 0, [&](const std::vector<std::uint32_t>& bodies) {
      return fails(withBodies(best_.part, bodies));
    });
  }

  /// Retains the last frame, and at least one before it: the initial pose.
  bool removeFrames() {
    return minimize(best_.part.frames, 1, [&](const std::vector<std::uint32_t>& frames) {
      return frames.size() > 1 && fails(withFrames(best_.part, frames));
    });
  }

  enum class FillWith { box_before, box_after };

  /// Fills each unnecessary absence. Sets all_present once no absence is left.
  bool fillAbsences() {
    if (best_.part.all_present) return false;
    bool removed = false;
    for (const FillWith where : {FillWith::box_before, FillWith::box_after}) {
      const Selection before = best_.part;
      std::vector<Filling> all = absences(before, where);
      std::erase_if(all, [](const Filling& absence) { return isEmpty(absence.box); });
      removed = minimize(all, 0,
                         [&](const std::vector<Filling>& left) {
                           Selection part = before;
                           std::ranges::set_difference(all, left, std::back_inserter(part.filled),
                                                       {}, keyOf, keyOf);
                           return fails(part);
                         }) ||
                removed;
    }
    if (!absences(best_.part, FillWith::box_before).empty()) return removed;
    Selection always_present = best_.part;
    always_present.all_present = true;
    return fails(always_present) || removed;
  }

  static std::pair<std::uint32_t, std::uint32_t> keyOf(const Filling& filling) {
    return {filling.body, filling.first};
  }

  /// Each absence of a body in a part, with the box just before or after it: the other box if that
  /// is missing, empty if the body is absent throughout. By body and frame.
  std::vector<Filling> absences(const Selection& part, FillWith where) {
    struct Body {
      Aabb before = kEmptyBox;
      std::optional<Filling> absence;
    };
    std::vector<Body> bodies(part.bodies.size());
    std::vector<Filling> found;
    const auto end_absence = [&](Body& body, const Aabb& after) {
      if (!body.absence) return;
      const bool use_after = where == FillWith::box_after && !isEmpty(after);
      body.absence->box = use_after || isEmpty(body.before) ? after : body.before;
      found.push_back(*body.absence);
      body.absence.reset();
    };
    SubRecording source = framesOf(part);
    for (std::uint32_t index = 0; index < part.frames.size(); ++index) {
      const std::span<const Aabb> boxes = source.at(index).boxes;
      const std::uint32_t frame = part.frames[index];
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        Body& body = bodies[i];
        if (!isEmpty(boxes[i])) {
          end_absence(body, boxes[i]);
          body.before = boxes[i];
        } else if (body.absence) {
          body.absence->last = frame;
        } else {
          body.absence = Filling{part.bodies[i], frame, frame, kEmptyBox};
        }
      }
    }
    for (Body& body : bodies) end_absence(body, kEmptyBox);
    std::ranges::sort(found, {}, keyOf);
    return found;
  }

  /// Bodies that need not change keep the layer and tags of the last frame, or those of the first.
  bool removeFilterChanges() {
    bool removed = false;
    for (const bool last : {true, false}) {
      const Selection before = best_.part;
      const CollisionFilter kept = filterOf(before, last ? before.frames.size() - 1 : 0);
      removed = minimize(before.filter_changes, 0,
                         [&](const std::vector<std::uint32_t>& left) {
                           std::vector<std::uint32_t> fixed;
                           std::ranges::set_difference(before.filter_changes, left,
                                                       std::back_inserter(fixed));
                           Selection part = before;
                           part.filter_changes = left;
                           part.filter = before.filter.with(positions(fixed, before.bodies), kept,
                                                            before.bodies.size());
                           return fails(part);
                         }) ||
                removed;
    }
    return removed;
  }

  CollisionFilter filterOf(const Selection& part, std::size_t frame) {
    SubRecording source = framesOf(part);
    return source.at(static_cast<std::uint32_t>(frame)).filterIn(source.scene());
  }

  bool simplifyFilterOfBest() {
    return simplifyFilter(best_.part.filter, best_.part.bodies.size(),
                          [&](const CollisionFilter& filter) {
                            Selection part = best_.part;
                            part.filter = filter;
                            return fails(part);
                          });
  }

  const SuspectQuery& suspects_;
  const FailingTrial& trial_;
  const ShrinkOptions& options_;
  IndexedFrames& whole_;
  std::uint32_t last_;  ///< frame
  ShrunkPart best_;
  Selection origin_;               ///< in the recording's ids
  std::optional<FrameList> held_;  ///< origin_ in memory
};

/// The difference of a case's answer for the last frame from the correct one; nullopt if the pass
/// ends early.
std::optional<FrameDifference> lastDifference(CaseRun& case_run, IndexedFrames& source,
                                              const CancelQuery& cancelled) {
  const std::uint32_t last = source.scene().frames;
  case_run.start(source.scene(), source.rewind());
  for (std::uint32_t index = 1; index <= last && case_run.running(); ++index) {
    if (cancelled && cancelled()) throw Cancelled();
    const Frame frame = source.at(index);
    if (!case_run.step(frame) || index < last) continue;
    Oracle oracle(0, kUnlimitedPairs, cancelled);
    return case_run.check(frame, oracle);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::uint32_t> suspectsOf(const FrameDifference& difference, std::size_t bodies) {
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

ShrunkPart shrinkPart(IndexedFrames& source, std::uint32_t last, const SuspectQuery& suspects,
                      const FailingTrial& fails, const ShrinkOptions& options) {
  return Shrinker(source, last, suspects, fails, options).shrink();
}

ShrunkPart shrinkFailure(const Case& test_case, IndexedFrames& source, std::uint32_t frame,
                         const ShrinkOptions& options) {
  CaseRun trial(test_case, RunPolicy::unlimited(CheckMode::off), options.make_executor,
                options.cancelled);
  const auto fails = [&](IndexedFrames& part) {
    const std::uint32_t last = part.scene().frames;
    bool runs = trial.start(part.scene(), part.rewind());
    std::uint32_t index = 0;
    while (runs && index < last) {
      if (options.cancelled && options.cancelled()) throw Cancelled();
      runs = trial.step(part.at(++index));
    }
    return !runs && trial.status() == Status::error && std::max(index, 1U) == last;
  };
  ShrinkOptions of_case = options;
  of_case.subject = caseName(test_case);
  return shrinkPart(source, frame, [] { return std::vector<std::uint32_t>(); }, fails, of_case);
}

ShrunkCase shrinkCase(const Case& test_case, IndexedFrames& source, const FrameDifference& known,
                      const ShrinkOptions& options) {
  const SceneInfo& scene = source.scene();
  if (known.frame < 1 || known.frame > scene.frames) {
    throw InputError(fmt::format("{}: no frame {} to shrink: frames 1 to {} are checked",
                                 scene.name, known.frame, scene.frames));
  }
  if (!test_case.algorithm.traits.finds_pairs) {
    throw InputError(
        fmt::format("{} finds no pairs: there is nothing to shrink", test_case.algorithm.id));
  }
  CaseRun trial(test_case, RunPolicy::unlimited(CheckMode::full), options.make_executor,
                options.cancelled);
  FrameDifference last = known;
  const auto fails = [&](IndexedFrames& part) {
    std::optional<FrameDifference> difference = lastDifference(trial, part, options.cancelled);
    if (!difference || !difference->isMismatch()) return false;
    last = std::move(*difference);
    return true;
  };
  const auto suspects = [&] { return suspectsOf(last, scene.objects); };
  ShrinkOptions of_case = options;
  of_case.subject = caseName(test_case);
  const ShrunkPart shrunk = shrinkPart(source, known.frame, suspects, fails, of_case);
  return {shrunk, std::move(last)};
}

}  // namespace broadmark
