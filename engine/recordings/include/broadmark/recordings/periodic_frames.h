// Frames of a periodic world.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "broadmark/frame.h"

namespace broadmark {

/// The value of the option "periodic" for a source that states its periodic box.
inline constexpr std::string_view kStatedPeriodicBox = "source";

/// Suffix of the name of a scene with a given periodic box.
inline constexpr std::string_view kPeriodicSuffix = " periodic";
/// The scene with a periodic box: kStatedPeriodicBox, which it must have, or one as text. Throws
/// InputError.
SceneInfo periodicScene(SceneInfo, const std::string& box);

/// A source with this periodic box, and with its boxes wrapped().
std::unique_ptr<IndexedFrames> periodicFrames(std::unique_ptr<IndexedFrames> frames,
                                              const std::string& box);

}  // namespace broadmark
