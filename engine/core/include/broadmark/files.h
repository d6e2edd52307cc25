// Files: owned descriptors, whole reads, writes that never leave a half-written file, and
// the write sandbox.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace broadmark {

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
/// Opens an unnamed file in the temporary directory, for reading and writing. It is deleted with
/// its descriptor. Throws InputError.
FileDescriptor unnamedFile();
/// Reads a whole text file of at most `limit_bytes`. Throws InputError.
std::string readTextFile(const std::filesystem::path& path,
                         std::uint64_t limit_bytes = std::uint64_t{1} << 30);

/// A file that appears under its name only when complete: written to `NAME.part`, synced,
/// then renamed; after commit() it survives a power failure. A lock excludes other writers of the
/// same name. Throws InputError with the path on every failure (no such directory, no permission,
/// disk full).
class AtomicFile {
 public:
  /// `timeout`: maximum wait for another writer of the same name.
  explicit AtomicFile(std::filesystem::path path, std::chrono::milliseconds timeout = {});
  /// Removes the partial file unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  void commit();
  /// Commits, and returns the open file for appending, still locked.
  FileDescriptor commitAndRelease();

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_;
  FileDescriptor file_;
  std::uint64_t written_ = 0;
  std::uint64_t flushed_ = 0;  ///< bytes already submitted for writeback
  bool committed_ = false;
};

/// A file that grows part by part: each part is on disk when append() returns. The first part
/// atomically replaces the previous contents. A lock excludes other writers. Throws InputError with
/// the path.
class AppendedFile {
 public:
  explicit AppendedFile(std::filesystem::path path);
  /// Appends to an open descriptor, such as a pipe, without locking or truncating it.
  AppendedFile(FileDescriptor file, std::filesystem::path path);
  /// Removes a created file if nothing was appended.
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  void append(std::string_view text);

 private:
  std::filesystem::path path_;
  bool created_ = false;  ///< the file did not exist before
  FileDescriptor file_;
  bool started_ = false;  ///< something was appended
  bool on_disk_ = false;  ///< not a pipe or the like
  std::uint64_t size_ = 0;
};

/// Syncs the directory entry of a file or folder. Throws InputError.
void syncName(const std::filesystem::path& path);

/// Writes a whole text file atomically; waits a moment for another writer of the file.
void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Reads `bytes` at a byte offset. Returns the number read: fewer at the end of the file, or, with
/// errno set, after a failure.
std::size_t readAll(int fd, std::span<std::byte> bytes, std::uint64_t offset);

/// Writes all bytes to a descriptor; errors name `path`.
void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path);

/// Restricts the output paths in an untrusted file: throws InputError unless `path` lies
/// below `folder`, also after resolving links, and no part of it below `folder` is hidden, as
/// `.bashrc` is.
void requireBelow(const std::filesystem::path& folder, const std::filesystem::path& path);

/// Limits the writes of this process to paths that pass requireBelow(). At most one may exist.
class WriteSandbox {
 public:
  explicit WriteSandbox(const std::filesystem::path& folder);
  ~WriteSandbox();
  WriteSandbox(const WriteSandbox&) = delete;
  WriteSandbox& operator=(const WriteSandbox&) = delete;
};

/// True while an untrusted file controls this process.
bool isSandboxed();

/// Throws InputError for a path outside the sandbox. AtomicFile and AppendedFile call it.
void requireInSandbox(const std::filesystem::path& path);

}  // namespace broadmark
