// integrations/ode.h: a world of the Open Dynamics Engine, the pairs of its spaces audited.

#include "integrations/ode.h"

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

/// Two boxes on one body each, which fall through each other to a plane, some in a space of their
/// own.
class OdeRecorder : public EndToEnd {
 protected:
  OdeRecorder() {
    dInitODE2(0);
    world_ = dWorldCreate();
    dWorldSetGravity(world_, 0, -9.8, 0);
  }
  ~OdeRecorder() override {
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dCloseODE();
  }

  dGeomID addBody(dSpaceID space, double x, double y) const {
    const dBodyID body = dBodyCreate(world_);
    const dGeomID box = dCreateBox(space, 1, 1, 1);
    const dGeomID head = dCreateSphere(space, 0.4);
    dGeomSetBody(box, body);
    dGeomSetBody(head, body);
    dGeomSetOffsetPosition(head, 0, 0.6, 0);
    dBodySetPosition(body, x, y, 0);
    return box;
  }

  /// With a plane, if asked for: a sweep-and-prune space reports it with every geom.
  void record(dSpaceID space, bool has_plane) {
    space_ = space;
    const dSpaceID inner = dSimpleSpaceCreate(space);
    if (has_plane) dCreatePlane(space, 0, 1, 0, 0);
    for (int i = 0; i < 20; ++i) addBody(i < 8 ? inner : space, 0.7 * (i % 7), 2 + 0.77 * i);
    const dGeomID leaves = addBody(space, 0, 3);
    const dGeomID ghost = addBody(space, 1, 3);
    dGeomSetCategoryBits(ghost, 0);
    dGeomSetCollideBits(ghost, 0);
    broadmark_recorder recorder;
    ASSERT_TRUE(broadmark_record_begin(&recorder, file("session").c_str(), 60)) << recorder.error;
    for (int step = 0; step < 60; ++step) {
      if (step == 20) dGeomDestroy(leaves);
      if (step == 30) addBody(space, 0.5, 2);
      if (step == 40) dGeomDisable(ghost);
      ASSERT_TRUE(broadmark_record_space(&recorder, space)) << recorder.error;
      dWorldQuickStep(world_, 0.02);
    }
    ASSERT_TRUE(broadmark_record_end(&recorder)) << recorder.error;

    ProgramResult ended = audit();
    EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("in 60 frames, of which none is wrong"));
    const std::string log = readFile(file("session.csv"));
    writeFile(file("session.csv"), log.substr(0, log.rfind('\n', log.size() - 2) + 1));
    EXPECT_THAT(audit().out, testing::ContainsRegex("missed +1 +1 +59 "));
  }
  [[nodiscard]] ProgramResult audit() const {
    return run({"audit", "session.broadmark", "session.csv", "--margin", "1e-6", "--quiet"});
  }

  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
};

TEST_F(OdeRecorder, PairsOfAHashSpaceAreAudited) { record(dHashSpaceCreate(nullptr), true); }
TEST_F(OdeRecorder, PairsOfASweepAreAudited) {
  record(dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY), false);
}
TEST_F(OdeRecorder, QuadTreesAreRefused) {
  const dVector3 centre = {0, 0, 0, 0};
  const dVector3 extents = {50, 50, 50, 0};
  space_ = dQuadTreeSpaceCreate(nullptr, centre, extents, 5);
  broadmark_recorder recorder;
  ASSERT_TRUE(broadmark_record_begin(&recorder, file("session").c_str(), 0));
  EXPECT_FALSE(broadmark_record_space(&recorder, space_));
  EXPECT_THAT(recorder.error, HasSubstr("quad-tree"));
  EXPECT_FALSE(broadmark_record_end(&recorder));
}

}  // namespace
}  // namespace broadmark::tests
