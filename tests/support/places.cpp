#include "support/places.h"

namespace broadmark::places {

std::filesystem::path source(const std::string& path) {
  return std::filesystem::path(SOURCE_FOLDER) / path;
}
std::string program() { return PROGRAM; }
std::string faultyPlugin() { return FAULTY_PLUGIN; }
std::string unrulyPlugin() { return UNRULY_PLUGIN; }
std::string unrulyEngine() { return UNRULY_ENGINE; }
std::string invalidPlugin() { return INVALID_PLUGIN; }
std::string enginePlugin() { return ENGINE_PLUGIN; }
std::string quickPlugin() { return QUICK_PLUGIN; }
std::string slowPlugin() { return SLOW_PLUGIN; }
std::string idlePlugin() { return IDLE_PLUGIN; }
std::string foreignPlugin() { return FOREIGN_PLUGIN; }
std::string faultInjection() { return FAULT_INJECTION; }

}  // namespace broadmark::places
