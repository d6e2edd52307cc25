// The kinds of failure: somebody's input is wrong, this case cannot run here, or the process that
// ran it is gone; and the user's wish that long work ends.
#pragma once

#include <stdexcept>
#include <string>

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

/// The process that ran a case crashed or ended by itself; the message says how. The case's status
/// becomes `error`.
class HostError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A single call into an algorithm took longer than the hard limit, and was ended with its process.
/// The case's status becomes `timeout`.
class HardLimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown out of long work that the user ended. No error, so that nobody takes it for one.
struct Cancelled {};

/// What the exception that is being handled says. Only inside a catch.
std::string currentErrorText();

}  // namespace broadmark
