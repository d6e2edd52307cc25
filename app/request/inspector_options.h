// What the inspector shows at first, beside what its run request says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/orbit_camera.h"

namespace broadmark {

struct InspectorOptions {
  std::filesystem::path script;          ///< of user actions; "": none
  std::optional<OrbitCamera> camera;     ///< nothing: one that shows the whole scene
  std::vector<std::uint32_t> selection;  ///< bodies
};

/// "X,Y,Z,YAW,PITCH,DISTANCE": the pivot and the distance from it in view space, angles in degrees.
std::string cameraText(const OrbitCamera& camera);
/// Parses that text. Throws InputError.
OrbitCamera parseCamera(const std::string& text);
/// Parses ids of bodies, "3,14". Throws InputError.
std::vector<std::uint32_t> parseBodies(const std::string& text);

}  // namespace broadmark
