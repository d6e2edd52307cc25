// How a worker that moves bodies tells the cells about it, whichever worker they belong to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace broadmark::tracy {

/// Lists of bodies, one per cell, in one array.
class BodiesByCell {
 public:
  void resize(std::size_t cells) {
    latest_.assign(cells, kNone);
    clear();
  }
  /// When all cells have been forgotten.
  void clear() { entries_.clear(); }

  void add(std::size_t cell, std::uint32_t body) {
    const auto entry = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({body, std::exchange(latest_[cell], entry)});
  }
  /// Calls visit(body), the last one first.
  template <class Visit>
  void forEach(std::size_t cell, Visit visit) const {
    for (std::uint32_t i = latest_[cell]; i != kNone; i = entries_[i].next) visit(entries_[i].body);
  }
  void forget(std::size_t cell) { latest_[cell] = kNone; }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Entry {
    std::uint32_t body;
    std::uint32_t next;  ///< of those in the same cell
  };

  std::vector<std::uint32_t> latest_;  ///< by cell
  std::vector<Entry> entries_;
};

/// One worker's messages to all cells: that something in there has moved, who, if that is worth
/// telling, and who enters.
class Mailbox {
 public:
  void resize(std::size_t cells) {
    concerned_.assign(cells, 0);
    moved_.resize(cells);
    arrivals_.resize(cells);
    cells_.reserve(cells);
    cells_.clear();
  }
  /// Before the first message of a frame, when all have been read.
  void clear() {
    cells_.clear();
    moved_.clear();
    arrivals_.clear();
  }

  /// Some body of this cell has moved.
  void notify(std::size_t cell) {
    if (std::exchange(concerned_[cell], std::uint8_t{1}) == 0) {
      cells_.push_back(static_cast<std::uint32_t>(cell));
    }
  }
  /// This body of this cell has moved.
  void notify(std::size_t cell, std::uint32_t body) {
    notify(cell);
    moved_.add(cell, body);
  }
  /// A body enters this cell.
  void announce(std::size_t cell, std::uint32_t body) {
    notify(cell);
    arrivals_.add(cell, body);
  }

  [[nodiscard]] bool concerns(std::size_t cell) const { return concerned_[cell] != 0; }
  /// The cells that have messages, each once.
  [[nodiscard]] const std::vector<std::uint32_t>& cells() const { return cells_; }
  [[nodiscard]] const BodiesByCell& moved() const { return moved_; }
  [[nodiscard]] const BodiesByCell& arrivals() const { return arrivals_; }
  /// Forgets the messages to this cell. Workers may do so for different cells at the same time.
  void forget(std::size_t cell) {
    concerned_[cell] = 0;
    moved_.forget(cell);
    arrivals_.forget(cell);
  }

 private:
  /// By cell; bytes, as workers write to neighbours at the same time.
  std::vector<std::uint8_t> concerned_;
  std::vector<std::uint32_t> cells_;  ///< that are concerned
  BodiesByCell moved_;
  BodiesByCell arrivals_;
};

}  // namespace broadmark::tracy
