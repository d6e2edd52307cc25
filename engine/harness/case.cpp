// Cases by name.

#include "broadmark/harness/case.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace broadmark {
namespace {

std::string parameterParts(const ParameterValues& parameters) {
  std::string parts;
  for (const auto& [key, value] : parameters) parts += fmt::format("/{}={}", key, value);
  return parts;
}

}  // namespace

Case makeCase(const Algorithm& algorithm, Isa isa, int threads, std::string device,
              ParameterValues parameters, Answer answer) {
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
    name += fmt::format("/{}", answerName(test_case.answer));
  }
  return name + parameterParts(test_case.parameters);
}

std::string currentCaseId(std::string_view id) {
  ParameterValues parameters;
  for (std::size_t slash = id.rfind('/'); slash != id.npos; slash = id.rfind('/')) {
    const std::string_view part = id.substr(slash + 1);
    const std::size_t equals = part.find('=');
    if (equals == part.npos) break;
    parameters.emplace(currentParameterName(part.substr(0, equals)), part.substr(equals + 1));
    id = id.substr(0, slash);
  }
  return std::string(id) + parameterParts(parameters);
}

std::unique_ptr<BroadPhase> makeInstance(const Case& test_case) {
  auto instance = test_case.algorithm.create();
  setParameters(*instance, test_case.parameters);
  return instance;
}

}  // namespace broadmark
