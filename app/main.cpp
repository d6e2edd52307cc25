// broadmark: generates scenes, runs broad-phase algorithms on them, checks and measures them.
// Exit statuses: exit_status.h.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "broadmark/error.h"
#include "broadmark/harness/memory_limit.h"
#include "commands/command_line.h"
#include "support/exit_status.h"
#include "support/interrupt.h"

namespace {

/// Throws unless everything printed has been written: a table on a full disc is an error.
void requirePrinted() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw broadmark::InputError("standard output: cannot write");
  }
}

std::terminate_handler previous_terminate_handler = nullptr;

/// Handles std::bad_alloc that main() cannot catch: thrown in a destructor (JSON's allocates).
void onTerminate() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    std::fputs("broadmark: out of memory\n", stderr);
    std::_Exit(broadmark::exit_status::bad_input);
  } catch (...) {  // NOLINT(bugprone-empty-catch): the previous handler reports it
  }
  previous_terminate_handler();
}

}  // namespace

int main(int argc, char** argv) {
  // Cap memory, so that a corrupt size field in a file cannot exhaust the machine.
  previous_terminate_handler = std::set_terminate(onTerminate);
  broadmark::limitMemory(broadmark::machineMemory(), /*permanent=*/false);
  try {
    const int status = broadmark::parseCommandLine({argv + 1, argv + argc})();
    requirePrinted();
    return status;
  } catch (const broadmark::Interrupted& interruption) {
    std::cerr << "broadmark: " << interruption.what() << '\n';
    return broadmark::exit_status::interrupted;
  } catch (const broadmark::InputError& error) {
    std::cerr << "broadmark: " << error.what() << '\n';
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "broadmark: " << error.path1().string() << ": " << error.code().message() << '\n';
  } catch (const std::system_error& error) {
    // A system call failed, such as a write or a thread start: not an internal error.
    std::cerr << "broadmark: " << error.what() << '\n';
  } catch (const std::bad_alloc&) {
    std::cerr << "broadmark: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "broadmark: internal error: " << error.what() << '\n';
  }
  return broadmark::exit_status::bad_input;
}
