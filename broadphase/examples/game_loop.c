/* The C interface: balls in a box, saved and rolled back as a networked game does; and a query. */

#include <broadmark/broadphase.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BALLS = 500 };

/* The library takes boxes where the game has them. */
typedef struct ball {
  float position[3];
  float velocity[3];
  bm_box box;
} ball;

static void check(bm_status status) {
  if (status == BM_OK) return;
  fprintf(stderr, "game_loop: %s\n", bm_last_error());
  exit(1);
}

static void move(ball* balls) {
  for (int i = 0; i < BALLS; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      float* x = &balls[i].position[axis];
      *x += balls[i].velocity[axis];
      if (*x < 0 || *x > 20) balls[i].velocity[axis] = -balls[i].velocity[axis];
      balls[i].box.min[axis] = *x - 0.5F;
      balls[i].box.max[axis] = *x + 0.5F;
    }
  }
}

static bm_pairs play(bm_broadphase* broadphase, ball* balls, int frames) {
  const bm_boxes boxes = {balls[0].box.min, balls[0].box.max, BALLS, sizeof(ball)};
  bm_pairs pairs = {NULL, 0};
  for (int frame = 0; frame < frames; ++frame) {
    move(balls);
    check(bm_update(broadphase, boxes));
  }
  check(bm_get_pairs(broadphase, &pairs));
  printf("%d frames: %lu pairs\n", frames, (unsigned long)pairs.count);
  return pairs;
}

int main(void) {
  static ball balls[BALLS], saved_balls[BALLS];
  static bm_pair expected[BALLS * BALLS];
  unsigned random = 1;
  for (int i = 0; i < 3 * BALLS; ++i) {
    random = random * 1664525U + 1013904223U;
    balls[i / 3].position[i % 3] = (float)(random >> 16 & 1023) * 0.02F;
    balls[i / 3].velocity[i % 3] = (float)(random >> 8 & 127) * 0.002F - 0.125F;
  }

  bm_options options;
  bm_default_options(&options);
  options.margin = 0.1F;
  bm_broadphase* broadphase = NULL;
  check(bm_create(&options, &broadphase));
  play(broadphase, balls, 100);

  size_t size = 0;
  bm_save(broadphase, NULL, 0, &size);
  void* state = malloc(size);
  check(bm_save(broadphase, state, size, &size));
  memcpy(saved_balls, balls, sizeof(balls));

  bm_pairs pairs = play(broadphase, balls, 8);
  memcpy(expected, pairs.pairs, pairs.count * sizeof(bm_pair));

  check(bm_restore(broadphase, state, size)); /* the rollback, then the same frames again */
  memcpy(balls, saved_balls, sizeof(balls));
  pairs = play(broadphase, balls, 8);
  if (memcmp(expected, pairs.pairs, pairs.count * sizeof(bm_pair)) != 0) return 1;

  /* The three balls nearest to a corner. */
  const bm_nearest_query corner = {{0, 0, 0}, 3, INFINITY, BM_ALL_LAYERS};
  bm_neighbour_results nearest;
  check(bm_nearest(broadphase, &corner, 1, &nearest));
  for (size_t i = 0; i < nearest.starts[1]; ++i) {
    printf("ball %u: %.2f away\n", (unsigned)nearest.items[i].body, nearest.items[i].distance);
  }

  balls[7].box.min[1] = NAN;
  const bm_boxes boxes = {balls[0].box.min, balls[0].box.max, BALLS, sizeof(ball)};
  if (bm_update(broadphase, boxes) != BM_INVALID_ARGUMENT) return 1;
  printf("an error: %s\n", bm_last_error());
  bm_destroy(broadphase);
  free(state);
  return 0;
}
