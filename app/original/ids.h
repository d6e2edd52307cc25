// The ids by which the original Broadmark calls its algorithms.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "broadmark/execution.h"

namespace broadmark {

struct OriginalId {
  std::string_view name;        ///< there: "BF_SSE"
  std::string_view algorithm;   ///< our id: "bf-simd"
  std::optional<Isa> isa = {};  ///< the instruction set that the name states
};

/// All of them.
std::span<const OriginalId> originalIds();

/// Finds an id by name; null if there is none.
const OriginalId* findOriginalId(std::string_view name);

}  // namespace broadmark
