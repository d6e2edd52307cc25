// The C interface: exceptions become a status and a message.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadmark/broadphase.h"
#include "broadmark/broadphase.hpp"

using broadmark::broadphase::Answer;
using broadmark::broadphase::Boxes;
using broadmark::broadphase::BoxQuery;
using broadmark::broadphase::BroadPhase;
using broadmark::broadphase::Cast;
using broadmark::broadphase::CastHit;
using broadmark::broadphase::Changes;
using broadmark::broadphase::Filter;
using broadmark::broadphase::Hits;
using broadmark::broadphase::InstructionSet;
using broadmark::broadphase::Method;
using broadmark::broadphase::NearestQuery;
using broadmark::broadphase::Neighbour;
using broadmark::broadphase::Options;
using broadmark::broadphase::Order;
using broadmark::broadphase::Pair;
using broadmark::broadphase::QueryResults;

struct bm_broadphase {
  explicit bm_broadphase(const Options& options) : broad_phase(options) {}
  BroadPhase broad_phase;
  QueryResults<std::uint32_t> bodies;
  QueryResults<CastHit> hits;
  QueryResults<Neighbour> neighbours;
};

namespace {

static_assert(sizeof(bm_box) == sizeof(broadmark::broadphase::Box));
static_assert(sizeof(bm_pair) == sizeof(Pair));
static_assert(BM_METHOD_COLUMNS == static_cast<int>(Method::columns));
static_assert(BM_ANSWER_EVENTS == static_cast<int>(Answer::events));
static_assert(BM_ORDER_ANY == static_cast<int>(Order::any));
static_assert(BM_CHANGES_TRUSTED == static_cast<int>(Changes::trusted));
static_assert(BM_ISA_AVX512 == static_cast<int>(InstructionSet::avx512));
static_assert(BM_NO_TAG == Filter::kNoTag);
static_assert(BM_HITS_ALL == static_cast<int>(Hits::all));
static_assert(BM_ALL_LAYERS == broadmark::broadphase::kAllLayers);
static_assert(sizeof(bm_box_query) == sizeof(BoxQuery));
static_assert(sizeof(bm_cast_query) == sizeof(Cast) &&
              offsetof(bm_cast_query, max_fraction) == offsetof(Cast, max_fraction));
static_assert(sizeof(bm_nearest_query) == sizeof(NearestQuery) &&
              offsetof(bm_nearest_query, max_distance) == offsetof(NearestQuery, max_distance));
static_assert(sizeof(bm_hit) == sizeof(CastHit) &&
              offsetof(bm_hit, body) == offsetof(CastHit, body));
static_assert(sizeof(bm_neighbour) == sizeof(Neighbour) &&
              offsetof(bm_neighbour, body) == offsetof(Neighbour, body));

thread_local std::string last_error;

bm_status fail(bm_status status, const char* message) noexcept {
  try {
    last_error = message;
  } catch (const std::exception&) {
    last_error.clear();
  }
  return status;
}

/// For the exception that is being handled. One function for all calls: it is long.
[[gnu::cold, gnu::noinline]] bm_status failByException() noexcept {
  try {
    throw;
  } catch (const std::invalid_argument& error) {
    return fail(BM_INVALID_ARGUMENT, error.what());
  } catch (const std::length_error& error) {
    return fail(BM_OUT_OF_MEMORY, error.what());
  } catch (const std::logic_error& error) {
    return fail(BM_MISUSE, error.what());
  } catch (const std::bad_alloc&) {
    return fail(BM_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    return fail(BM_FAILED, error.what());
  } catch (...) {
    return fail(BM_FAILED, "an exception that is not a std::exception");
  }
}

template <class Call>
bm_status guarded(Call call) noexcept {
  try {
    call();
    return BM_OK;
  } catch (...) {
    return failByException();
  }
}

/// Throws for a null pointer.
template <class T>
T& deref(T* pointer, const char* name) {
  if (pointer == nullptr) throw std::invalid_argument(name + std::string(": must not be null"));
  return *pointer;
}

Boxes boxesOf(const bm_boxes& boxes) { return {boxes.min, boxes.max, boxes.count, boxes.stride}; }

bm_pairs pairsOf(std::span<const Pair> pairs) {
  return {reinterpret_cast<const bm_pair*>(pairs.data()), pairs.size()};
}

Options optionsOf(const bm_options& given) {
  Options options;
  options.method = static_cast<Method>(given.method);
  options.answer = static_cast<Answer>(given.answer);
  options.order = static_cast<Order>(given.order);
  options.changes = static_cast<Changes>(given.changes);
  options.threads = given.threads;
  options.instruction_set = static_cast<InstructionSet>(given.instruction_set);
  options.margin = given.margin;
  std::memcpy(options.collides.data(), given.collides, sizeof(given.collides));
  if (given.parallel_for != nullptr) {
    options.parallel_for = [parallel_for = given.parallel_for, user = given.user](
                               int jobs, const std::function<void(int)>& job) {
      parallel_for(
          user, jobs,
          [](void* context, int i) { (*static_cast<const std::function<void(int)>*>(context))(i); },
          const_cast<std::function<void(int)>*>(&job));
    };
  }
  return options;
}

/// Queries as the C++ interface has them.
template <class Query, class CQuery>
std::span<const Query> queriesOf(const CQuery* queries, size_t count) {
  if (count > 0) deref(queries, "queries");
  return {reinterpret_cast<const Query*>(queries), count};
}

template <class CResults, class T>
void publish(const QueryResults<T>& found, CResults& results) {
  results.starts = found.starts.data();
  results.items = reinterpret_cast<decltype(results.items)>(found.items.data());
}

}  // namespace

extern "C" {

const char* bm_last_error(void) { return last_error.c_str(); }

void bm_default_options(bm_options* options) {
  if (options == nullptr) return;
  const Options defaults;
  *options = {};
  options->threads = defaults.threads;
  std::memcpy(options->collides, defaults.collides.data(), sizeof(options->collides));
}

bm_status bm_create(const bm_options* options, bm_broadphase** created) {
  return guarded([&] {
    deref(created, "created") = nullptr;
    *created = new bm_broadphase(options == nullptr ? Options() : optionsOf(*options));
  });
}

void bm_destroy(bm_broadphase* broadphase) { delete broadphase; }

bm_status bm_update(bm_broadphase* broadphase, bm_boxes boxes) {
  return guarded([&] { deref(broadphase, "broadphase").broad_phase.update(boxesOf(boxes)); });
}

bm_status bm_update_changed(bm_broadphase* broadphase, bm_boxes boxes, const uint32_t* changed,
                            size_t count) {
  return guarded([&] {
    if (count > 0) deref(changed, "changed");
    deref(broadphase, "broadphase").broad_phase.update(boxesOf(boxes), {changed, count});
  });
}

bm_status bm_set_filter(bm_broadphase* broadphase, uint32_t body, uint32_t layer,
                        const uint32_t tags[3]) {
  return guarded([&] {
    Filter filter;
    filter.layer = layer;
    if (tags != nullptr) filter.tags = {tags[0], tags[1], tags[2]};
    deref(broadphase, "broadphase").broad_phase.setFilter(body, filter);
  });
}

bm_status bm_get_pairs(const bm_broadphase* broadphase, bm_pairs* pairs) {
  return guarded([&] {
    deref(pairs, "pairs") = pairsOf(deref(broadphase, "broadphase").broad_phase.pairs());
  });
}

bm_status bm_get_events(const bm_broadphase* broadphase, bm_pairs* began, bm_pairs* ended) {
  return guarded([&] {
    const BroadPhase& broad_phase = deref(broadphase, "broadphase").broad_phase;
    deref(began, "began") = pairsOf(broad_phase.began());
    deref(ended, "ended") = pairsOf(broad_phase.ended());
  });
}

bm_status bm_overlapping(bm_broadphase* broadphase, const bm_box_query* queries, size_t count,
                         bm_body_results* results) {
  return guarded([&] {
    bm_broadphase& object = deref(broadphase, "broadphase");
    deref(results, "results");
    object.broad_phase.overlapping(queriesOf<BoxQuery>(queries, count), object.bodies);
    publish(object.bodies, *results);
  });
}

bm_status bm_cast(bm_broadphase* broadphase, const bm_cast_query* casts, size_t count, int hits,
                  bm_hit_results* results) {
  return guarded([&] {
    bm_broadphase& object = deref(broadphase, "broadphase");
    deref(results, "results");
    object.broad_phase.cast(queriesOf<Cast>(casts, count), static_cast<Hits>(hits), object.hits);
    publish(object.hits, *results);
  });
}

bm_status bm_nearest(bm_broadphase* broadphase, const bm_nearest_query* queries, size_t count,
                     bm_neighbour_results* results) {
  return guarded([&] {
    bm_broadphase& object = deref(broadphase, "broadphase");
    deref(results, "results");
    object.broad_phase.nearest(queriesOf<NearestQuery>(queries, count), object.neighbours);
    publish(object.neighbours, *results);
  });
}

bm_status bm_save(const bm_broadphase* broadphase, void* bytes, size_t capacity, size_t* size) {
  bool too_small = false;
  const bm_status status = guarded([&] {
    thread_local std::vector<std::byte> state;
    deref(broadphase, "broadphase").broad_phase.save(state);
    deref(size, "size") = state.size();
    too_small = state.size() > capacity;
    if (too_small) return;
    if (bytes == nullptr) throw std::invalid_argument("bytes: must not be null");
    std::memcpy(bytes, state.data(), state.size());
  });
  return too_small ? fail(BM_BUFFER_TOO_SMALL, "bytes: smaller than the state") : status;
}

bm_status bm_restore(bm_broadphase* broadphase, const void* bytes, size_t size) {
  return guarded([&] {
    if (size > 0 && bytes == nullptr) throw std::invalid_argument("bytes: must not be null");
    deref(broadphase, "broadphase")
        .broad_phase.restore({static_cast<const std::byte*>(bytes), size});
  });
}

}  // extern "C"
