// Memory shared by processes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/files.h"

namespace broadmark {

/// Memory that two processes share by its descriptor. It is read and written by system calls and
/// never mapped, so that it does not count as the memory of either.
class SharedMemory {
 public:
  explicit SharedMemory(FileDescriptor file) : file_(std::move(file)) {}
  /// New and empty.
  SharedMemory();

  [[nodiscard]] int descriptor() const { return file_.get(); }

  /// Releases the memory.
  void clear() const;

  /// Writes `items` at a byte offset. Returns the offset behind them. Throws std::runtime_error
  /// when no memory is left.
  template <class Item>
  std::uint64_t write(std::span<const Item> items, std::uint64_t offset = 0) const {
    writeBytes(std::as_bytes(items), offset);
    return offset + items.size_bytes();
  }
  /// Reads `count` items from a byte offset into `items`, which keeps its capacity.
  template <class Item, class Allocator>
  void read(std::vector<Item, Allocator>& items, std::size_t count,
            std::uint64_t offset = 0) const {
    requireAvailable(offset, count, sizeof(Item));
    items.resize(count);
    readBytes(std::as_writable_bytes(std::span(items)), offset);
  }

 private:
  void writeBytes(std::span<const std::byte> bytes, std::uint64_t offset) const;
  void readBytes(std::span<std::byte> bytes, std::uint64_t offset) const;
  /// Throws HostError if the range exceeds the memory.
  void requireAvailable(std::uint64_t offset, std::uint64_t count, std::size_t item_bytes) const;

  FileDescriptor file_;
};

}  // namespace broadmark
