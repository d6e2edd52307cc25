// How a worker that moves bodies tells the cells about it, whichever worker they belong to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace broadmark::tracy {

/// One worker's messages to all cells: who enters, and that something has moved.
class Mailbox {
 public:
  void resize(std::size_t cells) {
    concerned_.assign(cells, 0);
    latest_.assign(cells, kNone);
    arrivals_.clear();
  }
  /// Before the first message of a frame, when all have been read.
  void clear() { arrivals_.clear(); }

  /// A body of this cell has moved.
  void notify(std::size_t cell) { concerned_[cell] = 1; }
  /// A body enters this cell.
  void announce(std::size_t cell, std::uint32_t body) {
    notify(cell);
    const auto message = static_cast<std::uint32_t>(arrivals_.size());
    arrivals_.push_back({body, std::exchange(latest_[cell], message)});
  }

  [[nodiscard]] bool concerns(std::size_t cell) const { return concerned_[cell] != 0; }
  /// Calls visit(body) for those that enter the cell.
  template <class Visit>
  void read(std::size_t cell, Visit visit) const {
    for (std::uint32_t i = latest_[cell]; i != kNone; i = arrivals_[i].next) {
      visit(arrivals_[i].body);
    }
  }
  /// Forgets the messages to this cell. Workers may do so for different cells at the same time.
  void forget(std::size_t cell) {
    concerned_[cell] = 0;
    latest_[cell] = kNone;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Arrival {
    std::uint32_t body;
    std::uint32_t next;  ///< of those to the same cell
  };

  std::vector<std::uint8_t>
      concerned_;  ///< by cell; bytes, as workers write to neighbours at the same time
  std::vector<std::uint32_t> latest_;  ///< by cell
  std::vector<Arrival> arrivals_;
};

}  // namespace broadmark::tracy
