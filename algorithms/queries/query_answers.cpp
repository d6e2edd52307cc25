// Queries of a QueryTree: traversals with visitors that collect the answers, and batches.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "queries/query_tree.h"

namespace broadmark::broadphase {

template <class Query, class T, class Answer>
void QueryTree::answerAll(std::span<const Query> queries, QueryResults<T>& results,
                          std::vector<T> Worker::* found, ThreadTeam& team, Answer answer) {
  constexpr double kQueryNs = 500;
  results.items.clear();
  results.starts.resize(queries.size() + 1);
  const auto answer_range = [&](int worker, Range range) {
    std::vector<T>& items =
        worker == 0 ? results.items : workers_[static_cast<std::size_t>(worker)].*found;
    items.clear();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      results.starts[i] = items.size();
      answer(queries[i], items);
    }
  };
  const int workers = workersThatPay(kQueryNs * static_cast<double>(queries.size()), team.size());
  team.runOn(workers,
             [&](int worker) { answer_range(worker, share(queries.size(), workers, worker)); });
  for (int worker = 1; worker < workers; ++worker) {
    const std::vector<T>& items = workers_[static_cast<std::size_t>(worker)].*found;
    const Range range = share(queries.size(), workers, worker);
    const std::size_t first = results.items.size();
    for (std::size_t i = range.begin; i < range.end; ++i) results.starts[i] += first;
    results.items.insert(results.items.end(), items.begin(), items.end());
  }
  results.starts[queries.size()] = results.items.size();
}

namespace {

/// Calls visit(body, slot) for each.
template <class Visit>
void forEachBody(const QueryNode& node, unsigned slots, Visit visit) {
  for (; slots != 0; slots &= slots - 1) {
    const int slot = std::countr_zero(slots);
    visit(node.children[slot] & ~QueryNode::kBody, slot);
  }
}

void addBodies(void* context, const QueryNode& node, unsigned slots) {
  auto& bodies = *static_cast<std::vector<std::uint32_t>*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int) { bodies.push_back(body); });
}

struct HitCollector {
  double max_fraction;
  double limit;
  std::size_t first;
  std::vector<CastHit>& hits;

  [[nodiscard]] CastHit hitOf(std::uint32_t body, double time) const {
    return {smallerOf(time, max_fraction) + 0.0, body};  // no -0
  }
};

double addHits(void* context, const QueryNode& node, unsigned slots, const double* times) {
  auto& collector = *static_cast<HitCollector*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int slot) {
    collector.hits.push_back(collector.hitOf(body, times[slot]));
  });
  return collector.limit;
}

double keepClosest(void* context, const QueryNode& node, unsigned slots, const double* times) {
  auto& collector = *static_cast<HitCollector*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int slot) {
    const CastHit hit = collector.hitOf(body, times[slot]);
    if (collector.hits.size() == collector.first) {
      collector.hits.push_back(hit);
    } else {
      collector.hits.back() = std::min(collector.hits.back(), hit);
    }
  });
  const double closest = collector.hits.back().fraction;
  return closest < collector.max_fraction ? closest : collector.limit;
}

/// Keeps the nearest bodies as a heap, the farthest first. Their distances are still squared.
struct NeighbourHeap {
  double limit;
  std::size_t first;
  std::size_t count;
  std::vector<Neighbour>& neighbours;

  /// Inlined, as a function would not be.
  static constexpr auto kIsNearer = [](const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.body < b.body;
  };
  [[nodiscard]] std::span<Neighbour> heap() const { return std::span(neighbours).subspan(first); }

  void add(const Neighbour& neighbour) {
    if (heap().size() == count) {
      if (!kIsNearer(neighbour, heap().front())) return;
      std::ranges::pop_heap(heap(), kIsNearer);
      neighbours.back() = neighbour;
    } else {
      neighbours.push_back(neighbour);
    }
    std::ranges::push_heap(heap(), kIsNearer);
    if (heap().size() == count) limit = heap().front().distance;
  }
};

double addNeighbours(void* context, const QueryNode& node, unsigned slots, const double* squares) {
  auto& heap = *static_cast<NeighbourHeap*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int slot) { heap.add({squares[slot], body}); });
  return heap.limit;
}

}  // namespace

void QueryTree::overlapping(std::span<const BoxQuery> queries, QueryResults<Body>& results,
                            ThreadTeam& team) {
  answerAll(queries, results, &Worker::bodies, team,
            [this](const BoxQuery& query, std::vector<Body>& bodies) {
              BoxTest test;
              std::ranges::copy(query.box.min, test.bounds);
              std::ranges::copy(query.box.max, test.bounds + 3);
              test.layers = query.layers;
              const auto first = static_cast<std::ptrdiff_t>(bodies.size());
              kernels_.overlapping(nodes_.data(), test, {addBodies, &bodies});
              std::ranges::sort(bodies.begin() + first, bodies.end());
            });
}

void QueryTree::cast(std::span<const Cast> casts, Hits wanted, QueryResults<CastHit>& results,
                     ThreadTeam& team) {
  answerAll(casts, results, &Worker::hits, team,
            [this, wanted](const Cast& cast, std::vector<CastHit>& hits) {
              CastTest test;
              for (std::size_t axis = 0; axis < 3; ++axis) {
                test.axes[axis] =
                    CastAxis(cast.box.min[axis], cast.box.max[axis], cast.direction[axis]);
                test.near_rows[axis] = test.axes[axis].backwards ? axis + 3 : axis;
                test.far_rows[axis] = test.axes[axis].backwards ? axis : axis + 3;
              }
              test.limit = castLimit(cast.max_fraction);
              test.layers = cast.layers;
              HitCollector collector = {cast.max_fraction, test.limit, hits.size(), hits};
              const auto first = static_cast<std::ptrdiff_t>(hits.size());
              kernels_.cast(nodes_.data(), test,
                            {wanted == Hits::closest ? keepClosest : addHits, &collector});
              std::ranges::sort(hits.begin() + first, hits.end());
            });
}

void QueryTree::nearest(std::span<const NearestQuery> queries, QueryResults<Neighbour>& results,
                        ThreadTeam& team) {
  answerAll(queries, results, &Worker::neighbours, team,
            [this](const NearestQuery& query, std::vector<Neighbour>& neighbours) {
              if (query.count == 0) return;
              NearestTest test;
              std::ranges::copy(query.point, test.point);
              test.limit = squaredLimit(query.max_distance);
              test.layers = query.layers;
              NeighbourHeap heap = {test.limit, neighbours.size(), query.count, neighbours};
              kernels_.nearest(nodes_.data(), test, {addNeighbours, &heap});
              std::ranges::sort_heap(heap.heap(), NeighbourHeap::kIsNearer);
              for (Neighbour& neighbour : heap.heap()) {
                neighbour.distance = std::sqrt(neighbour.distance);
              }
            });
}

}  // namespace broadmark::broadphase
