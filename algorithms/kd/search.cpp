// Depth first, with a list of the bodies kept further up that reach into the node's cell: the
// parent's list and the parent's own bodies, filtered by the plane. At each node own bodies are
// tested against own bodies and against the list; listed bodies have met each other further up.
//
// Of these pairs only those with a moving body are wanted, and a subtree in which nothing moves and
// into which no moving body reaches is not entered. When everything is wanted, all bodies move.
//
// A few rows are tested against everything, as that is cheaper than sorting; many are swept along
// the axis on which own bodies vary most. Either way a few boxes are tested against a vector of
// boxes at once.

#include "kd/search.h"

#include <algorithm>

#include "moments.h"
#include "prefetch.h"

namespace broadmark::kd {

Searcher::Searcher(Isa isa)
    : kernels_(&overlapKernels(isa)), tests_per_sorted_(kVectorsPerSorted * kernels_->lanes) {}

void Searcher::search(const Scene& scene, int part, int parts, PairBuffer& pairs) {
  scene_ = &scene;
  pairs_ = &pairs;
  skipped_ = boxes_tested_ = 0;
  const auto work_at = [&](int p) {
    return std::uint64_t{scene.tree.root().work} * static_cast<std::uint64_t>(p) /
           static_cast<std::uint64_t>(parts);
  };
  work_begin_ = work_at(part);
  // Nodes without work of their own may stand at the very end.
  work_end_ = part + 1 < parts ? work_at(part + 1) : std::numeric_limits<std::uint64_t>::max();
  lists_.clear();
  enter(scene.tree.root(), 0, 0, {});
}

bool Searcher::isMine(std::uint64_t work_before) const {
  return work_begin_ <= work_before && work_before < work_end_;
}

void Searcher::enter(const Node& node, std::size_t begin, std::uint64_t work_before, List list) {
  if (!node.touched && list.still == list.begin) {
    skipped_ += isMine(work_before);
  } else if (work_before < work_end_ && work_before + node.work >= work_begin_) {
    visit(node, begin, work_before, list);
  }
}

void Searcher::visit(const Node& node, std::size_t begin, std::uint64_t work_before, List list) {
  const std::size_t left_size = node.isLeaf() ? 0 : node.left().size;
  arrange(scene_->tree.bodies().subspan(begin + left_size, node.own), list);
  if (node.isLeaf() && testsWanted() == 0) return;
  gatherBoxes();
  if (isMine(work_before)) test();
  if (node.isLeaf()) return;

  // Both children's lists are made while the boxes are at hand.
  const std::size_t stack = lists_.size();
  const float* const min = boxes_.min(node.axis);
  const float* const max = boxes_.max(node.axis);
  const List left = push(node.left().touched, [&](std::size_t i) { return min[i] < node.plane; });
  const List right =
      push(node.right().touched, [&](std::size_t i) { return max[i] >= node.plane; });

  work_before += node.own_touched ? node.own : 0;
  enter(node.left(), begin, work_before, left);
  enter(node.right(), begin + left_size + node.own, work_before + node.left().work, right);
  lists_.resize(stack);
}

/// Own moving | listed still | listed moving | own still: so all wanted pairs lie in two tiles.
void Searcher::arrange(std::span<const std::uint32_t> own, List list) {
  const std::size_t count = own.size() + (list.end - list.begin);
  arranged_.resize(count);
  own_still_.resize(own.size());
  std::size_t moving = 0;
  std::size_t still = 0;
  for (const std::uint32_t body : own) {
    const std::size_t moves = scene_->moving[body];
    arranged_[moving] = own_still_[still] = body;
    moving += moves;
    still += 1 - moves;
  }
  const auto at = [&](std::size_t i) { return lists_.begin() + static_cast<std::ptrdiff_t>(i); };
  auto next = arranged_.begin() + static_cast<std::ptrdiff_t>(moving);
  next = std::copy(at(list.still), at(list.end), next);
  next = std::copy(at(list.begin), at(list.still), next);
  std::copy_n(own_still_.begin(), still, next);
  sections_.listed_still = moving;
  sections_.listed_moving = moving + (list.end - list.still);
  sections_.own_still = count - still;
  sections_.end = count;
}

void Searcher::gatherBoxes() {
  const std::size_t count = sections_.end;
  boxes_tested_ += count;
  boxes_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kPrefetchDistance < count) prefetch(&scene_->boxes[arranged_[i + kPrefetchDistance]]);
    boxes_.set(i, scene_->boxes[arranged_[i]]);
  }
}

/// Tests of two boxes that are needed if all are.
std::size_t Searcher::testsWanted() const {
  const Sections& s = sections_;
  return s.listed_still * s.end + (s.own_still - s.listed_moving) * (s.end - s.own_still);
}

void Searcher::test() {
  const std::size_t tests = testsWanted();
  if (tests == 0) return;
  hits_.clear();
  if (tests <= tests_per_sorted_ * sections_.end) {
    const Sections& s = sections_;
    kernels_->test_tile(boxes_, {0, s.listed_still}, {0, s.end}, hits_);
    kernels_->test_tile(boxes_, {s.listed_moving, s.own_still}, {s.own_still, s.end}, hits_);
  } else {
    sweep();
  }
  addPairs();
}

void Searcher::sweep() {
  const std::size_t count = sections_.end;
  const std::size_t rows = std::max<std::size_t>(sections_.listed_still, 1);
  const std::array<double, 3> origin = Moments::centre(boxes_.box(0));
  Moments moments;
  for (std::size_t i = 0; i < rows; ++i) moments.add(boxes_.box(i), origin);
  const AxisOrder axes = moments.axes(static_cast<double>(rows));

  const auto box_of = [this](std::size_t i) -> const Aabb& { return scene_->boxes[arranged_[i]]; };
  sorted_.build(count, box_of, axes, alone_);
  kernels_->sweep(sorted_.boxes(), sorted_.ends().data(), sorted_.bodies().data(), {0, count},
                  hits_);
}

/// Adds those of the hits that are wanted and that only this node finds.
void Searcher::addPairs() {
  const Sections& s = sections_;
  const PairRun hits = hits_.run();
  Pair* const room = pairs_->room(hits.size());
  std::size_t count = 0;
  for (const Pair hit : hits) {
    room[count] = orderedPair(arranged_[hit.a], arranged_[hit.b]);
    const bool own_moves = hit.a < s.listed_still;
    const bool listed_moves = hit.a >= s.listed_moving && hit.a < s.own_still;
    count += own_moves || (listed_moves && hit.b >= s.own_still) ? 1 : 0;
  }
  if (scene_->filter != nullptr) {
    Pair* const end = std::remove_if(
        room, room + count, [this](Pair pair) { return !scene_->filter->wanted(pair.a, pair.b); });
    count = static_cast<std::size_t>(end - room);
  }
  pairs_->advance(count);
}

/// Pushes those of the arranged bodies that reach into a child. If nothing moves there, neither in
/// the child nor of what is pushed, nothing else is.
template <class Reaches>
Searcher::List Searcher::push(bool child_touched, Reaches reaches) {
  List list;
  list.begin = lists_.size();
  pushSection(0, sections_.listed_still, reaches);
  pushSection(sections_.listed_moving, sections_.own_still, reaches);
  list.still = lists_.size();
  if (child_touched || list.still > list.begin) {
    pushSection(sections_.listed_still, sections_.listed_moving, reaches);
    pushSection(sections_.own_still, sections_.end, reaches);
  }
  list.end = lists_.size();
  return list;
}

template <class Reaches>
void Searcher::pushSection(std::size_t begin, std::size_t end, Reaches reaches) {
  std::size_t size = lists_.size();
  lists_.resize(size + (end - begin));
  for (std::size_t i = begin; i < end; ++i) {
    lists_[size] = arranged_[i];
    size += reaches(i);
  }
  lists_.resize(size);
}

}  // namespace broadmark::kd
