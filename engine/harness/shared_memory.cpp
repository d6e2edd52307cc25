#include "broadmark/harness/shared_memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

#include "broadmark/error.h"

namespace broadmark {
SharedMemory::SharedMemory() : file_(::memfd_create("broadmark", MFD_CLOEXEC)) {
  if (file_.get() < 0) throw systemError("no shared memory");
}

void SharedMemory::clear() const {
  if (::ftruncate(file_.get(), 0) != 0) throw systemError("cannot clear shared memory");
}

void SharedMemory::writeBytes(std::span<const std::byte> bytes, std::uint64_t offset) const {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw systemError("no shared memory left");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void SharedMemory::readBytes(std::span<std::byte> bytes, std::uint64_t offset) const {
  if (readAll(file_.get(), bytes, offset) < bytes.size()) {
    throw systemError("cannot read shared memory");
  }
}

void SharedMemory::requireAvailable(std::uint64_t offset, std::uint64_t count,
                                    std::size_t item_bytes) const {
  struct stat status{};
  if (::fstat(file_.get(), &status) != 0) throw systemError("cannot read shared memory");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (offset > size || count > (size - offset) / item_bytes) {
    throw HostError(fmt::format("{} items are claimed, {} bytes are shared", count, size));
  }
}

}  // namespace broadmark
