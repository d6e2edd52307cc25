// Crashes and hangs of plug-ins in this process: a clear message instead of a dead program.
#pragma once

#include <limits>
#include <string>

namespace broadmark {

inline constexpr double kNoEngineLimit = std::numeric_limits<double>::infinity();

/// Guards engines of plug-ins from now on. A crash in one ends the process with a message. So does
/// a frame that takes longer than `limit_seconds`, and a frame that ends too late after an
/// interrupt (support/interrupt.h): an engine that hangs never asks for it.
void guardEngines(double limit_seconds);

/// A call into a plug-in, for its lifetime. Does nothing before guardEngines().
class PluginCall {
 public:
  /// `what`: the plug-in and the call, for messages.
  explicit PluginCall(const std::string& what);
  ~PluginCall();
  PluginCall(const PluginCall&) = delete;
  PluginCall& operator=(const PluginCall&) = delete;
};

}  // namespace broadmark
