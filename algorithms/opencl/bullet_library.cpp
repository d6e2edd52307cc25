#include "opencl/bullet_library.h"

#include <Bullet3Common/b3Logging.h>
#include <Bullet3OpenCL/Initialize/b3OpenCLUtils.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadmark/error.h"

// Exported by the library, but missing in its headers.
// NOLINTBEGIN(readability-identifier-naming)
int b3OpenCLUtils_clewInit();
extern bool gDebugSkipLoadingBinary;
extern cl_kernel kCalcHashAABB;
extern cl_kernel kClearCellStart;
extern cl_kernel kFindCellStart;
extern cl_kernel kFindOverlappingPairs;
extern cl_kernel m_copyAabbsKernel;
extern cl_kernel m_sap2Kernel;
// NOLINTEND(readability-identifier-naming)

namespace broadmark::opencl {
namespace {

/// Bullet reports errors only by a callback: the last one on this thread.
thread_local std::string last_error;

constexpr std::array kGlobalKernels = {&kCalcHashAABB,         &kClearCellStart,   &kFindCellStart,
                                       &kFindOverlappingPairs, &m_copyAabbsKernel, &m_sap2Kernel};

}  // namespace

void loadBulletLibrary() {
  static const int status = [] {
    gDebugSkipLoadingBinary = true;  // otherwise it writes a cache beside the program
    b3OpenCLUtils_setCachePath("/dev/null");
    // Otherwise PoCL prints the number of warnings in Bullet's kernels on standard error.
    ::setenv("POCL_EXTRA_BUILD_FLAGS", "-w", 0);
    const auto ignore = [](const char*) {};
    b3SetCustomPrintfFunc(ignore);
    b3SetCustomWarningMessageFunc(ignore);
    b3SetCustomErrorMessageFunc([](const char* message) { last_error = message; });
    return b3OpenCLUtils_clewInit();
  }();
  if (status != 0) throw UnsupportedError("libOpenCL cannot be loaded");
}

void requireNoBulletError() {
  if (last_error.empty()) return;
  std::string message = std::exchange(last_error, {});
  std::ranges::replace(message, '\n', ' ');
  throw std::runtime_error("Bullet: " + message);
}

void dropBulletError() { last_error.clear(); }

BulletGrid::BulletGrid(cl_context context, cl_device_id device, cl_command_queue queue)
    : b3GpuGridBroadphase(context, device, queue) {
  std::ranges::transform(kGlobalKernels, kernels_.begin(), [](cl_kernel* from) { return *from; });
}

void BulletGrid::putKernelsInPlace() const {
  for (std::size_t i = 0; i < kernels_.size(); ++i) *kGlobalKernels[i] = kernels_[i];
}

void BulletGrid::setCellSize(float size) {
  constexpr int kUnlimited = 1 << 20;
  for (int axis = 0; axis < 3; ++axis) m_paramsCPU.m_invCellSize[axis] = 1 / size;
  m_paramsCPU.setMaxBodiesPerCell(kUnlimited);
  m_paramsGPU.resize(1);
  m_paramsGPU.copyFromHostPointer(&m_paramsCPU, 1);
}

}  // namespace broadmark::opencl
