// The kernels of the software renderer, written once; compiled for each instruction set by
// splat_kernels.cpp. No function of a standard header may be called here.

#include "splat_vectors.inl"

#include "splat_boxes.inl"
#include "splat_lines.inl"

inline constexpr SplatKernels kKernels = {projectBoxes, splatBoxes,   shadeBoxes,
                                          blendBoxes,   projectLines, drawLines};
