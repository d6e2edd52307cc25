// Any calls of the broad-phase library, by any bytes: its answers and those to queries are right, a
// state is the same once restored, and what is refused changes nothing.

#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "broadphase/query_oracle.h"

namespace {

using namespace broadmark;
using namespace broadmark::tests;

void require(bool condition) {
  if (!condition) std::abort();
}

class Calls {
 public:
  Calls(const std::uint8_t* data, std::size_t size)
      : bytes_(data, size), options_(optionsOf(next())), object_(options_) {}

  void run() {
    while (!bytes_.empty()) call();
  }

 private:
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }

  static bp::Options optionsOf(std::uint8_t bits) {
    bp::Options options = allOptions()[bits % 8];
    options.changes = (bits & 8) != 0 ? bp::Changes::trusted : bp::Changes::verified;
    options.collides = LayerMatrix::all().set(0, 1, false).set(2, 2, false).rows();
    return options;
  }

  void call() {
    switch (next() % 9) {
      case 0:
        boxes_.resize(next() % 40, kEmptyBox);
        break;
      case 1:
        if (!boxes_.empty()) boxes_[next() % boxes_.size()] = kEmptyBox;
        break;
      case 2:
      case 3:
        if (!boxes_.empty()) boxes_[next() % boxes_.size()] = anyBox();
        break;
      case 4: {
        const std::uint32_t body = next() % 48U;
        groups_[body] = {.layer = static_cast<std::uint8_t>(next() % 3),
                         .tags = {next() % 4U, BodyGroups::kNoTag, BodyGroups::kNoTag}};
        object_.setFilter(body, {groups_[body].layer, groups_[body].tags});
        filters_set_ = true;
        break;
      }
      case 5:
        saveOrRestore();
        break;
      case 6:
        refuse();
        break;
      case 7:
        query();
        break;
      default:
        update();
    }
  }

  Aabb anyBox() {
    Vec box;
    for (float& x : box) x = static_cast<float>(next() % 32) / 4;
    return {{box[0], box[1], box[2], 0}, {box[0] + box[3], box[1] + box[4], box[2] + box[5], 0}};
  }
  using Vec = std::array<float, 6>;

  /// Lists the changed bodies, or not.
  void update() {
    const std::vector<bp::Box> given = publicBoxes(boxes_);
    if (next() % 2 == 0) {
      object_.update(given);
    } else {
      std::vector<std::uint32_t> changed;
      for (std::uint32_t body = 0; body < boxes_.size(); ++body) {
        if (body >= known_.size() || !sameBits(boxes_[body], known_[body])) changed.push_back(body);
      }
      object_.update(given, changed);
    }
    known_ = boxes_;
    known_groups_ = groups_;
    filters_set_ = false;
    PairList right = oracle();
    if (options_.answer == bp::Answer::events) {
      require(sortedList(object_.began()) == difference(right, right_));
      require(sortedList(object_.ended()) == difference(right_, right));
    } else {
      require(sortedList(object_.pairs()) == right);
    }
    right_ = std::move(right);
  }

  [[nodiscard]] PairList oracle() const {
    return bruteForcePairs(known_,
                           {known_groups_, LayerMatrix::all().set(0, 1, false).set(2, 2, false)});
  }

  /// About the last update, though other boxes and filters may have been prepared since.
  void query() {
    const auto coordinate = [&] { return static_cast<float>(next() % 64) / 4 - 4; };
    QueryBatches batches;
    for (unsigned i = next() % 4; i-- > 0;) {
      const std::vector<bp::Box> boxes = publicBoxes({anyBox(), anyBox()});
      const std::uint32_t layers = next();
      batches.boxes.push_back({boxes[0], layers});
      batches.casts.push_back({.box = boxes[1], .layers = layers});
      for (float& x : batches.casts.back().direction) x = coordinate();
      batches.points.push_back({{}, next(), coordinate() + 4, layers});
      for (float& x : batches.points.back().point) x = coordinate();
    }
    batches.run(object_);
    QueryOracle oracle{known_};
    for (const BodyGroups& groups : known_groups_) oracle.layers.push_back(groups.layer);
    require(batches.fault(oracle).empty());
  }

  void saveOrRestore() {
    if (filters_set_) update();
    if (next() % 2 == 0 || saved_.empty()) {
      object_.save(saved_);
      saved_boxes_ = known_;
      saved_groups_ = known_groups_;
      return;
    }
    object_.restore(saved_);
    std::vector<std::byte> again;
    object_.save(again);
    require(again.size() == saved_.size());
    require(options_.order == bp::Order::any || again == saved_);
    boxes_ = known_ = saved_boxes_;
    groups_ = known_groups_ = saved_groups_;
    right_ = oracle();
    if (options_.answer == bp::Answer::pairs) require(sortedList(object_.pairs()) == right_);
  }

  /// A spoilt state, or a bad box.
  void refuse() {
    try {
      if (next() % 2 == 0) {
        std::vector<std::byte> spoilt = saved_;
        if (!spoilt.empty()) spoilt[(256U * next() + next()) % spoilt.size()] ^= std::byte{next()};
        bp::BroadPhase other(options_);
        other.restore(spoilt);
        other.update(publicBoxes(boxes_));
        return;
      }
      std::vector<bp::Box> bad = publicBoxes(boxes_);
      bad.push_back({{0, 0, 0}, {1, std::numeric_limits<float>::quiet_NaN(), 1}});
      object_.update(bad);
      require(false);
    } catch (const std::invalid_argument&) {
    }
  }

  std::span<const std::uint8_t> bytes_;
  bp::Options options_;
  bp::BroadPhase object_;
  BoxList boxes_;
  BoxList known_;  ///< of the last update
  std::vector<BodyGroups> groups_ = std::vector<BodyGroups>(48);
  std::vector<BodyGroups> known_groups_ = groups_;
  bool filters_set_ = false;  ///< since the last update
  PairList right_;
  std::vector<std::byte> saved_;
  BoxList saved_boxes_;
  std::vector<BodyGroups> saved_groups_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Calls(data, size).run();
  return 0;
}
