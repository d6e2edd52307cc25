// A case: an algorithm with all that can vary about it.
#pragma once

#include <memory>
#include <string>

#include "broadmark/algorithm.h"
#include "broadmark/execution.h"
#include "broadmark/frame.h"
#include "broadmark/parameters.h"

namespace broadmark {

/// What to run.
struct Case {
  Algorithm algorithm;
  Isa isa = Isa::scalar;
  int threads = 1;
  std::string device = {};          ///< as Execution::device()
  ParameterValues parameters = {};  ///< those that differ from the default
};

/// A case of `algorithm`; what it does not heed is left at its neutral value.
Case makeCase(const Algorithm& algorithm, Isa isa, int threads, std::string device,
              ParameterValues parameters);

/// "bf-simd-mt/avx2/t4/key=value": what of a case does not depend on the recording.
std::string caseName(const Case&);

/// A new instance of the case's algorithm with its parameters. Throws InputError for a bad one.
std::unique_ptr<BroadPhase> makeInstance(const Case&);

}  // namespace broadmark
