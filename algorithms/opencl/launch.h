// Starting kernels.
#pragma once

#include <cstddef>

#include "opencl/opencl.h"

namespace broadmark::opencl {

/// Runs a kernel with these arguments, in order, on `items` work items rounded up to whole groups
/// of `group`. (A stated group size: PoCL compiles a kernel anew for each it has to guess.)
template <class... Arguments>
void launch(const cl::CommandQueue& queue, cl::Kernel& kernel, std::size_t items, std::size_t group,
            const Arguments&... arguments) {
  cl_uint position = 0;
  (kernel.setArg(position++, arguments), ...);
  const std::size_t groups = (items + group - 1) / group;
  if (groups > 0) {
    queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(groups * group),
                               cl::NDRange(group));
  }
}

}  // namespace broadmark::opencl
