// Replaces opencl/device_context.cpp in a build without OpenCL.

#include "broadmark/compute_devices.h"

namespace broadmark {

std::vector<ComputeDevice> computeDevices() { return {}; }

}  // namespace broadmark
