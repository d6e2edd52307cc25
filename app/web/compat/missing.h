// What this code uses of glibc and of C++20's library, and Emscripten lacks. Included before every
// source of the build for browsers. There are no processes: what starts one fails, and says so.
#pragma once

#include <malloc.h>
#include <signal.h>
#include <spawn.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <string>

inline const char* sigdescr_np(int) { return "a signal"; }
inline const char* sigabbrev_np(int) { return nullptr; }
inline int posix_spawn_file_actions_addclosefrom_np(posix_spawn_file_actions_t*, int) { return 0; }
inline struct mallinfo mallinfo2() { return mallinfo(); }
template <class... Arguments>
long syscall(long, Arguments...) {
  errno = ENOSYS;
  return -1;
}
constexpr long SYS_pidfd_open = 0;
constexpr long SYS_perf_event_open = 0;

namespace std {

template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& value) : value_(&value) {}
  T load(memory_order order) const { return __atomic_load_n(value_, static_cast<int>(order)); }
  void store(T value, memory_order order) const {
    __atomic_store_n(value_, value, static_cast<int>(order));
  }

 private:
  T* value_;
};

template <class T>
  requires is_floating_point_v<T>
from_chars_result from_chars(const char* first, const char* last, T& value,
                             chars_format = chars_format::general) {
  const string text(first, last);
  const char* const digits = text.c_str() + (text.starts_with('-') ? 1 : 0);
  const bool is_hex = digits[0] == '0' && (digits[1] | 0x20) == 'x';
  const bool is_number =
      (*digits >= '0' && *digits <= '9') || *digits == '.' || (*digits | 0x20) >= 'a';
  if (!is_number || is_hex) return {first, errc::invalid_argument};
  char* end = nullptr;
  errno = 0;
  T parsed{};
  if constexpr (sizeof(T) == sizeof(float)) {
    parsed = strtof(text.c_str(), &end);
  } else {
    parsed = strtod(text.c_str(), &end);
  }
  const char* const stop = first + (end - text.c_str());
  if (stop == first) return {first, errc::invalid_argument};
  if (errno == ERANGE) return {stop, errc::result_out_of_range};
  value = parsed;
  return {stop, errc{}};
}

}  // namespace std
