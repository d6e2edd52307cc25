// Listing the variants of a family, which have most of their entry in common.
#pragma once

#include <functional>
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

/// The entry of a variant; `family` has what all variants share.
inline Algorithm variantOf(Algorithm family, std::function<std::unique_ptr<BroadPhase>()> create,
                           std::string id, std::string summary, Ways ways = {}) {
  family.id = std::move(id);
  family.summary = std::move(summary);
  family.traits.parallel = ways.parallel;
  family.traits.vectorised = ways.vectorised;
  family.create = std::move(create);
  return family;
}

}  // namespace broadmark
