// Python bindings of the library for engines and games: a class that keeps its state over frames.
// The package's BroadPhase converts the arguments. Boxes are read where they lie, without a copy.

#include "broad_phase.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <broadmark/broadphase.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/names.h"

namespace py = pybind11;

namespace broadmark {
namespace {

using broadphase::Answer;
using broadphase::Changes;
using broadphase::InstructionSet;
using broadphase::Method;
using broadphase::Order;

constexpr NameTable kMethods{{NamedValue{Method::tide, "tide"}, {Method::columns, "columns"}}};
constexpr NameTable kAnswers{{NamedValue{Answer::pairs, "pairs"}, {Answer::events, "events"}}};
constexpr NameTable kOrders{{NamedValue{Order::sorted, "sorted"}, {Order::any, "any"}}};
constexpr NameTable kHits{
    {NamedValue{broadphase::Hits::closest, "closest"}, {broadphase::Hits::all, "all"}}};
constexpr NameTable kChanges{
    {NamedValue{Changes::verified, "verified"}, {Changes::trusted, "trusted"}}};
constexpr NameTable kInstructionSets{{NamedValue{InstructionSet::best, "auto"},
                                      {InstructionSet::scalar, "scalar"},
                                      {InstructionSet::sse2, "sse2"},
                                      {InstructionSet::neon, "neon"},
                                      {InstructionSet::simd128, "simd128"},
                                      {InstructionSet::avx2, "avx2"},
                                      {InstructionSet::avx512, "avx512"}}};

template <class Table>
auto valueOf(const Table& table, std::string_view option, std::string_view name) {
  const auto value = table.find(name);
  if (!value) throw InputError(unknownName(option, name, table.names()));
  return *value;
}

float roundedUp(double number) {
  const auto rounded = static_cast<float>(number);
  return rounded < number ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                          : rounded;
}

/// A copy, since the next update overwrites the answer.
py::array_t<std::uint32_t> copied(std::span<const broadphase::Pair> pairs) {
  py::array_t<std::uint32_t> array({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
  if (!pairs.empty()) std::memcpy(array.mutable_data(), pairs.data(), pairs.size_bytes());
  return array;
}

/// Rows of contiguous floats.
using Floats = py::array_t<float, py::array::c_style>;

std::span<const float> rowOf(const Floats& rows, std::size_t row) {
  const std::size_t width =
      static_cast<std::size_t>(rows.size() / std::max<py::ssize_t>(1, rows.shape(0)));
  return {rows.data() + row * width, width};
}

broadphase::Box boxOf(std::span<const float> bounds) {
  broadphase::Box box;
  std::ranges::copy(bounds.first<3>(), box.min);
  std::ranges::copy(bounds.last<3>(), box.max);
  return box;
}

py::array_t<std::int64_t> startsOf(const std::vector<std::size_t>& starts) {
  py::array_t<std::int64_t> array(static_cast<py::ssize_t>(starts.size()));
  std::ranges::transform(starts, array.mutable_data(),
                         [](std::size_t start) { return static_cast<std::int64_t>(start); });
  return array;
}

/// A field of all items.
template <class T, class Value>
py::array_t<Value> fieldOf(const std::vector<T>& items, Value T::* field) {
  py::array_t<Value> array(static_cast<py::ssize_t>(items.size()));
  std::ranges::transform(items, array.mutable_data(),
                         [field](const T& item) { return item.*field; });
  return array;
}

/// Calls run one at a time, also those that release the global lock.
class PythonBroadPhase {
 public:
  explicit PythonBroadPhase(const broadphase::Options& options) : broad_phase_(options) {}

  /// `boxes` (n, 2, 3): the coordinates of a corner are contiguous, all others anywhere.
  void update(const py::array_t<float, 0>& boxes,
              const std::optional<py::array_t<std::uint32_t, py::array::c_style>>& changed) {
    const auto corners = boxes.unchecked<3>();
    const auto count = static_cast<std::size_t>(corners.shape(0));
    broadphase::Boxes read;
    if (count > 0) {
      read = {corners.data(0, 0, 0), corners.data(0, 1, 0), count,
              static_cast<std::size_t>(boxes.strides(0))};
    }
    std::optional<std::span<const std::uint32_t>> listed;
    if (changed) listed.emplace(changed->data(), static_cast<std::size_t>(changed->size()));
    const Use use(in_use_);
    const py::gil_scoped_release release;
    if (listed) {
      broad_phase_.update(read, *listed);
    } else {
      broad_phase_.update(read);
    }
  }

  void setFilter(std::uint32_t body, std::uint32_t layer, const std::vector<std::uint32_t>& tags) {
    const Use use(in_use_);
    broadphase::Filter filter{.layer = layer};
    for (std::size_t i = 0; i < tags.size(); ++i) filter.tags.at(i) = tags[i];
    broad_phase_.setFilter(body, filter);
  }

  py::array_t<std::uint32_t> pairs() {
    const Use use(in_use_);
    return copied(broad_phase_.pairs());
  }
  py::array_t<std::uint32_t> began() {
    const Use use(in_use_);
    return copied(broad_phase_.began());
  }
  py::array_t<std::uint32_t> ended() {
    const Use use(in_use_);
    return copied(broad_phase_.ended());
  }
  std::size_t size() {
    const Use use(in_use_);
    return broad_phase_.size();
  }

  // Queries: a row of an array for each. Answers: where each one starts, the bodies, and their
  // fractions or distances.

  py::tuple overlapping(const Floats& boxes, std::uint32_t layers) {
    std::vector<broadphase::BoxQuery> queries;
    for (std::size_t i = 0; i < static_cast<std::size_t>(boxes.shape(0)); ++i) {
      queries.push_back({boxOf(rowOf(boxes, i)), layers});
    }
    broadphase::QueryResults<std::uint32_t> found;
    run([&] { broad_phase_.overlapping(queries, found); });
    py::array_t<std::uint32_t> bodies(static_cast<py::ssize_t>(found.items.size()));
    std::ranges::copy(found.items, bodies.mutable_data());
    return py::make_tuple(startsOf(found.starts), bodies);
  }

  py::tuple cast(const Floats& boxes, const Floats& directions, const Floats& max_fractions,
                 const std::string& hits, std::uint32_t layers) {
    std::vector<broadphase::Cast> casts;
    for (std::size_t i = 0; i < static_cast<std::size_t>(boxes.shape(0)); ++i) {
      broadphase::Cast& cast = casts.emplace_back();
      cast.box = boxOf(rowOf(boxes, i));
      std::ranges::copy(rowOf(directions, i), cast.direction);
      cast.max_fraction = rowOf(max_fractions, i)[0];
      cast.layers = layers;
    }
    const broadphase::Hits wanted = valueOf(kHits, "hits", hits);
    broadphase::QueryResults<broadphase::CastHit> found;
    run([&] { broad_phase_.cast(casts, wanted, found); });
    return py::make_tuple(startsOf(found.starts), fieldOf(found.items, &broadphase::CastHit::body),
                          fieldOf(found.items, &broadphase::CastHit::fraction));
  }

  py::tuple nearest(const Floats& points, std::uint32_t count, const Floats& max_distances,
                    std::uint32_t layers) {
    std::vector<broadphase::NearestQuery> queries;
    for (std::size_t i = 0; i < static_cast<std::size_t>(points.shape(0)); ++i) {
      broadphase::NearestQuery& query = queries.emplace_back();
      std::ranges::copy(rowOf(points, i), query.point);
      query.count = count;
      query.max_distance = rowOf(max_distances, i)[0];
      query.layers = layers;
    }
    broadphase::QueryResults<broadphase::Neighbour> found;
    run([&] { broad_phase_.nearest(queries, found); });
    return py::make_tuple(startsOf(found.starts),
                          fieldOf(found.items, &broadphase::Neighbour::body),
                          fieldOf(found.items, &broadphase::Neighbour::distance));
  }

  py::bytes save() {
    const Use use(in_use_);
    broad_phase_.save(state_);
    return {reinterpret_cast<const char*>(state_.data()), state_.size()};
  }
  void restore(const py::bytes& state) {
    const auto bytes = static_cast<std::string_view>(state);
    const Use use(in_use_);
    const py::gil_scoped_release release;
    broad_phase_.restore(std::as_bytes(std::span(bytes)));
  }

 private:
  /// Marks the object as in use. Only made and destroyed with the global lock, so that no call can
  /// begin while the answer of another is copied.
  class Use {
   public:
    explicit Use(bool& in_use) : in_use_(in_use) {
      if (in_use_) {
        throw InputError("BroadPhase: a concurrent call on the same object, from another thread");
      }
      in_use_ = true;
    }
    ~Use() { in_use_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    bool& in_use_;
  };

  /// Without the global lock.
  template <class Call>
  void run(Call call) {
    const Use use(in_use_);
    const py::gil_scoped_release release;
    call();
  }

  broadphase::BroadPhase broad_phase_;
  std::vector<std::byte> state_;
  bool in_use_ = false;
};

}  // namespace

void defineBroadPhase(py::module_& module) {
  const auto create = [](const std::string& method, const std::string& answer,
                         const std::string& order, const std::string& changes, int threads,
                         const std::string& isa, double margin,
                         const std::array<std::uint32_t, 32>& collides) {
    return std::make_unique<PythonBroadPhase>(
        broadphase::Options{.method = valueOf(kMethods, "method", method),
                            .answer = valueOf(kAnswers, "answer", answer),
                            .order = valueOf(kOrders, "order", order),
                            .changes = valueOf(kChanges, "changes", changes),
                            .threads = threads,
                            .instruction_set = valueOf(kInstructionSets, "isa", isa),
                            .margin = roundedUp(margin),
                            .collides = collides});
  };
  py::class_<PythonBroadPhase>(module, "BroadPhase")
      .def(py::init(create))
      .def("update", &PythonBroadPhase::update, py::arg("boxes").noconvert(),
           py::arg("changed").noconvert())
      .def("set_filter", &PythonBroadPhase::setFilter)
      .def("pairs", &PythonBroadPhase::pairs)
      .def("began", &PythonBroadPhase::began)
      .def("ended", &PythonBroadPhase::ended)
      .def("overlapping", &PythonBroadPhase::overlapping)
      .def("cast", &PythonBroadPhase::cast)
      .def("nearest", &PythonBroadPhase::nearest)
      .def("size", &PythonBroadPhase::size)
      .def("save", &PythonBroadPhase::save)
      .def("restore", &PythonBroadPhase::restore);
}

}  // namespace broadmark
