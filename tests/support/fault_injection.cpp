// Faults on purpose: a library that tests put under the program (LD_PRELOAD). It stands between the
// program and the system's calls on files, counts those on files below one folder, and does a deed
// at one of them. Environment variables tell it what:
//
//   BROADMARK_FAULT_FOLDER   the folder; calls on other files are neither counted nor disturbed
//   BROADMARK_FAULT_LOG      a file elsewhere that gets a line for each call: number, name, path
//   BROADMARK_FAULT          DEED NUMBER, such as "kill 7"; each process counts for itself, from 1
//
//   kill      the process ends before this call, as with kill -9
//   EIO       this call fails: the disc is broken
//   ENOSPC    from this call on all fail that need room: the disc is full
//   EINTR     from this call on every other one is interrupted by a signal before it did anything
//   short     from this call on all read or write only half of what they are asked to

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
#include <string>
#include <string_view>

namespace {

using Text = std::string_view;

/// The system's own function.
template <class Function>
Function systems(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

Text variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? Text() : value;
}

struct Wish {
  std::string folder = std::string(variable("BROADMARK_FAULT_FOLDER")) + "/";
  std::string log = std::string(variable("BROADMARK_FAULT_LOG"));
  std::string deed;
  long number = LONG_MAX;

  Wish() {
    const Text text = variable("BROADMARK_FAULT");
    const std::size_t space = text.find(' ');
    if (space == Text::npos) return;
    deed = text.substr(0, space);
    number = std::atol(text.data() + space + 1);
  }
};

const Wish& wish() {
  static const Wish all;
  return all;
}

/// What kind of call it is, which tells what can happen to it.
struct Kind {
  const char* name;
  bool interruptible = false;  ///< may fail with EINTR
  bool takes_room = false;     ///< may fail with ENOSPC
  bool divisible = false;      ///< may do a part of what it is asked for
};
constexpr Kind kRead{.name = "read", .interruptible = true, .divisible = true};
constexpr Kind kWrite{
    .name = "write", .interruptible = true, .takes_room = true, .divisible = true};
constexpr Kind kOpen{.name = "open", .interruptible = true};
constexpr Kind kCreate{.name = "create", .interruptible = true, .takes_room = true};
constexpr Kind kSync{.name = "fsync", .interruptible = true, .takes_room = true};
constexpr Kind kTruncate{.name = "ftruncate", .interruptible = true};
constexpr Kind kRename{.name = "rename", .takes_room = true};
constexpr Kind kUnlink{.name = "unlink"};
constexpr Kind kMakeFolder{.name = "mkdir", .takes_room = true};

std::string pathOf(const char* named) {
  if (named[0] == '/') return named;
  char here[PATH_MAX];
  return ::getcwd(here, sizeof here) == nullptr ? named : std::string(here) + "/" + named;
}

std::string pathOf(int descriptor) {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  char path[PATH_MAX];
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path);
  return size < 0 ? std::string() : std::string(path, static_cast<std::size_t>(size));
}

void note(long number, const Kind& kind, const std::string& path) {
  if (wish().log.empty()) return;
  static const auto open = systems<int (*)(const char*, int, ...)>("open");
  static const auto write = systems<ssize_t (*)(int, const void*, std::size_t)>("write");
  static const int log = open(wish().log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const std::string line = std::to_string(number) + " " + kind.name + " " + path + "\n";
  if (write(log, line.data(), line.size()) < 0) std::abort();
}

enum class Fate { usual, fails, is_cut };

/// What happens to a call; errno says why it fails.
Fate fateOf(const Kind& kind, const std::string& path) {
  static std::atomic<long> calls = 0;
  const bool below = path == Text(wish().folder).substr(0, wish().folder.size() - 1) ||
                     path.starts_with(wish().folder);
  if (wish().folder.size() == 1 || !below) return Fate::usual;
  const long number = ++calls;
  note(number, kind, path);
  const std::string& deed = wish().deed;
  const auto failing = [](int error) {
    errno = error;
    return Fate::fails;
  };
  const long since = number - wish().number;
  if (deed == "kill" && since == 0) ::kill(::getpid(), SIGKILL);
  if (deed == "EIO" && since == 0) return failing(EIO);
  if (since < 0) return Fate::usual;
  if (deed == "ENOSPC" && kind.takes_room) return failing(ENOSPC);
  if (deed == "EINTR" && since % 2 == 0 && kind.interruptible) return failing(EINTR);
  if (deed == "short" && kind.divisible) return Fate::is_cut;
  return Fate::usual;
}

/// Makes a call that does no part of its work.
template <class Call>
auto whole(const Kind& kind, const std::string& path, Call&& call) -> decltype(call()) {
  return fateOf(kind, path) == Fate::fails ? -1 : call();
}

/// Makes a call for so many bytes.
template <class Call>
ssize_t divided(const Kind& kind, int descriptor, std::size_t bytes, Call&& call) {
  switch (fateOf(kind, pathOf(descriptor))) {
    case Fate::fails:
      return -1;
    case Fate::is_cut:
      return call(bytes > 1 ? bytes / 2 : bytes);
    case Fate::usual:
      break;
  }
  return call(bytes);
}

const Kind& kindOfOpening(int flags) {
  const bool reads = (flags & O_ACCMODE) == O_RDONLY && (flags & O_CREAT) == 0;
  return reads ? kOpen : kCreate;
}

int openAs(const char* name, const char* path, int flags, mode_t mode) {
  return whole(kindOfOpening(flags), pathOf(path),
               [&] { return systems<int (*)(const char*, int, ...)>(name)(path, flags, mode); });
}

mode_t modeIn(int flags, std::va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) == 0 ? 0 : va_arg(more, mode_t);
}

}  // namespace

// The functions that take their place; those with 64 are the same on 64-bit systems.
#define BROADMARK_OPEN(name)                   \
  int name(const char* path, int flags, ...) { \
    std::va_list more;                         \
    va_start(more, flags);                     \
    const mode_t mode = modeIn(flags, more);   \
    va_end(more);                              \
    return openAs(#name, path, flags, mode);   \
  }
#define BROADMARK_TRANSFER(name, kind, Bytes)                                                \
  ssize_t name(int descriptor, Bytes* bytes, std::size_t size) {                             \
    return divided(kind, descriptor, size, [&](std::size_t part) {                           \
      return systems<ssize_t (*)(int, Bytes*, std::size_t)>(#name)(descriptor, bytes, part); \
    });                                                                                      \
  }
#define BROADMARK_TRANSFER_AT(name, kind, Bytes)                                                   \
  ssize_t name(int descriptor, Bytes* bytes, std::size_t size, off_t offset) {                     \
    return divided(kind, descriptor, size, [&](std::size_t part) {                                 \
      return systems<ssize_t (*)(int, Bytes*, std::size_t, off_t)>(#name)(descriptor, bytes, part, \
                                                                          offset);                 \
    });                                                                                            \
  }
#define BROADMARK_ON_FILE(name, kind)                                       \
  int name(int descriptor) {                                                \
    return whole(kind, pathOf(descriptor),                                  \
                 [&] { return systems<int (*)(int)>(#name)(descriptor); }); \
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
               [&] { return systems<int (*)(int, off_t)>("ftruncate")(descriptor, size); });
}

/// Counted by where it leads to.
int rename(const char* from, const char* to) noexcept {
  return whole(kRename, pathOf(to),
               [&] { return systems<int (*)(const char*, const char*)>("rename")(from, to); });
}

int unlink(const char* path) noexcept {
  return whole(kUnlink, pathOf(path),
               [&] { return systems<int (*)(const char*)>("unlink")(path); });
}

int mkdir(const char* path, mode_t mode) noexcept {
  return whole(kMakeFolder, pathOf(path),
               [&] { return systems<int (*)(const char*, mode_t)>("mkdir")(path, mode); });
}

}  // extern "C"
#pragma GCC visibility pop
