#include "request/count.h"

#include <fmt/format.h>

#include "broadmark/error.h"
#include "broadmark/harness/processor_counters.h"
#include "broadmark/scenes/simulation.h"
#include "request/run_request.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// The widest instruction set that can be counted: valgrind has no AVX-512.
Isa widestIsa(const RunRequest& request) {
  const bool is_unknown_to_valgrind = request.hosts.valgrind && bestIsa() == Isa::avx512;
  return is_unknown_to_valgrind ? Isa::avx2 : bestIsa();
}

}  // namespace

CountOptions parseCount(const std::string& text) {
  const std::vector<std::string> parts = splitAt(':', text);
  CountOptions count{.instructions = true};
  if (parts.front() != kInstructions || parts.size() > 2) {
    throw InputError(
        fmt::format("--count: '{}' is not of the form {}[:FRAMES]", text, kInstructions));
  }
  if (parts.size() == 2) {
    count.frames = static_cast<std::uint32_t>(parseInteger(parts[1], "--count", 1, kMaxFrames));
  }
  return count;
}

std::string countText(const CountOptions& count) {
  if (!count.instructions) return {};
  return count.frames == CountOptions().frames ? kInstructions
                                               : fmt::format("{}:{}", kInstructions, count.frames);
}

void prepareCount(RunRequest& request) {
  if (!request.count.instructions) return;
  if (request.repetitions.until_precise) {
    throw InputError("--repetitions auto: cannot be combined with --count: counts hardly vary");
  }
  const auto source =
      ProcessorCounters::countInstructions() ? CounterSource::processor : CounterSource::valgrind;
  request.hosts.valgrind = source == CounterSource::valgrind;
  if (request.hosts.valgrind && request.hosts.in_process) {
    throw InputError(
        "--in-process: cannot be combined with --count: valgrind counts in a worker "
        "process, as this system does not allow the processor's counters");
  }
  request.policy = RunPolicy::unlimited(request.policy.check);
  request.policy.counted_by = source;
  request.policy.max_frames = request.count.frames;
  CaseOptions& cases = request.cases;
  if (cases.threads.empty()) cases.threads = {1};
  if (cases.isas.empty()) cases.isas = {widestIsa(request)};  // which the case's id states
}

Case countedCaseNamed(const std::string& name, const RunRequest& request) {
  return caseNamed(name, request.cases.device, request.cases.answer,
                   {.isa = widestIsa(request), .threads = 1});
}

void requireOneThread(const std::vector<Case>& cases) {
  for (const Case& test_case : cases) {
    if (test_case.threads == 1) continue;
    throw InputError(
        fmt::format("--count: {}: instructions are counted on one thread only (--threads 1)",
                    caseName(test_case)));
  }
}

}  // namespace broadmark
