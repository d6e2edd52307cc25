/* Box3D: cubes, some with a second shape, and some in a group whose bodies do not collide. */
#include "integrations/box3d.h"

#include "recorders/session.h"

#define SIDE 27.0f

static unsigned long long random_state = 1;
static b3BodyId bodies[kCubes + 6];
static int body_count = 0;

static float coordinate(void) { return (2 * uniform(&random_state) - 1) * (SIDE / 2 - 1); }

static void addWall(b3WorldId world, int axis, float sign) {
  b3BodyDef body = b3DefaultBodyDef();
  const b3ShapeDef shape = b3DefaultShapeDef();
  const float offset = sign * (SIDE / 2 + 1);
  const b3BoxHull hull =
      b3MakeBoxHull(axis == 0 ? 1 : SIDE, axis == 1 ? 1 : SIDE, axis == 2 ? 1 : SIDE);
  body.position.x = axis == 0 ? offset : 0;
  body.position.y = axis == 1 ? offset : 0;
  body.position.z = axis == 2 ? offset : 0;
  bodies[body_count] = b3CreateBody(world, &body);
  b3CreateHullShape(bodies[body_count++], &shape, &hull.base);
}

static void addCube(b3WorldId world) {
  b3BodyDef body = b3DefaultBodyDef();
  b3ShapeDef shape = b3DefaultShapeDef();
  const b3BoxHull hull = b3MakeBoxHull(0.5f, 0.5f, 0.5f);
  const b3Sphere sphere = {{0, 0.6f, 0}, 0.3f};
  body.type = b3_dynamicBody;
  body.position.x = coordinate();
  body.position.y = coordinate();
  body.position.z = coordinate();
  if (uniform(&random_state) < 0.1f) shape.filter.groupIndex = -3;
  bodies[body_count] = b3CreateBody(world, &body);
  b3CreateHullShape(bodies[body_count], &shape, &hull.base);
  if (uniform(&random_state) < 0.1f) b3CreateSphereShape(bodies[body_count], &shape, &sphere);
  ++body_count;
}

static void replaceSome(b3WorldId world) {
  int i;
  for (i = 0; i < kCubes / 100; ++i) {
    const int leaving = 6 + (int)(uniform(&random_state) * kCubes) % kCubes;
    b3DestroyBody(bodies[leaving]);
    bodies[leaving] = bodies[--body_count];
    addCube(world);
  }
}

/* Twice the margin of the trees, and what the box of a cube shrinks by as it turns. */
const char* const kAuditMargin = "0.5";

int recordSession(const char* name, enum World kind) {
  const b3WorldDef definition = b3DefaultWorldDef();
  const b3WorldId world = b3CreateWorld(&definition);
  broadmark_box3d session;
  int i, frame;
  for (i = 0; i < 6; ++i) addWall(world, i / 2, i % 2 == 0 ? -1.0f : 1.0f);
  for (i = 0; i < kCubes; ++i) addCube(world);
  broadmark_box3d_begin(&session, name, 2 * kCubes);
  for (frame = 0; frame < kFrames; ++frame) {
    const float angle = 0.05f * (float)frame;
    const b3Vec3 gravity = {30 * cosf(angle), 30 * sinf(angle), 0};
    if (kind == kTurning) b3World_SetGravity(world, gravity);
    if (kind == kChurning) replaceSome(world);
    b3World_Step(world, 1 / 60.0f, 4);
    broadmark_box3d_record(&session, world, bodies, body_count);
  }
  b3DestroyWorld(world);
  body_count = 0;
  return broadmark_record_end(&session.recorder);
}
