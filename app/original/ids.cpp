// Algorithm ids of the original Broadmark, copied from its source code.

#include "original/ids.h"

#include <algorithm>

namespace broadmark {
namespace {

constexpr OriginalId kOriginalIds[] = {
    {"BF", "bf"},
    {"BF_SSE", "bf-simd", Isa::sse2},
    {"BF_AVX", "bf-simd", Isa::avx2},
    {"BF_Parallel", "bf-mt"},
    {"BF_SSE_Parallel", "bf-simd-mt", Isa::sse2},
    {"BF_AVX_Parallel", "bf-simd-mt", Isa::avx2},
    {"SAP", "sap"},
    {"SAP_SSE", "sap-simd", Isa::sse2},
    {"SAP_AVX", "sap-simd", Isa::avx2},
    {"SAP_Parallel", "sap-mt"},
    {"SAP_SSE_Parallel", "sap-simd-mt", Isa::sse2},
    {"SAP_AVX_Parallel", "sap-simd-mt", Isa::avx2},
    {"Grid_3D", "grid-bf"},
    {"Grid_3D_Parallel", "grid-bf-mt"},
    {"Grid_2D", "grid2d-bf"},
    {"Grid_2D_Parallel", "grid2d-bf-mt"},
    {"Grid_3D_SAP", "grid-sap"},
    {"Grid_3D_SAP_Parallel", "grid-sap-mt"},
    {"Grid_2D_SAP", "grid2d-sap"},
    {"Grid_2D_SAP_Parallel", "grid2d-sap-mt"},
    {"AxisSweep", "axis-sweep"},
    {"DBVT F", "dbvt-f"},
    {"DBVT D", "dbvt-d"},
    {"CGAL", "cgal"},
    {"Tracy", "tracy"},
    {"Tracy_Parallel", "tracy-mt"},
    {"KD", "kd"},
    {"GPU_Grid", "b3-grid"},
    {"GPU_LBVH", "b3-lbvh"},
    {"GPU_SAP", "b3-sap"},
    {"None", "none"},
    {"TimeValidator", "time-validator"},
};

}  // namespace

std::span<const OriginalId> originalIds() { return kOriginalIds; }

const OriginalId* findOriginalId(std::string_view name) {
  const auto* found = std::ranges::find(kOriginalIds, name, &OriginalId::name);
  return found == std::end(kOriginalIds) ? nullptr : found;
}

}  // namespace broadmark
