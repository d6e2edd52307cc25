#include "support/contents.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <span>

#include "broadmark/error.h"
#include "support/interrupt.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunkBytes = 1 << 16;

InputError unreadable(const fs::path& path, std::string_view reason) {
  return InputError(fmt::format("{}: cannot read: {}", path.string(), reason));
}

/// Repeats a system call that a signal interrupted, unless the user did.
template <class Call>
auto patiently(const Call& call) {
  while (true) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
    if (InterruptGuard::requested()) throw Interrupted();
  }
}

bool isPipe(const fs::path& path) {
  struct stat status{};
  return ::stat(path.c_str(), &status) == 0 &&
         (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode));
}

/// Copies a pipe to an unnamed file. Waits for a writer.
FileDescriptor copyOf(const fs::path& pipe_path) {
  // A socket as standard input has no name to open.
  const FileDescriptor pipe(pipe_path == kStandardInput ? ::dup(STDIN_FILENO) : patiently([&] {
    return ::open(pipe_path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  }));
  if (pipe.get() < 0) throw unreadable(pipe_path, std::strerror(errno));
  FileDescriptor copy = unnamedFile();
  std::array<std::byte, kChunkBytes> chunk;
  while (true) {
    const ssize_t got = patiently([&] { return ::read(pipe.get(), chunk.data(), chunk.size()); });
    if (got < 0) throw unreadable(pipe_path, std::strerror(errno));
    if (got == 0) return copy;
    writeAll(copy.get(), std::span(chunk).first(static_cast<std::size_t>(got)),
             "the contents of a pipe");
  }
}

/// Opens the contents of a pipe, with an offset of its own.
FileDescriptor openPipe(const fs::path& path) {
  static std::mutex mutex;
  static std::map<fs::path, FileDescriptor> copies;
  const std::lock_guard guard(mutex);
  auto copy = copies.find(path);
  if (copy == copies.end()) copy = copies.emplace(path, copyOf(path)).first;
  return openForReading(fmt::format("/proc/self/fd/{}", copy->second.get()));
}

FileDescriptor openRaw(const fs::path& path) {
  return isPipe(path) ? openPipe(path) : openForReading(path);
}

bool isGzip(const FileDescriptor& file) {
  std::array<std::byte, 3> start{};
  const std::array<std::byte, 3> expected = {std::byte{0x1f}, std::byte{0x8b}, std::byte{8}};
  return readAll(file.get(), start, 0) == start.size() && start == expected;
}

/// Reads a gzip file from its start.
class GzipReader {
 public:
  GzipReader(const FileDescriptor& file, const fs::path& path)
      : path_(path), file_(::gzdopen(::dup(file.get()), "rb")) {
    if (file_ == nullptr) throw unreadable(path_, "out of memory");
  }

  /// Fills `bytes`, or less at the end of the file. Returns their number.
  std::size_t read(std::span<char> bytes) {
    const int got = ::gzread(file_.get(), bytes.data(), static_cast<unsigned>(bytes.size()));
    int error = Z_OK;
    const char* text = ::gzerror(file_.get(), &error);
    // A file that ends early is no error to gzread().
    if (got < 0 || error != Z_OK) {
      const bool cut = error == Z_BUF_ERROR;
      throw unreadable(path_, cut ? "the gzip file ends too early" : std::string("gzip: ") + text);
    }
    return static_cast<std::size_t>(got);
  }

 private:
  struct Close {
    void operator()(gzFile_s* file) const { ::gzclose_r(file); }
  };
  fs::path path_;
  std::unique_ptr<gzFile_s, Close> file_;
};

}  // namespace

FileDescriptor openContents(const fs::path& path) {
  FileDescriptor file = openRaw(path);
  if (!isGzip(file)) return file;
  GzipReader reader(file, path);
  FileDescriptor contents = unnamedFile();
  std::array<char, kChunkBytes> chunk;
  while (const std::size_t got = reader.read(chunk)) {
    writeAll(contents.get(), std::as_bytes(std::span(chunk).first(got)), "an uncompressed file");
  }
  return contents;
}

FileStart startOf(const fs::path& path) {
  const FileDescriptor file = openRaw(path);
  FileStart start{.path = path, .text = std::string(kChunkBytes, '\0')};
  std::size_t got = 0;
  start.size = fs::file_size(fmt::format("/proc/self/fd/{}", file.get()));
  if (isGzip(file)) {
    got = GzipReader(file, path).read(start.text);
    // The file ends with its uncompressed size, if that is below 4 GiB and it has one part.
    std::array<std::uint8_t, 4> size{};
    readAll(file.get(), std::as_writable_bytes(std::span(size)), start.size - size.size());
    start.size = size[0] | size[1] << 8 | size[2] << 16 | std::uint64_t{size[3]} << 24;
  } else {
    got = readAll(file.get(), std::as_writable_bytes(std::span(start.text)), 0);
  }
  start.whole = got < start.text.size();
  start.text.resize(got);
  if (start.text.starts_with(kByteOrderMark)) start.text.erase(0, kByteOrderMark.size());
  return start;
}

}  // namespace broadmark::imports
