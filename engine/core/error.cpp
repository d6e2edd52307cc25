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
    return "threw something that is no std::exception";
  }
}

}  // namespace broadmark
