#include "opencl/device_sorter.h"

#include "opencl_kernels.h"

namespace broadmark::opencl {
namespace {

// As in sort.cl.
constexpr int kSerialDigitBits = 11;  ///< at most
constexpr int kGroupDigitBits = 4;
constexpr std::size_t kGroupSize = 128;
constexpr std::size_t kGroupBlock = kGroupSize * 4;
/// Blocks per thread of a CPU: more than one balances other load.
constexpr std::size_t kBlocksPerUnit = 4;

}  // namespace

DeviceSorter::DeviceSorter(DeviceContext& context, bool by_groups)
    : context_(context), by_groups_(by_groups) {
  const cl::Program program = context.build(std::string(opencl_kernels::sort_cl()));
  count_ = cl::Kernel(program, by_groups ? "group_count" : "serial_count");
  places_ = cl::Kernel(program, by_groups ? "group_places" : "serial_places");
  scatter_ = cl::Kernel(program, by_groups ? "group_scatter" : "serial_scatter");
}

void DeviceSorter::resize(std::size_t count) {
  size_ = count;
  if (count <= capacity_ && capacity_ > 0) return;
  capacity_ = count;
  for (int side = 0; side < 2; ++side) {
    keys_[side] = context_.buffer(count * sizeof(cl_uint));
    values_[side] = context_.buffer(count * sizeof(cl_uint));
  }
  const std::size_t serial_blocks =
      kBlocksPerUnit * context_.device().getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  const std::size_t counts =
      by_groups_ ? (count / kGroupBlock + 1) << kGroupDigitBits : serial_blocks << kSerialDigitBits;
  counts_ = context_.buffer(counts * sizeof(cl_uint));
}

void DeviceSorter::sort(int bits) {
  // The minimum number of passes, with digits of about the same size.
  const int most = by_groups_ ? kGroupDigitBits : kSerialDigitBits;
  const int passes = (bits + most - 1) / most;
  for (int done = 0; done < passes; ++done) {
    const int digit_bits = by_groups_ ? most : (bits + passes - 1) / passes;
    pass(done * digit_bits, digit_bits);
  }
}

void DeviceSorter::pass(int shift_bits, int digit_bits) {
  const auto shift = static_cast<cl_uint>(shift_bits);
  const auto n = static_cast<cl_uint>(size_);
  const int to = 1 - current_;
  if (by_groups_) {
    const std::size_t groups = (size_ + kGroupBlock - 1) / kGroupBlock;
    const auto counts = static_cast<cl_uint>(groups << kGroupDigitBits);
    context_.launch(count_, groups * kGroupSize, kGroupSize, keys(), n, shift, counts_);
    context_.launch(places_, kGroupSize, kGroupSize, counts_, counts);
    context_.launch(scatter_, groups * kGroupSize, kGroupSize, keys(), values(), n, shift, counts_,
                    keys_[to], values_[to]);
  } else {
    const std::size_t blocks =
        kBlocksPerUnit * context_.device().getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    const auto block_size = static_cast<cl_uint>((size_ + blocks - 1) / blocks);
    const cl_uint digits = cl_uint{1} << digit_bits;
    const auto counts = static_cast<cl_uint>(blocks << digit_bits);
    context_.launch(count_, blocks, 1, keys(), n, shift, digits, block_size, counts_);
    context_.launch(places_, 1, 1, counts_, counts);
    context_.launch(scatter_, blocks, 1, keys(), values(), n, shift, digits, block_size, counts_,
                    keys_[to], values_[to]);
  }
  current_ = to;
}

}  // namespace broadmark::opencl
