// Algorithm ids of the original Broadmark.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "broadmark/execution.h"

namespace broadmark {

struct OriginalId {
  std::string_view name;        ///< in the original: "BF_SSE"
  std::string_view algorithm;   ///< id in this program: "bf-simd"
  std::optional<Isa> isa = {};  ///< instruction set stated by the name
};

/// All ids of the original.
std::span<const OriginalId> originalIds();

/// Returns the id with this name, or null.
const OriginalId* findOriginalId(std::string_view name);

}  // namespace broadmark
