// Python bindings of the algorithms: boxes in, overlapping pairs out. The package's overlaps()
// validates the arguments. Boxes are copied into the algorithms' padded layout, and pairs from the
// per-thread runs of the algorithm. Algorithms that might end the interpreter run in a worker
// process.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "broad_phase.h"
#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/execution.h"
#include "broadmark/harness/case_run.h"
#include "broadmark/harness/memory_limit.h"
#include "broadmark/harness/worker_process.h"
#include "broadmark/names.h"

namespace py = pybind11;

namespace broadmark {
namespace {

using Boxes = py::array_t<float, py::array::c_style>;
using Pairs = py::array_t<std::uint32_t>;

std::vector<Algorithm> algorithmsThatFindPairs() {
  std::vector<Algorithm> all = builtinAlgorithms();
  std::erase_if(all, [](const Algorithm& algorithm) { return !algorithm.traits.finds_pairs; });
  return all;
}

std::vector<std::string> idsOf(const std::vector<Algorithm>& algorithms) {
  std::vector<std::string> ids;
  for (const Algorithm& algorithm : algorithms) ids.push_back(algorithm.id);
  return ids;
}

Algorithm algorithmOf(const std::string& id) {
  const std::vector<Algorithm> all = algorithmsThatFindPairs();
  const auto found = std::ranges::find(all, id, &Algorithm::id);
  if (found == all.end()) throw InputError(unknownName("algorithm", id, idsOf(all)));
  return *found;
}

Isa isaOf(const std::string& name) {
  if (name == "auto") return bestIsa();
  const std::optional<Isa> isa = kIsas.find(name);
  if (!isa) throw InputError("isa '" + name + "': expected auto or an instruction set");
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

/// The overlapping pairs of the last frame, without the false pairs of a conservative algorithm.
std::vector<Pair> overlapping(PairRuns runs, const std::vector<Aabb>& boxes, bool exact) {
  std::vector<Pair> pairs;
  pairs.reserve(pairCount(runs));
  for (const PairRun source : runs) {
    if (exact) {
      pairs.insert(pairs.end(), source.begin(), source.end());
    } else {
      std::ranges::copy_if(source, std::back_inserter(pairs), [&](const Pair& pair) {
        return overlaps(boxes[pair.a], boxes[pair.b]);
      });
    }
  }
  return pairs;
}

/// Whether the user has pressed Ctrl-C, or another signal's handler raises an exception, which is
/// then Python's current one.
bool isInterrupted() {
  const py::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() != 0;
}

/// What a worker process may take: as much as this process by its own limit.
std::uint64_t memoryOfWorkers() {
  rlimit own{};
  if (::getrlimit(RLIMIT_DATA, &own) != 0) return machineMemory();
  return std::min<std::uint64_t>(machineMemory(), own.rlim_cur);
}

/// Runs the case in this process, unless its library might end that, or links to the program.
ExecutorFactory executorsFor(const Algorithm& algorithm, const std::string& program) {
  if (!algorithm.traits.library_aborts && algorithm.plugin.empty()) return makeInProcessExecutor;
  if (program.empty()) {
    throw InputError(algorithm.id +
                     ": runs in a process of the program broadmark, which was not found: build it, "
                     "or set $BROADMARK to its path");
  }
  return [program](const Case& test_case, CancelQuery cancelled) {
    return makeWorkerProcess(test_case, {.command = {program, "worker"},
                                         .hard_limit = std::chrono::years(100),
                                         .memory_limit_bytes = memoryOfWorkers(),
                                         .cancelled = std::move(cancelled)});
  };
}

std::string failureOf(const CaseRun& case_run, const Algorithm& algorithm) {
  std::string text = algorithm.id + ": " + case_run.reason();
  if (algorithm.traits.library_aborts && case_run.status() == Status::error) {
    text += "; its library exits when memory runs out";
  }
  return text;
}

std::vector<Pair> findPairs(std::span<const float> numbers, const Case& test_case,
                            const std::string& program) {
  const std::vector<Aabb> boxes = copied(numbers);
  CaseRun case_run(test_case, RunPolicy::unlimited(CheckMode::off),
                   executorsFor(test_case.algorithm, program), isInterrupted);
  // Algorithms expect a frame after the initial pose.
  if (case_run.start(sceneOf(boxes), {.index = 0, .boxes = boxes})) {
    case_run.step({.index = 1, .boxes = boxes});
  }
  if (case_run.status() != Status::ok) {
    throw InputError(failureOf(case_run, test_case.algorithm));
  }
  std::vector<Pair> pairs = overlapping(case_run.answer(), boxes, case_run.margin() == 0);
  if (case_run.status() != Status::ok) {  // the answer of a worker process comes later
    throw InputError(failureOf(case_run, test_case.algorithm));
  }
  return pairs;
}

/// By the algorithm of a plug-in, which only the worker process loads.
std::vector<Pair> findPairsByPlugin(std::span<const float> numbers, const Case& test_case,
                                    const std::string& program) {
  const std::vector<Aabb> boxes = copied(numbers);
  const auto executor = executorsFor(test_case.algorithm, program)(test_case, isInterrupted);
  try {
    executor->start(sceneOf(boxes), {0, boxes, std::span<const std::uint32_t>()});
    executor->step({1, boxes, std::span<const std::uint32_t>()});
    return overlapping(executor->answer(), boxes, false);
  } catch (const std::runtime_error& error) {  // the plug-in's, or the end of its process
    throw InputError(test_case.algorithm.id + ": " + error.what());
  }
}

/// The array takes ownership of the pairs.
Pairs asArray(std::vector<Pair> pairs) {
  const auto* owned = new std::vector<Pair>(std::move(pairs));
  const py::capsule owner(owned,
                          [](void* memory) { delete static_cast<std::vector<Pair>*>(memory); });
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(owned->size()), 2};
  const auto* first = reinterpret_cast<const std::uint32_t*>(owned->data());
  return Pairs(shape, first, owner);
}

/// Replaces former names of parameters, with a FutureWarning.
ParameterValues withCurrentNames(const ParameterValues& parameters) {
  ParameterValues renamed;
  for (const auto& [name, value] : parameters) {
    const std::string current(currentParameterName(name));
    renamed.emplace(current, value);
    const std::string warning = "'" + name + "' is now called '" + current + "'";
    if (current != name && PyErr_WarnEx(PyExc_FutureWarning, warning.c_str(), 2) != 0) {
      throw py::error_already_set();
    }
  }
  return renamed;
}

Pairs overlapsOf(const Boxes& boxes, const std::string& algorithm, int threads,
                 const std::string& isa, const ParameterValues& parameters,
                 const std::string& plugin, const std::string& program) {
  const bool built_in = plugin.empty();
  const Case test_case = built_in ? makeCase(algorithmOf(algorithm), isaOf(isa), threads, "",
                                             withCurrentNames(parameters))
                                  : Case{.algorithm = {.id = algorithm, .plugin = plugin},
                                         .isa = isaOf(isa),
                                         .threads = threads,
                                         .parameters = parameters};
  const std::span<const float> numbers(boxes.data(), static_cast<std::size_t>(boxes.size()));
  std::vector<Pair> pairs;
  try {
    const py::gil_scoped_release release;
    pairs = (built_in ? findPairs : findPairsByPlugin)(numbers, test_case, program);
  } catch (const Cancelled&) {
    throw py::error_already_set();
  }
  return asArray(std::move(pairs));
}

/// Bad input and misuse, and what an update may fail by, become the package's InputError.
void translateError(std::exception_ptr error) {
  const auto raise = [](const char* text) {
    PyErr_SetString(py::module_::import("broadmark.errors").attr("InputError").ptr(), text);
  };
  try {
    if (error) std::rethrow_exception(std::move(error));
  } catch (const InputError& input_error) {
    raise(input_error.what());
  } catch (const std::logic_error& misuse) {
    raise(misuse.what());
  } catch (const std::system_error& system_error) {
    raise(system_error.what());
  } catch (const std::bad_alloc&) {
    raise("not enough memory");
  }
}

}  // namespace
}  // namespace broadmark

PYBIND11_MODULE(_native, module) {
  py::register_local_exception_translator(&broadmark::translateError);
  module.def("overlaps", &broadmark::overlapsOf, py::arg("boxes").noconvert(), py::arg("algorithm"),
             py::arg("threads"), py::arg("isa"), py::arg("parameters"), py::arg("plugin"),
             py::arg("program"));
  module.def("algorithms", [] { return broadmark::idsOf(broadmark::algorithmsThatFindPairs()); });
  broadmark::defineBroadPhase(module);
}
