// broadmark: generates scenes, runs broad-phase algorithms on them, checks and measures them.
// How it ends: exit_status.h.

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

/// Memory may also run out in a destructor (JSON's takes some), from where nothing is thrown to
/// main().
void onTerminate() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    std::fputs("broadmark: out of memory\n", stderr);
    std::_Exit(broadmark::exit_status::bad_input);
  } catch (...) {
  }
  previous_terminate_handler();
}

}  // namespace

int main(int argc, char** argv) {
  // Whatever a file claims, it ends this program rather than the machine.
  previous_terminate_handler = std::set_terminate(onTerminate);
  broadmark::limitMemory(broadmark::machineMemory(), /*for_good=*/false);
  try {
    const int status = broadmark::parseCommandLine({argv + 1, argv + argc})();
    requirePrinted();
    return status;
  } catch (const broadmark::Interrupted& end) {
    std::cerr << "broadmark: " << end.what() << '\n';
    return broadmark::exit_status::interrupted;
  } catch (const broadmark::InputError& error) {
    std::cerr << "broadmark: " << error.what() << '\n';
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "broadmark: " << error.path1().string() << ": " << error.code().message() << '\n';
  } catch (const std::system_error& error) {
    // The system refused something, such as a write or a thread: no internal error.
    std::cerr << "broadmark: " << error.what() << '\n';
  } catch (const std::bad_alloc&) {
    std::cerr << "broadmark: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "broadmark: internal error: " << error.what() << '\n';
  }
  return broadmark::exit_status::bad_input;
}
