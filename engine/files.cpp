// Files on POSIX: every failure becomes one line that names the path and the system's reason.

#include "broadmark/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "broadmark/error.h"

namespace broadmark {
namespace {

InputError failure(const std::filesystem::path& path, std::string_view what) {
  return InputError(fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno)));
}

/// The target of a symbolic link: that is written, and the link stays.
std::filesystem::path throughLinks(std::filesystem::path path) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(path, failed)) return path;
  auto target = std::filesystem::canonical(path, failed);
  return failed ? path : target;
}

/// Whether `path` still names the open file.
bool hasName(const FileDescriptor& file, const std::filesystem::path& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(file.get(), &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

FileDescriptor unnamedFile() {
  const std::filesystem::path directory = std::filesystem::temp_directory_path();
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
  // A FIFO without a writer would block; on regular files O_NONBLOCK means nothing.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat status {};
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

void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw failure(path, "cannot write");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(throughLinks(std::move(path))), partial_(path_.string() + ".part") {
  std::error_code ignored;
  const auto status = std::filesystem::status(path_, ignored);
  // Renaming over a device (/dev/null) would replace it.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw InputError(fmt::format("{}: cannot write: not a regular file", path_.string()));
  }
  do {
    // What a killed writer left is taken over; it is cut only after the lock is held.
    file_ = FileDescriptor(::open(partial_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    if (file_.get() < 0) throw failure(path_, "cannot write");
    if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) {
      throw InputError(
          fmt::format("{}: cannot write: another process is writing it", path_.string()));
    }
    // Between open and lock its writer may have finished: then we hold the finished file.
  } while (!hasName(file_, partial_));
  if (::ftruncate(file_.get(), 0) != 0) throw failure(path_, "cannot write");
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(partial_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  writeAll(file_.get(), bytes, path_);
  written_ += bytes.size();
  // The disc works while the next bytes are made, instead of keeping commit() waiting at the end.
  constexpr std::uint64_t kPortion = 1 << 23;
  if (written_ - handed_over_ < kPortion) return;
  ::sync_file_range(file_.get(), static_cast<off64_t>(handed_over_),
                    static_cast<off64_t>(written_ - handed_over_), SYNC_FILE_RANGE_WRITE);
  handed_over_ = written_;
}

void AtomicFile::commit() {
  if (::fsync(file_.get()) != 0 || ::rename(partial_.c_str(), path_.c_str()) != 0) {
    throw failure(path_, "cannot write");
  }
  committed_ = true;
}

void writeTextFile(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace broadmark
