// Any text is either scene parameters that survive a round trip unchanged, or an InputError.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/scenes/simulation.h"

namespace {

/// Whether the scene is known without reading a recording.
bool isSimulated(broadmark::Simulation& simulation) {
  const std::string engine = broadmark::parameterValues(simulation).at("engine");
  return std::ranges::none_of(broadmark::availableEngines(), [&](const auto& listing) {
    return listing.id == engine && listing.dynamics == broadmark::Dynamics::replayed;
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  std::unique_ptr<Simulation> simulation;
  try {
    simulation = parseSceneParameters({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
    return 0;
  }
  // What the program writes it must read: an InputError here ends the program.
  const std::string text = formatSceneParameters(*simulation);
  const auto again = parseSceneParameters(text, "written");
  if (parameterValues(*again) != parameterValues(*simulation)) std::abort();
  if (again->listing().id != simulation->listing().id) std::abort();
  if (isSimulated(*simulation) && again->scene() != simulation->scene()) std::abort();
  return 0;
}
