// Queries of the broad-phase library beside those of other libraries' trees, on the same boxes: one
// thread, nanoseconds a query. Contestants alternate, batch by batch.
//
//   query_ratios [ROUNDS [BODIES...]]

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

#include "benchmarks/library_benchmark.h"
#include "broadmark/broadphase.hpp"
#include "broadmark/statistics/statistics.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

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
  object->update(viewOf(boxes));
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
    const float enters = entryOf(box, from, direction, ray.tnear, ray.tfar);
    if (enters > ray.tfar) return;
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

double quickest(const std::vector<double>& values) { return quantile(values, 0.1); }

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
    for (const Contestant& contestant : all) {
      if (contestant.kind != kind) continue;
      const double ns = quickest(contestant.nanoseconds);
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
  const bp::Boxes view = viewOf(boxes);
  bp::QueryResults<std::uint32_t> none;
  std::vector<double> builds;
  for (int round = 0; round < std::min(rounds, 11); ++round) {
    bp::BroadPhase object;
    object.update(view);
    builds.push_back(nanosecondsOf([&] { object.overlapping({}, none); }));
  }
  fmt::print("{} bodies, tree: built in {:.0f} us", bodies, quickest(builds) / 1000);
  inputs::Random random(2, 0);
  for (const double moving : {0.01, 0.1, 1.0}) {
    bp::BroadPhase object;
    std::vector<double> refits;
    for (int round = 0; round < rounds; ++round) {
      moveShare(boxes, moving, random);
      object.update(view);
      refits.push_back(nanosecondsOf([&] { object.overlapping({}, none); }));
    }
    double sum = 0;
    for (const double ns : refits) sum += ns;
    const double mean = (sum - refits[0]) / static_cast<double>(refits.size() - 1);
    fmt::print("; {:g} % move: {:.1f} us, mean {:.1f}", 100 * moving, quickest(refits) / 1000,
               mean / 1000);
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const LibraryArguments arguments(argc, argv, 2, {1000, 10'000, 100'000});
  for (const std::size_t bodies : arguments.sizes) {
    measureQueries(bodies, arguments.rounds);
    measureTree(bodies, arguments.rounds);
  }
}
