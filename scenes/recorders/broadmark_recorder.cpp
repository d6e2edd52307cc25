// Boxes, as .broadmark: also of scenes in which bodies come and go, or which have layers.

#include "entries.h"
#include "recorders/box_recorder.h"

namespace broadmark::scenes::broadmark_recorder {

RecorderEntry entry() {
  return {{"broadmark", "boxes of the bodies that changed; bodies may be absent, and have layers",
           "Recordings_Broadmark"},
          makeAs<Recorder, BoxRecorder>};
}

}  // namespace broadmark::scenes::broadmark_recorder
