// A case: an algorithm with all of its settings.
#pragma once

#include <memory>
#include <string>

#include "broadmark/algorithm.h"
#include "broadmark/execution.h"
#include "broadmark/frame.h"
#include "broadmark/names.h"
#include "broadmark/parameters.h"

namespace broadmark {

/// The kind of answer per frame: all pairs, or only those that began or ended since the frame
/// before.
enum class AnswerKind { pairs, events };
inline constexpr NameTable kAnswerKinds{
    {NamedValue{AnswerKind::pairs, "pairs"}, {AnswerKind::events, "events"}}};

/// What to run.
struct Case {
  Algorithm algorithm;
  Isa isa = Isa::scalar;
  int threads = 1;
  std::string device = {};          ///< as ExecutionContext::device()
  ParameterValues parameters = {};  ///< values that differ from the default
  AnswerKind answer = AnswerKind::pairs;
};

/// A case of `algorithm`; settings that it ignores are left at neutral values.
Case makeCase(const Algorithm& algorithm, Isa isa, int threads, std::string device,
              ParameterValues parameters, AnswerKind answer = AnswerKind::pairs);

/// "bf-simd-mt/avx2/t4/events/key=value": the part of a case's id without the recording.
std::string caseName(const Case&);

/// A new instance of the case's algorithm with its parameters. Throws InputError for an invalid
/// one.
std::unique_ptr<BroadPhase> makeInstance(const Case&);

}  // namespace broadmark
