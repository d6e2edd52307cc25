// The kinds of failure: invalid input, an unsupported case, or a lost host process; and
// cancellation of long work by the user.
//
// Example:
//
//   try {
//     throw InputError("crates.json: gravity: 'down' is not a number");
//   } catch (...) {
//     const std::string message = currentErrorText();
//   }
#pragma once

#include <stdexcept>
#include <string>

namespace broadmark {

/// Bad input or usage. The message is one line with the file or option, the fault and the expected
/// input. Caught once, in main(); exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The algorithm cannot run this case (no such instruction set, device or size). The case's status
/// becomes `unsupported` with the message as its reason; other cases still run.
class UnsupportedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The process that ran a case crashed or exited, as the message says. The case's status becomes
/// `error`.
class HostError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A single call into an algorithm exceeded the hard limit; its process was killed. The case's
/// status becomes `timeout`.
class HardLimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown when the user cancels long work. Not a std::exception, since it is no error.
struct Cancelled {};

/// An error with the reason why a system call has just failed, according to errno: `what`, a colon
/// and the reason, as in "no pipe: Too many open files". Returns it: the caller throws it.
std::runtime_error systemError(const char* what);

/// The message of the exception being handled; fixed texts for std::bad_alloc and for an exception
/// that is no std::exception. Only inside a catch block.
std::string currentErrorText();

}  // namespace broadmark
