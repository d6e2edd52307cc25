// Queries of the broad-phase library beside those of other libraries' trees, on the same boxes: one
// thread, nanoseconds a query. Contestants alternate, batch by batch.
//
//   query_ratios [ROUNDS [BODIES...]]

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#if BROADMARK_BOOST
#define BOOST_ALLOW_DEPRECATED_HEADERS  // suppresses Boost's own notes
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/core/cs.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#endif
#if BROADMARK_EMBREE
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#endif

#include "broadmark/broadphase.hpp"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
namespace bp = broadmark::broadphase;

struct Batch {
  std::vector<bp::BoxQuery> boxes;
  std::vector<bp::Cast> rays;
  std::vector<bp::NearestQuery> points;
};

/// Boxes of eight times a body's volume, rays across the world, the eight nearest bodies.
Batch batchIn(std::size_t bodies, std::size_t count, std::uint64_t seed) {
  const float side = inputs::cubeRoot(10.0 * static_cast<double>(bodies));
  inputs::Random random(seed, 0);
  Batch batch;
  for (std::size_t i = 0; i < count; ++i) {
    const inputs::Vec3 from = random.inCube(side);
    const inputs::Vec3 to = random.inCube(side);
    bp::BoxQuery box;
    bp::Cast ray;
    bp::NearestQuery point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.box.min[axis] = from[axis];
      box.box.max[axis] = from[axis] + 2;
      ray.box.min[axis] = ray.box.max[axis] = point.point[axis] = from[axis];
      ray.direction[axis] = to[axis] - from[axis];
    }
    point.count = 8;
    batch.boxes.push_back(box);
    batch.rays.push_back(ray);
    batch.points.push_back(point);
  }
  return batch;
}

/// Answers a batch, and returns how much it found; all contestants of a kind find the same.
using Answer = std::function<double(const Batch&)>;

struct Contestant {
  std::string kind;
  std::string name;
  Answer answer;
  std::vector<double> nanoseconds = {};
};

void addLibrary(const std::vector<Aabb>& boxes, std::vector<Contestant>& all) {
  const auto object = std::make_shared<bp::BroadPhase>();
  object->update(bp::Boxes(boxes[0].min.data(), boxes[0].max.data(), boxes.size(), sizeof(Aabb)));
  const auto bodies = std::make_shared<bp::QueryResults<std::uint32_t>>();
  const auto hits = std::make_shared<bp::QueryResults<bp::CastHit>>();
  const auto neighbours = std::make_shared<bp::QueryResults<bp::Neighbour>>();
  all.push_back({"boxes", "broadmark", [=](const Batch& batch) {
                   object->overlapping(batch.boxes, *bodies);
                   return static_cast<double>(bodies->items.size());
                 }});
  const auto cast = [=](bp::Hits wanted) {
    return [=](const Batch& batch) {
      object->cast(batch.rays, wanted, *hits);
      return static_cast<double>(hits->items.size());
    };
  };
  all.push_back({"rays, all hits", "broadmark", cast(bp::Hits::all)});
  all.push_back({"rays, closest", "broadmark", cast(bp::Hits::closest)});
  all.push_back({"8 nearest", "broadmark", [=](const Batch& batch) {
                   object->nearest(batch.points, *neighbours);
                   return static_cast<double>(neighbours->items.size());
                 }});
}

// Bullet: the tree of btDbvtBroadphase, after the optimisation that its manual recommends for
// static bodies. Rays find all hits; the closest is one of them.

btVector3 vectorOf(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }

void addBullet(const std::vector<Aabb>& boxes, std::vector<Contestant>& all) {
  const auto tree = std::make_shared<btDbvt>();
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    tree->insert(
        btDbvtVolume::FromMM(vectorOf(boxes[body].min.data()), vectorOf(boxes[body].max.data())),
        reinterpret_cast<void*>(body));
  }
  tree->optimizeTopDown();
  struct Collector : btDbvt::ICollide {
    std::vector<std::size_t> bodies;
    void Process(const btDbvtNode* leaf) override {
      bodies.push_back(reinterpret_cast<std::size_t>(leaf->data));
    }
  };
  const auto collector = std::make_shared<Collector>();
  all.push_back({"boxes", "btDbvt", [=](const Batch& batch) {
                   std::size_t found = 0;
                   for (const bp::BoxQuery& query : batch.boxes) {
                     collector->bodies.clear();
                     tree->collideTV(
                         tree->m_root,
                         btDbvtVolume::FromMM(vectorOf(query.box.min), vectorOf(query.box.max)),
                         *collector);
                     found += collector->bodies.size();
                   }
                   return static_cast<double>(found);
                 }});
  const auto stack = std::make_shared<btAlignedObjectArray<const btDbvtNode*>>();
  const auto cast = [=](bool closest) {
    return [=](const Batch& batch) {
      std::size_t found = 0;
      for (const bp::Cast& ray : batch.rays) {
        collector->bodies.clear();
        const btVector3 from = vectorOf(ray.box.min);
        const btVector3 to = from + vectorOf(ray.direction);
        const btVector3 direction = (to - from).normalized();
        btVector3 inverse;
        unsigned signs[3];
        for (int axis = 0; axis < 3; ++axis) {
          inverse[axis] = direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / direction[axis];
          signs[axis] = inverse[axis] < 0 ? 1 : 0;
        }
        tree->rayTestInternal(tree->m_root, from, to, inverse, signs, (to - from).length(),
                              btVector3(0, 0, 0), btVector3(0, 0, 0), *stack, *collector);
        found +=
            closest ? std::min<std::size_t>(collector->bodies.size(), 1) : collector->bodies.size();
      }
      return static_cast<double>(found);
    };
  };
  all.push_back({"rays, all hits", "btDbvt", cast(false)});
  all.push_back({"rays, closest", "btDbvt", cast(true)});
}

// Boost: the packed R-tree.

#if BROADMARK_BOOST
namespace index = boost::geometry::index;
using BoostPoint = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using BoostBox = boost::geometry::model::box<BoostPoint>;
using BoostValue = std::pair<BoostBox, std::uint32_t>;

BoostPoint pointOf(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }

void addBoost(const std::vector<Aabb>& boxes, std::vector<Contestant>& all) {
  std::vector<BoostValue> values;
  for (const Aabb& box : boxes) {
    values.push_back({{pointOf(box.min.data()), pointOf(box.max.data())},
                      static_cast<std::uint32_t>(values.size())});
  }
  using Tree = index::rtree<BoostValue, index::quadratic<8>>;
  const auto tree = std::make_shared<Tree>(values);
  const auto bodies = std::make_shared<std::vector<std::uint32_t>>();
  const auto find = [=](const auto& predicate) {
    bodies->clear();
    const auto add = [&](const BoostValue& value) { bodies->push_back(value.second); };
    tree->query(predicate, boost::make_function_output_iterator(add));
    return bodies->size();
  };
  all.push_back({"boxes", "Boost", [=](const Batch& batch) {
                   std::size_t found = 0;
                   for (const bp::BoxQuery& query : batch.boxes) {
                     found += find(index::intersects(
                         BoostBox(pointOf(query.box.min), pointOf(query.box.max))));
                   }
                   return static_cast<double>(found);
                 }});
  all.push_back({"8 nearest", "Boost", [=](const Batch& batch) {
                   std::size_t found = 0;
                   for (const bp::NearestQuery& query : batch.points) {
                     found += find(index::nearest(pointOf(query.point), query.count));
                   }
                   return static_cast<double>(found);
                 }});
}
#endif

// Embree: a user geometry of boxes, built by the surface area heuristic.

#if BROADMARK_EMBREE
void intersect(RTCScene scene, RTCRayHit& rayhit) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &rayhit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &rayhit);
#endif
}

void addEmbree(const std::vector<Aabb>& boxes, std::vector<Contestant>& all) {
  const std::shared_ptr<RTCDeviceTy> device(rtcNewDevice("threads=1"), rtcReleaseDevice);
  const std::shared_ptr<RTCSceneTy> scene(rtcNewScene(device.get()), rtcReleaseScene);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
  const auto kept = std::make_shared<std::vector<Aabb>>(boxes);
  rtcSetGeometryUserData(geometry, kept.get());
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* of) {
        const Aabb& box = (*static_cast<std::vector<Aabb>*>(of->geometryUserPtr))[of->primID];
        *of->bounds_o = {box.min[0], box.min[1], box.min[2], 0,
                         box.max[0], box.max[1], box.max[2], 0};
      },
      nullptr);
  rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* of) {
    const Aabb& box = (*static_cast<std::vector<Aabb>*>(of->geometryUserPtr))[of->primID];
    auto& [ray, hit] = *reinterpret_cast<RTCRayHit*>(of->rayhit);
    const float from[] = {ray.org_x, ray.org_y, ray.org_z};
    const float direction[] = {ray.dir_x, ray.dir_y, ray.dir_z};
    float enters = ray.tnear;
    float leaves = ray.tfar;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float a = (box.min[axis] - from[axis]) / direction[axis];
      const float b = (box.max[axis] - from[axis]) / direction[axis];
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    if (enters > leaves) return;
    ray.tfar = enters;
    hit.geomID = of->geomID;
    hit.primID = of->primID;
  });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  all.push_back({"rays, closest", "Embree", [=, scene = scene, kept = kept](const Batch& batch) {
                   std::size_t found = 0;
                   for (const bp::Cast& cast : batch.rays) {
                     RTCRayHit rayhit{};
                     rayhit.ray.org_x = cast.box.min[0];
                     rayhit.ray.org_y = cast.box.min[1];
                     rayhit.ray.org_z = cast.box.min[2];
                     rayhit.ray.dir_x = cast.direction[0];
                     rayhit.ray.dir_y = cast.direction[1];
                     rayhit.ray.dir_z = cast.direction[2];
                     rayhit.ray.tfar = 1;
                     rayhit.ray.mask = ~0U;
                     rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                     intersect(scene.get(), rayhit);
                     found += rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
                   }
                   return static_cast<double>(found);
                 }});
}
#endif

double quantile10(std::vector<double>& values) {
  std::ranges::sort(values);
  return values[values.size() / 10];
}

double nanosecondsOf(const std::function<void()>& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

void measureQueries(std::size_t bodies, int rounds) {
  constexpr std::size_t kQueries = 1000;
  const std::vector<Aabb> boxes = inputs::uniform(bodies, 0, 1);
  std::vector<Contestant> all;
  addLibrary(boxes, all);
  addBullet(boxes, all);
#if BROADMARK_BOOST
  addBoost(boxes, all);
#endif
#if BROADMARK_EMBREE
  addEmbree(boxes, all);
#endif
  for (int round = 0; round < rounds + 2; ++round) {
    const Batch batch = batchIn(bodies, kQueries, 1000 + static_cast<std::uint64_t>(round));
    for (Contestant& contestant : all) {
      double found = 0;
      const double ns = nanosecondsOf([&] { found = contestant.answer(batch); });
      if (round >= 2) contestant.nanoseconds.push_back(ns / kQueries);
      const double right =
          std::ranges::find(all, contestant.kind, &Contestant::kind)->answer(batch);
      if (std::abs(found - right) > 1e-3 * right) {  // floats round differently
        fmt::print("{} of {}: found {:g}, not {:g}\n", contestant.kind, contestant.name, found,
                   right);
      }
    }
  }
  double ours = 0;
  for (const char* kind : {"boxes", "rays, all hits", "rays, closest", "8 nearest"}) {
    fmt::print("{} bodies, {}:", bodies, kind);
    for (Contestant& contestant : all) {
      if (contestant.kind != kind) continue;
      const double ns = quantile10(contestant.nanoseconds);
      if (contestant.name == "broadmark") ours = ns;
      fmt::print("  {} {:.0f} ns", contestant.name, ns);
      if (contestant.name != "broadmark") fmt::print(" ({:.2f})", ns / ours);
    }
    fmt::print("\n");
  }
}

/// What the tree costs: built, and refitted when some bodies have moved by up to a tenth of an
/// edge.
void measureTree(std::size_t bodies, int rounds) {
  std::vector<Aabb> boxes = inputs::uniform(bodies, 0, 1);
  const bp::Boxes view(boxes[0].min.data(), boxes[0].max.data(), bodies, sizeof(Aabb));
  bp::QueryResults<std::uint32_t> none;
  std::vector<double> builds;
  for (int round = 0; round < std::min(rounds, 11); ++round) {
    bp::BroadPhase object;
    object.update(view);
    builds.push_back(nanosecondsOf([&] { object.overlapping({}, none); }));
  }
  fmt::print("{} bodies, tree: built in {:.0f} us", bodies, quantile10(builds) / 1000);
  inputs::Random random(2, 0);
  for (const double moving : {0.01, 0.1, 1.0}) {
    bp::BroadPhase object;
    std::vector<double> refits;
    const auto movers = static_cast<std::size_t>(moving * static_cast<double>(bodies));
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < movers; ++i) {
        Aabb& box =
            boxes[movers == bodies
                      ? i
                      : static_cast<std::size_t>(random.integer(0, static_cast<int>(bodies) - 1))];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const float step = random.uniform(-0.1F, 0.1F);
          box.min[axis] += step;
          box.max[axis] += step;
        }
      }
      object.update(view);
      refits.push_back(nanosecondsOf([&] { object.overlapping({}, none); }));
    }
    double sum = 0;
    for (const double ns : refits) sum += ns;
    const double mean = (sum - refits[0]) / static_cast<double>(refits.size() - 1);
    fmt::print("; {:g} % move: {:.1f} us, mean {:.1f}", 100 * moving, quantile10(refits) / 1000,
               mean / 1000);
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const int rounds = argc > 1 ? std::max(2, std::atoi(argv[1])) : 101;
  std::vector<std::size_t> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(static_cast<std::size_t>(std::atoi(argv[i])));
  if (sizes.empty()) sizes = {1000, 10'000, 100'000};
  for (const std::size_t bodies : sizes) {
    measureQueries(bodies, rounds);
    measureTree(bodies, rounds);
  }
}
