// A depth-first traversal with a list of the ancestors' own bodies that reach into the node's cell:
// the parent's list and the parent's own bodies, filtered by the plane. At each node the own bodies
// are tested against each other and against the list; pairs within the list belong to ancestors.
//
// Only pairs with a moved body are searched for. A subtree without moved bodies into which no moved
// body reaches is skipped. For a full search all bodies are marked as moved.
//
// Few rows are tested against all bodies, which is cheaper than sorting; many use sweep and prune
// on the axis of largest variance of the own bodies. Both test several boxes against a vector of
// boxes at a time.

#include "kd/search.h"

#include <algorithm>

#include "moments.h"
#include "prefetch.h"

namespace broadmark::kd {

Searcher::Searcher(Isa isa)
    : kernels_(&overlapKernels(isa)),
      sweep_kernels_(&sweepKernels(isa)),
      min_tests_to_sort_(kTestsPerSortedBox * kernels_->lanes) {}

void Searcher::search(const Scene& scene, int part, int parts, PairBuffer& pairs) {
  scene_ = &scene;
  pairs_ = &pairs;
  skipped_subtrees_ = boxes_tested_ = 0;
  const auto work_at = [&](int p) {
    return std::uint64_t{scene.tree.root().work} * static_cast<std::uint64_t>(p) /
           static_cast<std::uint64_t>(parts);
  };
  work_begin_ = work_at(part);
  // Nodes without work may begin at the very end.
  work_end_ = part + 1 < parts ? work_at(part + 1) : std::numeric_limits<std::uint64_t>::max();
  lists_.clear();
  enter(scene.tree.root(), 0, 0, {});
}

bool Searcher::ownsNode(std::uint64_t work_before) const {
  return work_begin_ <= work_before && work_before < work_end_;
}

void Searcher::enter(const Node& node, std::size_t begin, std::uint64_t work_before, List list) {
  if (!node.dirty && list.unchanged == list.begin) {
    skipped_subtrees_ += ownsNode(work_before);
  } else if (work_before < work_end_ && work_before + node.work >= work_begin_) {
    visit(node, begin, work_before, list);
  }
}

void Searcher::visit(const Node& node, std::size_t begin, std::uint64_t work_before, List list) {
  const std::size_t left_size = node.isLeaf() ? 0 : node.left().size;
  arrange(scene_->tree.bodies().subspan(begin + left_size, node.own), list);
  if (node.isLeaf() && requiredTests() == 0) return;
  gatherBoxes();
  if (ownsNode(work_before)) test();
  if (node.isLeaf()) return;

  // Both lists are built before the recursion overwrites boxes_.
  const std::size_t stack = lists_.size();
  const float* const min = boxes_.min(node.axis);
  const float* const max = boxes_.max(node.axis);
  const List left = push(node.left().dirty, [&](std::size_t i) { return min[i] < node.plane; });
  const List right = push(node.right().dirty, [&](std::size_t i) { return max[i] >= node.plane; });

  work_before += node.own_dirty ? node.own : 0;
  enter(node.left(), begin, work_before, left);
  enter(node.right(), begin + left_size + node.own, work_before + node.left().work, right);
  lists_.resize(stack);
}

/// Own moved | listed unchanged | listed moved | own unchanged: two tiles contain all pairs with a
/// moved body.
void Searcher::arrange(std::span<const std::uint32_t> own, List list) {
  const std::size_t count = own.size() + (list.end - list.begin);
  arranged_.resize(count);
  own_unchanged_.resize(own.size());
  std::size_t moved = 0;
  std::size_t unchanged = 0;
  for (const std::uint32_t body : own) {
    const std::size_t is_moved = scene_->moved[body];
    arranged_[moved] = own_unchanged_[unchanged] = body;
    moved += is_moved;
    unchanged += 1 - is_moved;
  }
  const auto at = [&](std::size_t i) { return lists_.begin() + static_cast<std::ptrdiff_t>(i); };
  auto next = arranged_.begin() + static_cast<std::ptrdiff_t>(moved);
  next = std::copy(at(list.unchanged), at(list.end), next);
  next = std::copy(at(list.begin), at(list.unchanged), next);
  std::copy_n(own_unchanged_.begin(), unchanged, next);
  sections_.listed_unchanged = moved;
  sections_.listed_moved = moved + (list.end - list.unchanged);
  sections_.own_unchanged = count - unchanged;
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

/// Number of box tests without sorting.
std::size_t Searcher::requiredTests() const {
  const Sections& s = sections_;
  return s.listed_unchanged * s.end +
         (s.own_unchanged - s.listed_moved) * (s.end - s.own_unchanged);
}

void Searcher::test() {
  const std::size_t tests = requiredTests();
  if (tests == 0) return;
  hits_.clear();
  if (tests <= min_tests_to_sort_ * sections_.end) {
    const Sections& s = sections_;
    kernels_->test_tile(boxes_, {0, s.listed_unchanged}, {0, s.end}, hits_);
    kernels_->test_tile(boxes_, {s.listed_moved, s.own_unchanged}, {s.own_unchanged, s.end}, hits_);
  } else {
    sweep();
  }
  addPairs();
}

void Searcher::sweep() {
  const std::size_t count = sections_.end;
  const std::size_t rows = std::max<std::size_t>(sections_.listed_unchanged, 1);
  const std::array<double, 3> origin = Moments::centre(boxes_.box(0));
  Moments moments;
  for (std::size_t i = 0; i < rows; ++i) moments.add(boxes_.box(i), origin);
  const AxisOrder axes = moments.axes(static_cast<double>(rows));

  const auto box_of = [this](std::size_t i) -> const Aabb& { return scene_->boxes[arranged_[i]]; };
  sorted_.build(count, box_of, axes, single_thread_);
  sweep_kernels_->sweep(sorted_.boxes(), sorted_.ends().data(), sorted_.bodies().data(), {0, count},
                        hits_);
}

/// Adds the hits that are wanted and belong to this node.
void Searcher::addPairs() {
  const Sections& s = sections_;
  const PairRun hits = hits_.run();
  Pair* const room = pairs_->room(hits.size());
  std::size_t count = 0;
  for (const Pair hit : hits) {
    room[count] = orderedPair(arranged_[hit.a], arranged_[hit.b]);
    const bool own_is_moved = hit.a < s.listed_unchanged;
    const bool listed_is_moved = hit.a >= s.listed_moved && hit.a < s.own_unchanged;
    count += own_is_moved || (listed_is_moved && hit.b >= s.own_unchanged) ? 1 : 0;
  }
  if (scene_->filter != nullptr) count = scene_->filter->retainWanted({room, count});
  pairs_->advance(count);
}

/// Pushes the arranged bodies that reach into a child. Unchanged bodies are needed only if a body
/// has moved in the child or on the list.
template <class Reaches>
Searcher::List Searcher::push(bool child_dirty, Reaches reaches) {
  List list;
  list.begin = lists_.size();
  pushSection(0, sections_.listed_unchanged, reaches);
  pushSection(sections_.listed_moved, sections_.own_unchanged, reaches);
  list.unchanged = lists_.size();
  if (child_dirty || list.unchanged > list.begin) {
    pushSection(sections_.listed_unchanged, sections_.listed_moved, reaches);
    pushSection(sections_.own_unchanged, sections_.end, reaches);
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
