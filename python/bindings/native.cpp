// The algorithms as a function of Python: a set of boxes in, its overlapping pairs out.
//
// The package's overlaps() checks arrays and names; here only what it needs of C++ is found. Boxes
// are copied once, into the padded layout that all algorithms read; pairs once, as they lie in
// memory of the algorithm's, in one run per thread.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/execution.h"
#include "broadmark/harness/case_run.h"

namespace py = pybind11;

namespace broadmark {
namespace {

using Boxes = py::array_t<float, py::array::c_style>;
using Pairs = py::array_t<std::uint32_t>;

Algorithm algorithmOf(const std::string& id) {
  const std::vector<Algorithm> all = builtinAlgorithms();
  const auto found = std::ranges::find(all, id, &Algorithm::id);
  if (found == all.end()) throw InputError("algorithm '" + id + "': there is none of that id");
  return *found;
}

Isa isaOf(const std::string& name) {
  if (name == "auto") return bestIsa();
  const std::optional<Isa> isa = kIsas.find(name);
  if (!isa) throw InputError("isa '" + name + "': is neither auto nor an instruction set");
  return *isa;
}

std::vector<Aabb> copied(std::span<const float> numbers) {
  std::vector<Aabb> boxes(numbers.size() / 6);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    std::copy_n(&numbers[6 * i], 3, boxes[i].min.begin());
    std::copy_n(&numbers[6 * i + 3], 3, boxes[i].max.begin());
  }
  return boxes;
}

SceneInfo sceneOf(const std::vector<Aabb>& boxes) {
  Aabb world = boxes.empty() ? Aabb{} : boxes.front();
  for (const Aabb& box : boxes) world = merged(world, box);
  return {.name = "array",
          .object_type = "boxes",
          .objects = static_cast<std::uint32_t>(boxes.size()),
          .frames = 1,
          .world = world};
}

/// The pairs of a run's last frame that overlap: a conservative algorithm reports some more.
std::vector<Pair> overlapping(PairRuns runs, const std::vector<Aabb>& boxes, bool exact) {
  std::vector<Pair> pairs;
  pairs.reserve(pairCount(runs));
  for (const PairRun run : runs) {
    if (exact) {
      pairs.insert(pairs.end(), run.begin(), run.end());
    } else {
      std::ranges::copy_if(run, std::back_inserter(pairs), [&](const Pair& pair) {
        return overlaps(boxes[pair.a], boxes[pair.b]);
      });
    }
  }
  return pairs;
}

std::vector<Pair> findPairs(std::span<const float> numbers, const Case& wanted) {
  const std::vector<Aabb> boxes = copied(numbers);
  CaseRun run(wanted, RunPolicy::unlimited(CheckMode::off));
  // An algorithm may expect a frame after the initial pose: it is the same.
  if (run.start(sceneOf(boxes), {.index = 0, .boxes = boxes})) {
    run.step({.index = 1, .boxes = boxes});
  }
  if (run.status() != Status::ok) throw InputError(wanted.algorithm.id + ": " + run.reason());
  return overlapping(run.answer(), boxes, run.margin() == 0);
}

/// The array takes over the memory.
Pairs asArray(std::vector<Pair> pairs) {
  const auto* kept = new std::vector<Pair>(std::move(pairs));
  const py::capsule owner(kept,
                          [](void* memory) { delete static_cast<std::vector<Pair>*>(memory); });
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(kept->size()), 2};
  const auto* first = reinterpret_cast<const std::uint32_t*>(kept->data());
  return Pairs(shape, first, owner);
}

Pairs overlapsOf(const Boxes& boxes, const std::string& algorithm, int threads,
                 const std::string& isa, const ParameterValues& parameters) {
  const std::span<const float> numbers(boxes.data(), static_cast<std::size_t>(boxes.size()));
  std::vector<Pair> pairs;
  {
    const py::gil_scoped_release others_may_run;
    pairs =
        findPairs(numbers, makeCase(algorithmOf(algorithm), isaOf(isa), threads, "", parameters));
  }
  return asArray(std::move(pairs));
}

}  // namespace
}  // namespace broadmark

PYBIND11_MODULE(_native, module) {
  // What the package raises for bad input.
  py::register_local_exception<broadmark::InputError>(module, "NativeInputError", PyExc_ValueError);
  module.def("overlaps", &broadmark::overlapsOf, py::arg("boxes").noconvert(), py::arg("algorithm"),
             py::arg("threads"), py::arg("isa"), py::arg("parameters"));
  module.def("algorithms", [] {
    std::vector<std::string> ids;
    for (const broadmark::Algorithm& one : broadmark::builtinAlgorithms()) {
      if (one.traits.finds_pairs) ids.push_back(one.id);
    }
    return ids;
  });
}
