// What the second view shows, worked out on the run thread after what the first one shows.
//
// Of the open footage in the same frame the lanes have the answer already. For another frame, or
// another recording, the algorithm has an instance of its own here, whose times nobody takes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/pair.h"
#include "inspector/run/draw_gate.h"
#include "inspector/run/snapshot.h"

namespace broadmark {

struct SecondWish {
  std::shared_ptr<const FootageRequest> footage;  ///< null: that of the first view
  std::optional<std::uint32_t> frame;             ///< nothing: that of the first view
  int lane = 0;                                   ///< whose answer, by number; 0: the oracle's

  friend bool operator==(const SecondWish&, const SecondWish&) = default;
};

class SecondRun {
 public:
  /// What the first view is about; borrowed.
  struct First {
    const std::shared_ptr<const FootageRequest>& request;
    Footage& footage;
    std::uint32_t frame = 0;
    const std::vector<std::unique_ptr<Lane>>& lanes;
    bool check = true;
    bool structure = false;
    std::span<const std::uint32_t> tracked;
  };

  /// `unwanted`: whether to give up what a lane of this spec is at.
  SecondRun(HostMaker make_host, std::function<bool(const LaneSpec&)> unwanted)
      : make_host_(std::move(make_host)), unwanted_(std::move(unwanted)) {}

  /// Does one piece of work; false when there is none left. Throws Cancelled.
  bool advance(const SecondWish& wish, const First& first, DrawGate& gate);
  /// What is to be seen once nothing is left to be done. Null: nothing can be, or a lane was lost.
  std::shared_ptr<const Snapshot> take(const SecondWish& wish, const First& first);
  /// Why nothing can be seen; "": all is well.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// What it is at, in words.
  [[nodiscard]] const std::string& doing() const { return doing_; }
  /// Forgets everything.
  void clear();

  /// The frame that is wanted of the first view's footage; 0 of another one's.
  static std::uint32_t frameOfFirst(const SecondWish& wish, const SceneInfo& scene);

 private:
  void open(const std::shared_ptr<const FootageRequest>& request);
  [[nodiscard]] Footage* footage(const First& first);
  [[nodiscard]] std::uint32_t frame(const SecondWish& wish, const First& first);
  /// The lane that has the answer, or is to have it; null: the oracle.
  Lane* lane(const SecondWish& wish, const First& first);

  const HostMaker make_host_;
  const std::function<bool(const LaneSpec&)> unwanted_;
  std::shared_ptr<const FootageRequest> opened_;  ///< null: that of the first view
  std::unique_ptr<Footage> footage_;              ///< of opened_
  std::unique_ptr<Lane> lane_;                    ///< the instance of its own, if one is needed
  Oracle oracle_{std::size_t{256} << 20};
  std::string failure_;
  std::string doing_;
};

struct PairComparison {
  std::vector<Pair> first_only;   ///< ascending
  std::vector<Pair> second_only;  ///< likewise
  std::uint64_t both = 0;
};

/// Of pairs in any order; what an answer holds twice counts once. O(n log n).
PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second);

}  // namespace broadmark
