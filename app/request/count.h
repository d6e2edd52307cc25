// --count: instructions instead of times, a measure without noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "request/cases.h"

namespace broadmark {

struct RunRequest;

inline constexpr const char* kInstructions = "instructions";

struct CountOptions {
  bool instructions = false;
  std::uint32_t frames = 10;  ///< of each recording, the first ones
};

/// Parses a value of --count: "instructions" or "instructions:FRAMES". Throws InputError.
CountOptions parseCount(const std::string& text);
/// The reverse; "" if nothing is counted.
std::string countText(const CountOptions&);

/// If the request counts instructions, chooses what counts them, the processor or else valgrind,
/// and sets everything that follows: threads, instruction sets, number of frames. Throws
/// InputError for options that exclude counting.
void prepareCount(RunRequest&);

/// The case of this name, with defaults that can be counted.
Case countedCaseNamed(const std::string& name, const RunRequest&);

/// Throws InputError for a case with several threads.
void requireOneThread(const std::vector<Case>&);

}  // namespace broadmark
