// Cases: the units of a benchmark.
//
// Example:
//
//   const auto name = [](const Algorithm& algorithm) {
//     const Case test_case = makeCase(algorithm, Isa::avx2, 4, "", {{"margin", "0.1"}});
//     const std::unique_ptr<BroadPhase> instance = makeInstance(test_case);
//     return caseName(test_case);  // "kd-mt/avx2/t4/margin=0.1"
//   };
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "broadmark/algorithm.h"
#include "broadmark/answer.h"
#include "broadmark/execution.h"
#include "broadmark/frame.h"
#include "broadmark/parameters.h"

namespace broadmark {

/// An algorithm with its settings: a plain value. CaseRun and its executor check it.
struct Case {
  Algorithm algorithm;
  /// Instruction set of the kernels; scalar unless AlgorithmTraits::vectorised.
  Isa isa = Isa::scalar;
  int threads = 1;                  ///< the calling thread included; 1 unless traits.parallel
  std::string device = {};          ///< as ExecutionContext::device()
  ParameterValues parameters = {};  ///< values that differ from the default
  Answer answer = {};               ///< the expected answer: pairs, events or queries
};

/// A case of `algorithm`, with neutral values for the settings that it ignores: the scalar
/// instruction set, one thread. Retains `device` and `parameters` without a check.
Case makeCase(const Algorithm& algorithm, Isa isa, int threads, std::string device,
              ParameterValues parameters, Answer answer = {});

/// "bf-simd-mt/avx2/t4/events/key=value": the part of a case's id without the recording. Without
/// the device: cases that differ only in their device have the same name.
std::string caseName(const Case&);

/// A case's id with the present names of its parameters: files may hold former names. Renames the
/// parts "key=value" at the end of the id, and sorts them by name.
std::string currentCaseId(std::string_view id);

/// Creates an instance of the case's algorithm with its parameters, without threads or device.
/// Throws InputError for an unknown parameter or an invalid value.
std::unique_ptr<BroadPhase> makeInstance(const Case&);

}  // namespace broadmark
