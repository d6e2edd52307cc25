#include "broadmark/error.h"

#include <exception>
#include <new>

namespace broadmark {

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
