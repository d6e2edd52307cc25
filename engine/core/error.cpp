#include "broadmark/error.h"

#include <cerrno>
#include <cstring>
#include <exception>
#include <new>

namespace broadmark {

std::runtime_error systemError(const char* what) {
  return std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

std::string currentErrorText() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "threw an exception that is not a std::exception";
  }
}

}  // namespace broadmark
