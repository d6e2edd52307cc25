// Bullet 3's OpenCL library: loading, errors, and its grid with kernels per instance.
//
// The grid's six kernels are global variables of the library: its constructor overwrites them, its
// search uses them, and its destructor releases their present values. So each grid here stores its
// own six and installs them. The only other process-wide state of Bullet's three broad phases is
// set once: the loaded OpenCL and the message callbacks.
#pragma once

#include <Bullet3OpenCL/BroadphaseCollision/b3GpuGridBroadphase.h>

#include <array>

namespace broadmark::opencl {

/// Loads the library's OpenCL and silences it, once per process. Throws UnsupportedError.
void loadBulletLibrary();

/// Throws Bullet's last error on this thread, if any, and clears it.
void requireNoBulletError();
void dropBulletError();

/// The library's grid with kernels per instance, and with two settings that are private in the
/// library. Calls of all instances must be serialised.
class BulletGrid final : public b3GpuGridBroadphase {
 public:
  BulletGrid(cl_context context, cl_device_id device, cl_command_queue queue);
  /// The library's destructor releases the global kernels.
  ~BulletGrid() override { putKernelsInPlace(); }
  BulletGrid(const BulletGrid&) = delete;
  BulletGrid& operator=(const BulletGrid&) = delete;

  void calculateOverlappingPairs(int max_pairs) override {
    putKernelsInPlace();
    b3GpuGridBroadphase::calculateOverlappingPairs(max_pairs);
  }

  /// Sets the cell edge; cells hold any number of bodies.
  void setCellSize(float size);

 private:
  void putKernelsInPlace() const;

  std::array<cl_kernel, 6> kernels_{};
};

}  // namespace broadmark::opencl
