// Boxes, as .aabbs: the original's recordings.

#include "entries.h"
#include "recorders/box_recorder.h"

namespace broadmark::scenes::aabbs_recorder {

RecorderEntry entry() {
  return {{"aabbs", "boxes of all bodies, frame after frame", "Recordings_AABBs"},
          makeAs<Recorder, BoxRecorder>};
}

}  // namespace broadmark::scenes::aabbs_recorder
