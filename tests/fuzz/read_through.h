// What every parser of recordings promises: any bytes are either a recording that can be read to
// its end, or an InputError.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/recordings/recording.h"
#include "fuzzed_file.h"

namespace broadmark::fuzz {

/// Aborts unless all boxes are those of a body, there or absent, and what is not said to have
/// changed is as in the frame before.
inline void requireValid(const Frame& frame, const SceneInfo& scene, std::span<const Aabb> before) {
  std::size_t listed = 0;
  for (std::uint32_t body = 0; body < frame.boxes.size(); ++body) {
    const Aabb& box = frame.boxes[body];
    if (!overlaps(box, box) && (scene.all_present || box != kEmptyBox)) std::abort();
    if (!frame.changed) continue;
    const bool changed = listed < frame.changed->size() && (*frame.changed)[listed] == body;
    listed += static_cast<std::size_t>(changed);
    if (!changed && !sameBits(box, before[body])) std::abort();
  }
  if (frame.changed && listed != frame.changed->size()) std::abort();
}

/// Reads the bytes as the recording of a Reader, made from an open descriptor and a name.
template <class Reader>
void readThrough(const std::uint8_t* data, std::size_t size) {
  try {
    Reader recording(fuzzedFile(data, size), "fuzz");
    Frame frame = recording.rewind();
    std::vector<Aabb> before(frame.boxes.begin(), frame.boxes.end());
    // Frames without bodies take no bytes: a short file may state any number of them.
    for (int i = 0; i < 1000; ++i) {
      requireValid(frame, recording.scene(), before);
      before.assign(frame.boxes.begin(), frame.boxes.end());
      const auto next = recording.next();
      if (!next) break;
      frame = *next;
    }
    // What was read one by one is read again wherever one begins.
    const std::uint32_t last = frame.index;
    recording.rewind();
    if (!std::ranges::equal(recording.at(last).boxes, before, sameBits)) std::abort();
    if (recording.hash().size() != 32) std::abort();
  } catch (const InputError&) {
  }
}

}  // namespace broadmark::fuzz
