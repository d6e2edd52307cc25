// The time of a call.
#pragma once

#include <chrono>

namespace broadmark::benchmarks {

template <class Call>
double nanosecondsOf(const Call& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace broadmark::benchmarks
