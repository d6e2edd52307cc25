// Base of adapters around one algorithm.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Forwards the calls that adapters rarely change.
class Adapter : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) final { algorithm_->visitParameters(visit); }
  [[nodiscard]] float margin() const final { return algorithm_->margin(); }
  void cleanCache() override { algorithm_->cleanCache(); }
  void updateStructures() final { algorithm_->updateStructures(); }
  [[nodiscard]] PairRuns overlaps() const override { return algorithm_->overlaps(); }
  [[nodiscard]] TransferTimes transfers() const final { return algorithm_->transfers(); }
  void drawStructure(DebugDraw& draw) const override { algorithm_->drawStructure(draw); }
  void visitSetup(const CounterVisitor& visit) const final { algorithm_->visitSetup(visit); }
  [[nodiscard]] std::string validate() const override { return algorithm_->validate(); }

 protected:
  explicit Adapter(std::unique_ptr<BroadPhase> algorithm) : algorithm_(std::move(algorithm)) {}

  std::unique_ptr<BroadPhase> algorithm_;
};

}  // namespace broadmark
