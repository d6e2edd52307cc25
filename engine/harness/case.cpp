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

std::string caseName(const Case& test_case) {
  const AlgorithmTraits& traits = test_case.algorithm.traits;
  std::string name = test_case.algorithm.id;
  if (traits.vectorised) name += fmt::format("/{}", isaName(test_case.isa));
  if (traits.parallel) name += fmt::format("/t{}", test_case.threads);
  if (test_case.answer != AnswerKind::pairs) {
    name += fmt::format("/{}", kAnswerKinds.nameOf(test_case.answer));
  }
  for (const auto& [key, value] : test_case.parameters) name += fmt::format("/{}={}", key, value);
  return name;
}

std::unique_ptr<BroadPhase> makeInstance(const Case& test_case) {
  auto instance = test_case.algorithm.create();
  setParameters(*instance, test_case.parameters);
  return instance;
}

}  // namespace broadmark
