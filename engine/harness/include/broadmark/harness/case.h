// Cases: the units of a benchmark.
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

/// An algorithm with its settings.
struct Case {
  Algorithm algorithm;
  Isa isa = Isa::scalar;
  int threads = 1;
  std::string device = {};          ///< as ExecutionContext::device()
  ParameterValues parameters = {};  ///< values that differ from the default
  Answer answer = {};
};

/// A case of `algorithm`, with neutral values for settings that it ignores.
Case makeCase(const Algorithm& algorithm, Isa isa, int threads, std::string device,
              ParameterValues parameters, Answer answer = {});

/// "bf-simd-mt/avx2/t4/events/key=value": the part of a case's id without the recording.
std::string caseName(const Case&);

/// A case's id with the present names of its parameters: files may hold former names.
std::string currentCaseId(std::string_view id);

/// Creates an instance of the case's algorithm with its parameters. Throws InputError for an
/// invalid one.
std::unique_ptr<BroadPhase> makeInstance(const Case&);

}  // namespace broadmark
