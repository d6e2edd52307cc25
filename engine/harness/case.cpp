// Cases by name.

#include "broadmark/harness/case.h"

#include <fmt/format.h>

#include <utility>

namespace broadmark {

Case makeCase(const Algorithm& algorithm, Isa isa, int threads, std::string device,
              ParameterValues parameters, AnswerKind answer) {
  return {.algorithm = algorithm,
          .isa = algorithm.traits.vectorised ? isa : Isa::scalar,
          .threads = algorithm.traits.parallel ? threads : 1,
          .device = std::move(device),
          .parameters = std::move(parameters),
          .answer = answer};
}

std::string caseName(const Case& run) {
  const AlgorithmTraits& traits = run.algorithm.traits;
  std::string name = run.algorithm.id;
  if (traits.vectorised) name += fmt::format("/{}", isaName(run.isa));
  if (traits.parallel) name += fmt::format("/t{}", run.threads);
  if (run.answer != AnswerKind::pairs) name += fmt::format("/{}", kAnswerKinds.nameOf(run.answer));
  for (const auto& [key, value] : run.parameters) name += fmt::format("/{}={}", key, value);
  return name;
}

std::unique_ptr<BroadPhase> makeInstance(const Case& run) {
  auto instance = run.algorithm.create();
  setParameters(*instance, run.parameters);
  return instance;
}

}  // namespace broadmark
