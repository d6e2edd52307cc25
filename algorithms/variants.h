// Registry entries of algorithm variants that share most of their fields.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "broadmark/algorithm.h"

namespace broadmark {

struct VariantOptions {
  bool parallel = false;
  bool vectorised = false;
};

/// The registry entry of a variant, which is constructed from `arguments`. `family` has the shared
/// fields.
template <class Phase, class... Arguments>
Algorithm variantOf(Algorithm family, std::string id, std::string summary,
                    VariantOptions options = {}, Arguments... arguments) {
  family.id = std::move(id);
  family.summary = std::move(summary);
  family.traits.parallel = options.parallel;
  family.traits.vectorised = options.vectorised;
  family.create = [arguments...] { return std::make_unique<Phase>(arguments...); };
  return family;
}

}  // namespace broadmark
