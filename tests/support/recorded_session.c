#include "support/recorded_session.h"

#include "integrations/broadmark_recorder.h"

enum { kBodies = 30, kFrames = 12 };

static int isPresent(int body, int frame) { return body % 5 != frame % 5 || body < 3; }
static int isGhost(int body, int frame) { return body % 7 == 3 && frame > 6; } /* no pairs */

static int overlap(int frame, int a, int b) {
  const int bodies[2] = {a, b};
  int i;
  for (i = 0; i < 2; ++i) {
    if (!isPresent(bodies[i], frame) || isGhost(bodies[i], frame)) return 0;
  }
  return b - a <= 2 && !(a % 2 == 0 && b == a + 2 && b < 8); /* those share a tag */
}

int recordSession(const char* name) {
  broadmark_recorder recorder;
  unsigned solid, ghost;
  int frame, a, b;
  broadmark_record_begin(&recorder, name, kBodies);
  solid = broadmark_record_layer(&recorder, 1, 1);
  ghost = broadmark_record_layer(&recorder, 2, 1);
  for (frame = 0; frame < kFrames; ++frame) {
    for (a = 0; a < kBodies; ++a) {
      const double min[3] = {a, 0.1 * frame, 0};
      const double max[3] = {a + 2.5, 0.1 * frame + 1, 1};
      const int has_tag = a % 2 == 0 && a < 8;
      if (!isPresent(a, frame)) continue;
      broadmark_record_box(&recorder, 1000u * (unsigned)a, min, max,
                           isGhost(a, frame) ? ghost : solid, has_tag ? 7 : BROADMARK_NO_TAG);
    }
    for (a = 0; a < kBodies; ++a) {
      for (b = a + 1; b < kBodies; ++b) {
        if (overlap(frame, a, b)) {
          broadmark_record_pair(&recorder, 1000u * (unsigned)b, 1000u * (unsigned)a);
        }
      }
    }
    broadmark_record_frame(&recorder);
  }
  return broadmark_record_end(&recorder);
}
