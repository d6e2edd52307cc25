// integrations/bullet.h: a world of Bullet, its pair cache audited.

#include "integrations/bullet.h"

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

/// Boxes that fall on the ground and on each other.
class BulletWorld {
 public:
  explicit BulletWorld(btBroadphaseInterface& broad_phase)
      : world_(&dispatcher_, &broad_phase, &solver_, &configuration_) {
    add(ground_shape_, 0, {0, -1, 0});
    add(ground_shape_, 0, {0, -1.5F, 0});  // Bullet reports no pair of two static bodies
    for (int i = 0; i < 60; ++i) {
      add(shape_, 1, {btScalar(i % 3) * 1.2F, btScalar(i / 9) * 1.1F + 1, btScalar(i / 3 % 3)});
    }
  }
  ~BulletWorld() {
    while (!bodies_.empty()) removeLast();
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void add(btBoxShape& shape, btScalar mass, const btVector3& at) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(at);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
  }
  void addFalling() { add(shape_, 1, {1, 6, 1}); }
  void removeLast() {
    world_.removeRigidBody(bodies_.back().get());
    bodies_.pop_back();
  }
  btDiscreteDynamicsWorld& world() { return world_; }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btSequentialImpulseConstraintSolver solver_;
  btBoxShape shape_{{0.5F, 0.5F, 0.5F}};
  btBoxShape ground_shape_{{20, 1, 20}};
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

class BulletRecorder : public EndToEnd {
 protected:
  void record(btBroadphaseInterface& broad_phase) const {
    BulletWorld bodies(broad_phase);
    broadmark_recorder recorder;
    ASSERT_TRUE(broadmark_record_begin(&recorder, file("session").c_str(), 70)) << recorder.error;
    for (int step = 0; step < 120; ++step) {
      if (step == 20) bodies.removeLast();
      if (step == 40 || step == 41) bodies.addFalling();
      bodies.world().stepSimulation(btScalar(1) / 60, 0);
      ASSERT_TRUE(broadmarkRecord(recorder, bodies.world())) << recorder.error;
    }
    ASSERT_TRUE(broadmark_record_end(&recorder)) << recorder.error;
  }

  [[nodiscard]] std::string audited() const {
    return run({"audit", "session.broadmark", "session.csv", "--margin", "0.1", "--quiet"}).out;
  }

  /// Removes the last pair of the ground, body 0, with a box that lies on it.
  void dropPair() const {
    const std::string log = readFile(file("session.csv"));
    const std::size_t row = log.rfind("\n119,0,");
    ASSERT_NE(row, std::string::npos);
    writeFile(file("session.csv"), log.substr(0, row) + log.substr(log.find('\n', row + 1)));
  }
};

TEST_F(BulletRecorder, ThePairsOfItsTreeAreAudited) {
  btDbvtBroadphase broad_phase;
  record(broad_phase);
  EXPECT_THAT(audited(), Not(HasSubstr("missed")));
  EXPECT_THAT(audited(), HasSubstr("in 120 frames"));
  dropPair();
  EXPECT_THAT(audited(), testing::ContainsRegex("missed +1 +1 +119 "));
}

TEST_F(BulletRecorder, ThePairsOfItsSweepAreAudited) {
  btAxisSweep3 broad_phase({-30, -30, -30}, {30, 30, 30});
  record(broad_phase);
  EXPECT_THAT(audited(), Not(HasSubstr("missed")));
  dropPair();
  EXPECT_THAT(audited(), testing::ContainsRegex("missed +1 +1 +119 "));
}

}  // namespace
}  // namespace broadmark::tests
