// Running the inspector: in a window, or off-screen.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case_host.h"
#include "broadmark/render/picture.h"

namespace broadmark {

class Session;

/// What the inspector starts with.
struct InspectOptions {
  std::vector<Algorithm> algorithms;    ///< that can be chosen
  HostMaker make_host = makeLocalHost;  ///< where these run
  std::function<void(Session&)> begin;  ///< opens the source, adds algorithms
  std::filesystem::path script;         ///< "": none
  std::filesystem::path screenshot;     ///< of the end, off-screen; "": none
  int width = 1280;                     ///< off-screen
  int height = 720;
  double scale = 1;
  GlSource gl = GlSource::automatic;
};

/// Opens a window and returns when it is closed. Throws RenderError where no window can be opened.
void inspectInWindow(const InspectOptions& options);
/// Draws into pictures only, until the script is done and all is computed. Preferences are neither
/// read nor written. Throws InputError when the script fails, RenderError.
void inspectOffscreen(const InspectOptions& options);

}  // namespace broadmark
