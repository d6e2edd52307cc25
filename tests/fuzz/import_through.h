// What every import promises: any bytes are either frames that can be read to their end, or an
// InputError.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "broadmark/error.h"
#include "fuzzed_file.h"
#include "sources/source.h"

namespace broadmark::fuzz {

/// Calls act(path) with a file of these bytes.
template <class Act>
void withFile(const std::uint8_t* data, std::size_t size, Act&& act) {
  const FileDescriptor file = fuzzedFile(data, size);
  try {
    act(std::filesystem::path(fmt::format("/proc/self/fd/{}", file.get())));
  } catch (const InputError&) {
  }
}

inline bool isWithin(const Aabb& box, const Aabb& world) { return merged(box, world) == world; }

/// Imports a file of this kind, all of its frames. Throws InputError.
inline void readAllFrames(const SourceKind& kind, const std::filesystem::path& path,
                          const ReadingOptions& options) {
  imports::ImportSummary summary;
  const auto frames = kind.import->open({path}, options, summary);
  const SceneInfo& scene = frames->scene();
  // Frames without bodies take no bytes: a short file may have any number of them.
  for (std::uint32_t index = 0; index <= std::min(scene.frames, 1000U); ++index) {
    const Frame frame = frames->at(index);
    if (frame.boxes.size() != scene.objects) std::abort();
    for (const Aabb& box : frame.boxes) {
      if (isEmpty(box) ? scene.all_present : !isWithin(box, scene.world)) std::abort();
      if (isEmpty(box) ? box != kEmptyBox : !overlaps(box, box)) std::abort();
    }
  }
}

/// Imports the bytes as a file of this kind.
inline void importThrough(const SourceKind& kind, const std::uint8_t* data, std::size_t size,
                          const ReadingOptions& options = {}) {
  withFile(data, size,
           [&](const std::filesystem::path& path) { readAllFrames(kind, path, options); });
}

/// Imports the bytes as particles: with a radius of their own, or one that is said, and with or
/// without their periodic box.
inline void particlesThrough(const SourceKind& kind, const std::uint8_t* data, std::size_t size) {
  ReadingOptions options;
  options.radius = static_cast<double>(size % 2);
  if (size / 2 % 2 == 1) options.periodic = kStatedPeriodicBox;
  importThrough(kind, data, size, options);
}

}  // namespace broadmark::fuzz
