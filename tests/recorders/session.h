/* A session of an engine, recorded with its file in integrations/: 1,000 cubes between six walls,
 * for 200 frames. One file implements it for each engine. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

enum { kCubes = 1000, kFrames = 200 };

enum World {
  kFalling, /* cubes fall, come to rest, and some of them sleep */
  kTurning, /* strong gravity turns around */
  kChurning /* ten cubes leave in each frame, and ten come in */
};

/* Writes NAME.broadmark and NAME.csv. Returns 1 on success. */
int recordSession(const char* name, enum World world);

/* What the audit has to allow. */
extern const char* const kAuditMargin;

/* Pseudo-random numbers from 0 to 1. */
static inline float uniform(unsigned long long* state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (float)(*state >> 40) / 16777216.0F;
}

#ifdef __cplusplus
}
#endif
