// Files on POSIX: every failure becomes one line that names the path and the system's reason.

#include "broadmark/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>

#include "broadmark/error.h"

namespace broadmark {
namespace {

InputError failure(const std::filesystem::path& path, std::string_view what) {
  return InputError(fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno)));
}

/// Repeats a system call that a signal interrupted; returns its result.
template <class Call>
auto uninterrupted(Call&& call) {
  while (true) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

FileDescriptor opened(const std::filesystem::path& path, int flags) {
  constexpr mode_t kMode = 0666;
  return FileDescriptor(
      uninterrupted([&] { return ::open(path.c_str(), flags | O_CLOEXEC, kMode); }));
}

/// Returns the target of a symbolic link: the target is written, and the link remains.
std::filesystem::path resolved(std::filesystem::path path) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(path, failed)) return path;
  auto target = std::filesystem::canonical(path, failed);
  return failed ? path : target;
}

/// Whether `path` still names the open file.
bool hasName(const FileDescriptor& file, const std::filesystem::path& path) {
  struct stat open{};
  struct stat named{};
  return ::fstat(file.get(), &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

/// Returns false if another process has the lock, and true if the file system supports no locks.
bool tryLock(const FileDescriptor& file) {
  return uninterrupted([&] { return ::flock(file.get(), LOCK_EX | LOCK_NB); }) == 0 ||
         errno != EWOULDBLOCK;
}

/// Opens and locks `path`, the partial file of `named`.
FileDescriptor openLocked(const std::filesystem::path& path, const std::filesystem::path& named,
                          std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (true) {
    FileDescriptor file = opened(path, O_WRONLY | O_CREAT);
    if (file.get() < 0) throw failure(named, "cannot write");
    if (!tryLock(file)) {
      if (std::chrono::steady_clock::now() >= end) {
        throw InputError(
            fmt::format("{}: cannot write: another process is writing it", named.string()));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else if (hasName(file, path)) {
      return file;
    }
    // Another writer renamed or removed the file between open and lock.
  }
}

/// Truncates the file and seeks to its new end. Returns whether both succeeded.
bool cutFile(const FileDescriptor& file, std::uint64_t size) {
  const auto end = static_cast<off_t>(size);
  return uninterrupted([&] { return ::ftruncate(file.get(), end); }) == 0 &&
         ::lseek(file.get(), end, SEEK_SET) == end;
}

/// Waits until all data are on the disk.
void syncFile(const FileDescriptor& file, const std::filesystem::path& path) {
  if (uninterrupted([&] { return ::fsync(file.get()); }) != 0) throw failure(path, "cannot write");
}

/// Renaming over a device (/dev/null) would replace it.
void requireRegular(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw InputError(fmt::format("{}: cannot write: not a regular file", path.string()));
  }
}

// The only folder that this process may write to, if set. Background tasks read it, too.
std::mutex sandbox_mutex;
std::optional<std::filesystem::path> sandbox_folder;  ///< guarded by sandbox_mutex

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

FileDescriptor unnamedFile() {
  std::error_code failed;
  const std::filesystem::path directory = std::filesystem::temp_directory_path(failed);
  if (failed) {
    const char* stated = std::getenv("TMPDIR");
    throw InputError(fmt::format("TMPDIR: {}: not a directory for temporary files: {}",
                                 stated == nullptr ? "/tmp" : stated, failed.message()));
  }
  std::string name = (directory / "broadmark-XXXXXX").string();
  FileDescriptor file(::mkstemp(name.data()));
  if (file.get() < 0) {
    throw InputError(
        fmt::format("{}: cannot write a temporary recording: {} (TMPDIR names the "
                    "directory)",
                    directory.string(), std::strerror(errno)));
  }
  ::unlink(name.c_str());
  return file;
}

FileDescriptor openForReading(const std::filesystem::path& path) {
  // A FIFO without a writer would block; on regular files O_NONBLOCK has no effect.
  FileDescriptor file = opened(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  struct stat status{};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) throw failure(path, "cannot read");
  if (!S_ISREG(status.st_mode)) {
    throw InputError(fmt::format("{}: cannot read: not a regular file", path.string()));
  }
  return file;
}

std::string readTextFile(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  const FileDescriptor file = openForReading(path);
  std::string text;
  while (true) {
    constexpr std::size_t kChunk = 1 << 16;
    const std::size_t size = text.size();
    text.resize(size + kChunk);
    const ssize_t got = ::read(file.get(), text.data() + size, kChunk);
    if (got < 0 && errno != EINTR) throw failure(path, "cannot read");
    text.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) return text;
    if (text.size() > limit_bytes) {
      throw InputError(fmt::format("{}: too large: a text file of at most {} bytes is expected",
                                   path.string(), limit_bytes));
    }
  }
}

std::size_t readAll(int fd, std::span<std::byte> bytes, std::uint64_t offset) {
  std::size_t done = 0;
  errno = 0;
  while (done < bytes.size()) {
    const std::span<std::byte> rest = bytes.subspan(done);
    const ssize_t got = uninterrupted(
        [&] { return ::pread(fd, rest.data(), rest.size(), static_cast<off_t>(offset + done)); });
    if (got < 0) return done;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  errno = 0;  // end of file or a short read is no error
  return done;
}

void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw failure(path, "cannot write");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

AtomicFile::AtomicFile(std::filesystem::path path, std::chrono::milliseconds timeout)
    : path_(resolved(std::move(path))), partial_(path_.string() + ".part") {
  requireInSandbox(path_);
  requireRegular(path_);
  // May contain a killed writer's data; truncated only under the lock.
  file_ = openLocked(partial_, path_, timeout);
  if (!cutFile(file_, 0)) throw failure(path_, "cannot write");
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(partial_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  writeAll(file_.get(), bytes, path_);
  written_ += bytes.size();
  // Starts writeback early, so that commit() does not wait for all data at the end.
  constexpr std::uint64_t kChunk = 1 << 23;
  if (written_ - flushed_ < kChunk) return;
  ::sync_file_range(file_.get(), static_cast<off64_t>(flushed_),
                    static_cast<off64_t>(written_ - flushed_), SYNC_FILE_RANGE_WRITE);
  flushed_ = written_;
}

void AtomicFile::commit() {
  // Contents before the name: a power failure must not leave the name without contents.
  syncFile(file_, path_);
  if (::rename(partial_.c_str(), path_.c_str()) != 0) throw failure(path_, "cannot write");
  committed_ = true;
  syncName(path_);
}

FileDescriptor AtomicFile::commitAndRelease() {
  commit();
  return std::move(file_);
}

AppendedFile::AppendedFile(std::filesystem::path path)
    : path_(resolved(std::move(path))), created_(!std::filesystem::exists(path_)), on_disk_(true) {
  requireInSandbox(path_);
  requireRegular(path_);
  file_ = openLocked(path_, path_, {});
}

AppendedFile::AppendedFile(FileDescriptor file, std::filesystem::path path)
    : path_(std::move(path)), file_(std::move(file)), started_(true) {}

AppendedFile::~AppendedFile() {
  if (created_ && !started_) ::unlink(path_.c_str());
}

void AppendedFile::append(std::string_view text) {
  if (!started_) {
    AtomicFile first(path_);
    first.write(text);
    file_ = first.commitAndRelease();
    started_ = true;
    size_ = text.size();
    return;
  }
  try {
    writeAll(file_.get(), std::as_bytes(std::span(text)), path_);
    if (on_disk_) syncFile(file_, path_);
  } catch (const InputError&) {
    if (on_disk_) cutFile(file_, size_);
    throw;
  }
  size_ += text.size();
}

void syncName(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  const FileDescriptor names =
      opened(folder.empty() ? std::filesystem::path(".") : folder, O_RDONLY | O_DIRECTORY);
  // An unreadable folder cannot be synced, and some file systems cannot sync folders.
  if (names.get() < 0) return;
  if (uninterrupted([&] { return ::fsync(names.get()); }) != 0 && errno != EINVAL) {
    throw failure(path, "cannot write");
  }
}

void writeTextFile(const std::filesystem::path& path, std::string_view text) {
  // Longer than another process takes to write a text.
  constexpr std::chrono::seconds kTimeout{5};
  AtomicFile file(path, kTimeout);
  file.write(text);
  file.commit();
}

void requireBelow(const std::filesystem::path& folder, const std::filesystem::path& path) {
  const auto relative = std::filesystem::weakly_canonical(std::filesystem::absolute(path))
                            .lexically_relative(std::filesystem::weakly_canonical(folder));
  const bool below = !relative.empty() && std::ranges::none_of(relative, [](const auto& part) {
    return part.string().starts_with('.');  // "..": outside; ".": itself; other names: hidden
  });
  if (below) return;
  throw InputError(
      fmt::format("{}: cannot write: only files below {} that are not hidden may be written here",
                  path.string(), folder.string()));
}

WriteSandbox::WriteSandbox(const std::filesystem::path& folder) {
  const std::lock_guard guard(sandbox_mutex);
  sandbox_folder = folder;
}

WriteSandbox::~WriteSandbox() {
  const std::lock_guard guard(sandbox_mutex);
  sandbox_folder.reset();
}

bool isSandboxed() {
  const std::lock_guard guard(sandbox_mutex);
  return sandbox_folder.has_value();
}

void requireInSandbox(const std::filesystem::path& path) {
  const std::lock_guard guard(sandbox_mutex);
  if (sandbox_folder) requireBelow(*sandbox_folder, path);
}

}  // namespace broadmark
