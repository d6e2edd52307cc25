// The two kinds of failure: somebody's input is wrong, or this case cannot run here.
#pragma once

#include <stdexcept>

namespace broadmark {

/// Bad input or usage. The message is one line that names the file or option, what is wrong and
/// what would be right. Caught once, at the top; exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The algorithm cannot run this case (no such instruction set, device or size). The case's status
/// becomes `unsupported` with the message as its reason; everything else runs on.
class UnsupportedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace broadmark
