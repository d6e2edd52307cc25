// broadmark: generates scenes, runs broad-phase algorithms on them, checks and measures them.
//
// Exit status: 0 all well; 1 a case mismatched, timed out or regressed; 2 bad usage or input.

#include <exception>
#include <iostream>

#include "app/options.h"
#include "broadmark/error.h"

int main(int argc, char** argv) {
  try {
    return broadmark::runCommandLine(argc, argv);
  } catch (const broadmark::InputError& error) {
    std::cerr << "broadmark: " << error.what() << '\n';
  } catch (const std::bad_alloc&) {
    std::cerr << "broadmark: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "broadmark: internal error: " << error.what() << '\n';
  }
  return 2;
}
