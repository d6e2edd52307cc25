// Stable radix sort on a device, of 32-bit keys with 32-bit values. O(n) per digit.
#pragma once

#include "opencl/device_context.h"

namespace broadmark::opencl {

/// Retains its buffers.
class DeviceSorter {
 public:
  /// `by_groups`: work groups share blocks, for GPUs; else a work item processes a whole block, for
  /// CPUs. Both are correct on either.
  DeviceSorter(DeviceContext&, bool by_groups);

  /// Room for `count` pairs of key and value; allocates only to grow.
  void resize(std::size_t count);

  /// To be filled before sort(), which exchanges the buffers.
  [[nodiscard]] const cl::Buffer& keys() const { return keys_[current_]; }
  [[nodiscard]] const cl::Buffer& values() const { return values_[current_]; }

  /// Sorts by the lowest `bits` bits of the keys. Asynchronous; the queue is in order.
  void sort(int bits);

 private:
  void pass(int shift_bits, int digit_bits);

  DeviceContext& context_;
  bool by_groups_;
  cl::Kernel count_;
  cl::Kernel places_;
  cl::Kernel scatter_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
  int current_ = 0;
  cl::Buffer keys_[2];
  cl::Buffer values_[2];
  cl::Buffer counts_;
};

}  // namespace broadmark::opencl
