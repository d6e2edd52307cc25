// Notification of calls into the engines of plug-ins, which may crash or never return.
#pragma once

#include <string>

namespace broadmark::scenes {

/// Notified on the thread of the call.
class EngineObserver {
 public:
  virtual ~EngineObserver() = default;
  /// `what` names engine, plug-in and frame.
  virtual void onCallStart(const std::string& what) = 0;
  virtual void onCallEnd() = 0;
};

/// Sets the observer of all simulations, which must outlive them. Not thread-safe with simulations
/// that run.
void observeEngines(EngineObserver& observer);

}  // namespace broadmark::scenes
