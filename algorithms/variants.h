// Registry entries of algorithm variants that share most of their fields.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "broadmark/algorithm.h"

namespace broadmark {

struct VariantOptions {
  bool parallel = false;
  bool vectorised = false;
};

/// The registry entry of a variant. `family` has the shared fields.
inline Algorithm variantOf(Algorithm family, std::function<std::unique_ptr<BroadPhase>()> create,
                           std::string id, std::string summary, VariantOptions options = {}) {
  family.id = std::move(id);
  family.summary = std::move(summary);
  family.traits.parallel = options.parallel;
  family.traits.vectorised = options.vectorised;
  family.create = std::move(create);
  return family;
}

}  // namespace broadmark
