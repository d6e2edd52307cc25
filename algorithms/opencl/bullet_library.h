// Bullet 3's OpenCL library: loading it, its errors, and its grid with kernels of its own.
//
// The grid's six kernels are global variables of the library: its constructor overwrites them, its
// search uses them, and its destructor releases what they hold by then. So each grid here keeps its
// own six and puts them in place. Nothing else that Bullet's three broad phases use is process-wide
// but what is set once: the loaded OpenCL and the callbacks for messages.
#pragma once

#include <Bullet3OpenCL/BroadphaseCollision/b3GpuGridBroadphase.h>

#include <array>

namespace broadmark::opencl {

/// Loads the library's OpenCL and keeps it quiet, once for the process. Throws UnsupportedError.
void loadBulletLibrary();

/// Throws the last error that Bullet has reported on this thread, if there is one, and drops it.
void requireNoBulletError();
void dropBulletError();

/// The library's grid with kernels of its own, and with two settings that are private in the
/// library. Only one of its calls, of all instances, may run at a time.
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

  /// Cells of that edge, which hold any number of bodies.
  void setCellSize(float size);

 private:
  void putKernelsInPlace() const;

  std::array<cl_kernel, 6> kernels_{};
};

}  // namespace broadmark::opencl
