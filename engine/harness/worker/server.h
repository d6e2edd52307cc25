// The worker's side of the protocol, without what it does to its process.
#pragma once

#include "broadmark/harness/worker_process.h"
#include "worker/protocol.h"

namespace broadmark::worker {

/// Answers the calls of the other side until that hangs up. Throws HostError for what is no
/// message.
void answerCalls(Channel& channel, SharedMemory frames, SharedMemory answers,
                 const AlgorithmFinder& find);

}  // namespace broadmark::worker
