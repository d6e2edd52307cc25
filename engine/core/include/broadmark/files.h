// Files: owned descriptors, whole reads, writes that never leave a half-written file, and
// the write sandbox.
//
// Example:
//
//   AtomicFile file("results.csv");
//   file.write("case,seconds\n");
//   file.commit();  // until then, results.csv is absent or as before
//   const std::string text = readTextFile("results.csv");
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

/// Owns an open file descriptor, and closes it. Movable, not copyable.
class FileDescriptor {
 public:
  /// -1: none.
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor();
  /// The descriptor, still owned by this object; negative: none.
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// Opens a regular file for reading; links are followed. Throws InputError if it cannot be read, or
/// is a folder, pipe or device.
FileDescriptor openForReading(const std::filesystem::path& path);
/// Opens an unnamed file in the temporary directory, for reading and writing. It is deleted with
/// its descriptor. Throws InputError with the directory, which TMPDIR names.
FileDescriptor unnamedFile();
/// Reads a whole regular file of at most `limit_bytes`, by default 1 GiB. Throws InputError with
/// the path if it is larger or cannot be read.
std::string readTextFile(const std::filesystem::path& path,
                         std::uint64_t limit_bytes = std::uint64_t{1} << 30);

/// A file that appears under its name only when complete: written to `NAME.part`, synced, then
/// renamed; after commit() it survives a power failure. A lock excludes other writers of the same
/// name. Of a symbolic link, the target is written. Throws InputError with the path on every
/// failure (no such directory, no permission, disk full, a path outside the sandbox, or one that
/// names a folder or device).
class AtomicFile {
 public:
  /// Creates the partial file. `timeout`: maximum wait for another writer of the same name, by
  /// default none.
  explicit AtomicFile(std::filesystem::path path, std::chrono::milliseconds timeout = {});
  /// Removes the partial file unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends to the partial file.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  /// Waits until the contents are on the disk, then renames the partial file. Once, as the last
  /// call.
  void commit();
  /// Commits, and returns the open file, positioned at its end and still locked.
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
  /// Opens and locks the file, creating it if necessary; until the first append() it is unchanged.
  /// Throws InputError, also if another process is writing it, or for a path outside the sandbox.
  explicit AppendedFile(std::filesystem::path path);
  /// Appends to an open descriptor, such as a pipe, without locking, truncating or syncing it.
  /// `path` serves for messages alone.
  AppendedFile(FileDescriptor file, std::filesystem::path path);
  /// Removes a created file if nothing was appended.
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  /// Throws InputError if a part cannot be written. A file then keeps its earlier parts; a pipe may
  /// have got a piece of this one.
  void append(std::string_view text);

 private:
  std::filesystem::path path_;
  bool created_ = false;  ///< the file did not exist before
  FileDescriptor file_;
  bool started_ = false;  ///< something was appended
  bool on_disk_ = false;  ///< not a pipe or the like
  std::uint64_t size_ = 0;
};

/// Syncs the directory entry of a file or folder, so that a new name survives a power failure. Does
/// nothing if its directory cannot be opened, or the file system does not sync directories. Throws
/// InputError for any other failure.
void syncName(const std::filesystem::path& path);

/// Writes a whole text file, as an AtomicFile; waits up to 5 s for another writer of the file.
/// Throws InputError.
void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Reads `bytes` at a byte offset, without moving the descriptor's position. Returns the number
/// read: fewer at the end of the file, where errno is 0, or, with errno set, after a failure.
std::size_t readAll(int fd, std::span<std::byte> bytes, std::uint64_t offset);

/// Writes all bytes to a descriptor. Throws InputError, which names `path`, after a failure; some
/// bytes may have been written.
void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path);

/// Restricts the output paths in an untrusted file: throws InputError unless `path` lies below
/// `folder`, also after resolving links, and no part of it below `folder` is hidden, as `.bashrc`
/// is. Neither file nor folder need exist.
void requireBelow(const std::filesystem::path& folder, const std::filesystem::path& path);

/// Limits the files that this process writes, by AtomicFile and AppendedFile, to paths that pass
/// requireBelow(), as long as it exists. At most one may exist. It is no barrier to other code.
class WriteSandbox {
 public:
  explicit WriteSandbox(const std::filesystem::path& folder);
  ~WriteSandbox();
  WriteSandbox(const WriteSandbox&) = delete;
  WriteSandbox& operator=(const WriteSandbox&) = delete;
};

/// True while a WriteSandbox exists: an untrusted file controls this process. From any thread.
bool isSandboxed();

/// Throws InputError for a path outside the sandbox, if there is one. AtomicFile and AppendedFile
/// call it. From any thread.
void requireInSandbox(const std::filesystem::path& path);

}  // namespace broadmark
