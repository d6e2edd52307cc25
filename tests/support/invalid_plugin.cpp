// A plug-in whose algorithms must be refused. The variable INVALID_PLUGIN chooses the fault.

#include <cstdlib>
#include <memory>
#include <string>

#include "broadmark/plugin.h"

namespace broadmark::invalid {
namespace {

std::string fault() {
  const char* text = std::getenv("INVALID_PLUGIN");
  return text == nullptr ? "" : text;
}

class Invalid final : public BoxBroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    if (fault() == "range") cells_ = 11;
    visit({.name = "cells", .doc = "a number", .value = &cells_, .min = 1, .max = 10});
    if (fault() == "choice") visit({.name = "mode", .doc = "a choice", .value = &mode_});
    if (fault() != "twice") return;
    visit({.name = "cells", .doc = "another", .value = &other_, .min = 1, .max = 10});
  }

 private:
  void findPairs() override {}

  std::int64_t cells_ = 1;
  std::int64_t other_ = 1;
  Choice mode_{"absent", {"this", "that"}};
};

std::vector<Algorithm> variants() {
  if (fault() == "empty") return {};
  return {{.id = "invalid",
           .family = "Invalid",
           .summary = "finds nothing",
           .description = {.principle = "none",
                           .time = "O(1)",
                           .space = "O(1)",
                           .source = "a test of Broadmark's"},
           .create = []() -> std::unique_ptr<BroadPhase> {
             if (fault() == "crash") std::abort();
             return std::make_unique<Invalid>();
           }}};
}

}  // namespace
}  // namespace broadmark::invalid

BROADMARK_PLUGIN(broadmark::invalid::variants);
