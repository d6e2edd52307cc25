// Functions that Emscripten's headers declare and its C library lacks.
#include <emscripten/threading.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <spawn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string_view>

#include "broadmark_plugin.h"

extern "C" {

// The only library is the algorithm of the example "Find the bug".
void* dlopen(const char* path, int /*mode*/) {
  static char library = 0;
  return std::string_view(path).ends_with("/find-the-bug.so") ? &library : nullptr;
}
void* dlsym(void* /*library*/, const char* symbol) {
  if (std::string_view(symbol) != "broadmark_c_plugin") return nullptr;
  return reinterpret_cast<void*>(broadmark_c_plugin);
}

int sched_getaffinity(pid_t /*process*/, std::size_t size, cpu_set_t* set) {
  const int cores = emscripten_num_logical_cores();
  CPU_ZERO_S(size, set);
  for (int core = 0; core < cores; ++core) CPU_SET_S(core, size, set);
  return 0;
}

int pthread_setaffinity_np(pthread_t /*thread*/, std::size_t /*size*/, const cpu_set_t* /*set*/) {
  return ENOSYS;
}

int sched_getcpu() { return -1; }

int sync_file_range(int /*file*/, off_t /*offset*/, off_t /*count*/, unsigned /*flags*/) {
  return 0;
}

int memfd_create(const char* /*name*/, unsigned /*flags*/) {
  char file[] = "/tmp/memory-XXXXXX";
  const int descriptor = mkstemp(file);
  unlink(file);
  return descriptor;
}

int posix_spawnp(pid_t* /*process*/, const char* /*file*/,
                 const posix_spawn_file_actions_t* /*actions*/, const posix_spawnattr_t* /*how*/,
                 char* const* /*arguments*/, char* const* /*environment*/) {
  return ENOSYS;
}

int glfwGetError(const char** description) {
  *description = "the browser has no WebGL 2";
  return 1;
}
}
