// Fault injection: a library that tests preload into the program (LD_PRELOAD). It intercepts the
// file system calls, counts those on files below one folder, and injects a fault into one of them.
// Environment variables configure it:
//
//   BROADMARK_FAULT_FOLDER   the folder; calls on other files are neither counted nor changed
//   BROADMARK_FAULT_LOG      a log file elsewhere, a line for each call: number, name, path
//   BROADMARK_FAULT          FAULT NUMBER, such as "kill 7"; each process counts for itself, from 1
//
//   kill      the process ends before this call, as with kill -9
//   EIO       this call fails: the disc is broken
//   ENOSPC    from this call on, all calls that need disc space fail: the disc is full
//   EINTR     from this call on, a signal interrupts every other call before it does anything
//   backwards the real-time clock goes back by an hour with every reading
//   short     from this call on, all calls read or write only half of the requested bytes

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>

namespace {

using Text = std::string_view;

/// The libc function that this library replaces.
template <class Function>
Function original(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

Text variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? Text() : value;
}

struct FaultOptions {
  std::string folder = std::string(variable("BROADMARK_FAULT_FOLDER")) + "/";
  std::string log = std::string(variable("BROADMARK_FAULT_LOG"));
  std::string fault;
  long number = LONG_MAX;

  FaultOptions() {
    const Text text = variable("BROADMARK_FAULT");
    const std::size_t space = text.find(' ');
    if (space == Text::npos) return;
    fault = text.substr(0, space);
    number = std::atol(text.data() + space + 1);
  }
};

const FaultOptions& options() {
  static const FaultOptions parsed;
  return parsed;
}

/// A type of call, with the faults that it can have.
struct CallType {
  const char* name;
  bool interruptible = false;  ///< may fail with EINTR
  bool needs_space = false;    ///< may fail with ENOSPC
  bool divisible = false;      ///< may transfer fewer bytes than requested
};
constexpr CallType kRead{.name = "read", .interruptible = true, .divisible = true};
constexpr CallType kWrite{
    .name = "write", .interruptible = true, .needs_space = true, .divisible = true};
constexpr CallType kOpen{.name = "open", .interruptible = true};
constexpr CallType kCreate{.name = "create", .interruptible = true, .needs_space = true};
constexpr CallType kSync{.name = "fsync", .interruptible = true, .needs_space = true};
constexpr CallType kTruncate{.name = "ftruncate", .interruptible = true};
constexpr CallType kRename{.name = "rename", .needs_space = true};
constexpr CallType kUnlink{.name = "unlink"};
constexpr CallType kMakeFolder{.name = "mkdir", .needs_space = true};

std::string pathOf(const char* path) {
  if (path[0] == '/') return path;
  char cwd[PATH_MAX];
  return ::getcwd(cwd, sizeof cwd) == nullptr ? path : std::string(cwd) + "/" + path;
}

std::string pathOf(int descriptor) {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  char path[PATH_MAX];
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path);
  return size < 0 ? std::string() : std::string(path, static_cast<std::size_t>(size));
}

void logCall(long number, const CallType& type, const std::string& path) {
  if (options().log.empty()) return;
  static const auto open = original<int (*)(const char*, int, ...)>("open");
  static const auto write = original<ssize_t (*)(int, const void*, std::size_t)>("write");
  static const int log =
      open(options().log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const std::string line = std::to_string(number) + " " + type.name + " " + path + "\n";
  if (write(log, line.data(), line.size()) < 0) std::abort();
}

enum class Outcome { normal, fails, truncated };

/// The outcome of a call; sets errno if it fails.
Outcome outcomeOf(const CallType& type, const std::string& path) {
  static std::atomic<long> calls = 0;
  const bool below = path == Text(options().folder).substr(0, options().folder.size() - 1) ||
                     path.starts_with(options().folder);
  if (options().folder.size() == 1 || !below) return Outcome::normal;
  const long number = ++calls;
  logCall(number, type, path);
  const std::string& fault = options().fault;
  const auto failing = [](int error) {
    errno = error;
    return Outcome::fails;
  };
  const long since = number - options().number;
  if (fault == "kill" && since == 0) ::kill(::getpid(), SIGKILL);
  if (fault == "EIO" && since == 0) return failing(EIO);
  if (since < 0) return Outcome::normal;
  if (fault == "ENOSPC" && type.needs_space) return failing(ENOSPC);
  if (fault == "EINTR" && since % 2 == 0 && type.interruptible) return failing(EINTR);
  if (fault == "short" && type.divisible) return Outcome::truncated;
  return Outcome::normal;
}

/// Makes a call that cannot be done in part.
template <class Call>
auto whole(const CallType& type, const std::string& path, Call&& call) -> decltype(call()) {
  return outcomeOf(type, path) == Outcome::fails ? -1 : call();
}

/// Makes a call that transfers up to `bytes`.
template <class Call>
ssize_t divided(const CallType& type, int descriptor, std::size_t bytes, Call&& call) {
  switch (outcomeOf(type, pathOf(descriptor))) {
    case Outcome::fails:
      return -1;
    case Outcome::truncated:
      return call(bytes > 1 ? bytes / 2 : bytes);
    case Outcome::normal:
      break;
  }
  return call(bytes);
}

const CallType& openType(int flags) {
  const bool reads = (flags & O_ACCMODE) == O_RDONLY && (flags & O_CREAT) == 0;
  return reads ? kOpen : kCreate;
}

int openAs(const char* name, const char* path, int flags, mode_t mode) {
  return whole(openType(flags), pathOf(path),
               [&] { return original<int (*)(const char*, int, ...)>(name)(path, flags, mode); });
}

mode_t modeIn(int flags, std::va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) == 0 ? 0 : va_arg(more, mode_t);
}

}  // namespace

// The replacements; the functions with 64 in their name are the same on 64-bit systems.
#define BROADMARK_OPEN(name)                   \
  int name(const char* path, int flags, ...) { \
    std::va_list more;                         \
    va_start(more, flags);                     \
    const mode_t mode = modeIn(flags, more);   \
    va_end(more);                              \
    return openAs(#name, path, flags, mode);   \
  }
#define BROADMARK_TRANSFER(name, kind, Bytes)                                                 \
  ssize_t name(int descriptor, Bytes* bytes, std::size_t size) {                              \
    return divided(kind, descriptor, size, [&](std::size_t part) {                            \
      return original<ssize_t (*)(int, Bytes*, std::size_t)>(#name)(descriptor, bytes, part); \
    });                                                                                       \
  }
#define BROADMARK_TRANSFER_AT(name, kind, Bytes)                                              \
  ssize_t name(int descriptor, Bytes* bytes, std::size_t size, off_t offset) {                \
    return divided(kind, descriptor, size, [&](std::size_t part) {                            \
      return original<ssize_t (*)(int, Bytes*, std::size_t, off_t)>(#name)(descriptor, bytes, \
                                                                           part, offset);     \
    });                                                                                       \
  }
#define BROADMARK_ON_FILE(name, kind)                                        \
  int name(int descriptor) {                                                 \
    return whole(kind, pathOf(descriptor),                                   \
                 [&] { return original<int (*)(int)>(#name)(descriptor); }); \
  }

#pragma GCC visibility push(default)
extern "C" {

BROADMARK_OPEN(open)
BROADMARK_OPEN(open64)
BROADMARK_TRANSFER(read, kRead, void)
BROADMARK_TRANSFER(write, kWrite, const void)
BROADMARK_TRANSFER_AT(pread, kRead, void)
BROADMARK_TRANSFER_AT(pread64, kRead, void)
BROADMARK_TRANSFER_AT(pwrite, kWrite, const void)
BROADMARK_TRANSFER_AT(pwrite64, kWrite, const void)
BROADMARK_ON_FILE(fsync, kSync)
BROADMARK_ON_FILE(fdatasync, kSync)

int ftruncate(int descriptor, off_t size) noexcept {
  return whole(kTruncate, pathOf(descriptor),
               [&] { return original<int (*)(int, off_t)>("ftruncate")(descriptor, size); });
}

/// Counted by its destination.
int rename(const char* from, const char* to) noexcept {
  return whole(kRename, pathOf(to),
               [&] { return original<int (*)(const char*, const char*)>("rename")(from, to); });
}

int unlink(const char* path) noexcept {
  return whole(kUnlink, pathOf(path),
               [&] { return original<int (*)(const char*)>("unlink")(path); });
}

int clock_gettime(clockid_t clock, struct timespec* time) noexcept {
  static const auto read = original<int (*)(clockid_t, struct timespec*)>("clock_gettime");
  static std::atomic<long> readings = 0;
  const int result = read(clock, time);
  if (clock == CLOCK_REALTIME && options().fault == "backwards") time->tv_sec -= 3600 * ++readings;
  return result;
}

int mkdir(const char* path, mode_t mode) noexcept {
  return whole(kMakeFolder, pathOf(path),
               [&] { return original<int (*)(const char*, mode_t)>("mkdir")(path, mode); });
}

}  // extern "C"
#pragma GCC visibility pop
