// Python bindings of the library for engines and games: a class that keeps its state over frames.
// The package's BroadPhase converts the arguments. Boxes are read where they lie, without a copy.

#include "broad_phase.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

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
constexpr NameTable kChanges{
    {NamedValue{Changes::verified, "verified"}, {Changes::trusted, "trusted"}}};
constexpr NameTable kInstructionSets{{NamedValue{InstructionSet::best, "auto"},
                                      {InstructionSet::scalar, "scalar"},
                                      {InstructionSet::sse2, "sse2"},
                                      {InstructionSet::neon, "neon"},
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
        throw InputError(
            "BroadPhase: a call during another one of the same object, from another "
            "thread");
      }
      in_use_ = true;
    }
    ~Use() { in_use_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    bool& in_use_;
  };

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
      .def("size", &PythonBroadPhase::size)
      .def("save", &PythonBroadPhase::save)
      .def("restore", &PythonBroadPhase::restore);
}

}  // namespace broadmark
