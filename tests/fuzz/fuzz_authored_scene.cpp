// Any text is either an authored scene that survives a round trip unchanged, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/scenes/authored_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  scenes::AuthoredScene scene;
  try {
    scene = scenes::parseAuthoredScene({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
    return 0;
  }
  // What the program writes it must read: an InputError here ends the program.
  const std::string text = scenes::formatAuthoredScene(scene);
  const scenes::AuthoredScene again = scenes::parseAuthoredScene(text, "written");
  if (again != scene || scenes::formatAuthoredScene(again) != text) std::abort();
  if (scenes::boxesOf(again).size() != scene.bodies.size()) std::abort();
  return 0;
}
