// Instruction counts by valgrind's tool callgrind, under which this process then runs.
//
// callgrind is told what to count by client requests: sequences of instructions without any effect
// outside of valgrind, which are part of its stable interface (valgrind/valgrind.h). So neither
// building nor running needs valgrind.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace broadmark::callgrind {

/// The descriptor of an empty file that callgrind writes its counts to.
inline constexpr int kCountsDescriptor = 6;

/// `command` under callgrind; nothing is counted before start().
std::vector<std::string> commandUnder(const std::vector<std::string>& command);

/// Whether this process runs under any tool of valgrind.
bool isRunning();

void start();
void stop();

/// The instructions that the calling thread executed between all start() and stop() since the
/// last call; nullopt if callgrind does not tell.
std::optional<std::uint64_t> takeInstructions();

}  // namespace broadmark::callgrind
