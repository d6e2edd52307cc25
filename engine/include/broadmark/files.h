// Files: owned descriptors, whole reads, and writes that never leave a half-written file behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace broadmark {

/// Owns an open file descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor();
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// Opens a regular file for reading. Throws InputError.
FileDescriptor openForReading(const std::filesystem::path& path);
/// An unnamed file in the temporary directory, to write and read; it vanishes with its descriptor.
/// Throws InputError.
FileDescriptor unnamedFile();
/// Reads a whole text file of at most `limit_bytes`. Throws InputError.
std::string readTextFile(const std::filesystem::path& path,
                         std::uint64_t limit_bytes = std::uint64_t{1} << 30);

/// A file that appears under its name only when it is whole: written to `NAME.part` beside it, then
/// renamed. Two writers of the same name exclude each other by a lock. Throws InputError naming the
/// path on every failure (no such directory, no permission, disc full).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  /// Removes the partial file unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_;
  FileDescriptor file_;
  std::uint64_t written_ = 0;
  std::uint64_t handed_over_ = 0;  ///< of those bytes, what the system has been asked to store
  bool committed_ = false;
};

/// Writes a whole text file atomically.
void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Writes all bytes to a descriptor; `path` is named in errors.
void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace broadmark
