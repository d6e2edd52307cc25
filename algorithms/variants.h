// Listing the variants of a family, which have most of their entry in common.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "broadmark/algorithm.h"

namespace broadmark {

/// How a variant can be run.
struct Ways {
  bool parallel = false;
  bool vectorised = false;
};

/// The entry of a variant, made from `arguments`; `family` has what all variants share.
template <class Phase, class... Arguments>
Algorithm variantOf(Algorithm family, std::string id, std::string summary, Ways ways = {},
                    Arguments... arguments) {
  family.id = std::move(id);
  family.summary = std::move(summary);
  family.traits.parallel = ways.parallel;
  family.traits.vectorised = ways.vectorised;
  family.create = [arguments...] { return std::make_unique<Phase>(arguments...); };
  return family;
}

}  // namespace broadmark
