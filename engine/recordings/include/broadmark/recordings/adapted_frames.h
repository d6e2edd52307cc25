// Reading options that change the boxes of any source: the list of frame adapters.
#pragma once

#include <memory>
#include <string>

#include "broadmark/frame.h"
#include "broadmark/parameters.h"

namespace broadmark {

// `reading`: reading options that are not at their defaults, as in results. Each adapter is named
// after its option, and they apply in the order of the list in adapted_frames.cpp: first "swept",
// then "widen". Other options are ignored.

/// The options among these that change boxes.
ParameterValues adaptersIn(ParameterValues reading);

/// A source with adapted boxes; without such options the source itself. Throws InputError for an
/// invalid value.
std::unique_ptr<IndexedFrames> adapted(std::unique_ptr<IndexedFrames> frames,
                                       const ParameterValues& reading);

/// The scene of the adapted frames of this scene: "FreeFall swept", "FreeFall swept widened".
SceneInfo adaptedScene(SceneInfo scene, const ParameterValues& reading);
/// The name of the scene whose adapted name this is.
std::string unadaptedName(std::string name, const ParameterValues& reading);

/// The hash of a recording's adapted boxes; `hash` is the recording's own.
std::string adaptedHash(std::string hash, const ParameterValues& reading);

}  // namespace broadmark
