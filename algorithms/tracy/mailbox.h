// Messages from the workers that move bodies to the cells, which may belong to other workers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace broadmark::tracy {

/// A linked list of bodies per cell, in a shared array.
class BodiesByCell {
 public:
  void resize(std::size_t cells) {
    latest_.assign(cells, kNone);
    clear();
  }
  /// All lists must have been erased.
  void clear() { entries_.clear(); }

  void add(std::size_t cell, std::uint32_t body) {
    const auto entry = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({body, std::exchange(latest_[cell], entry)});
  }
  /// Calls visit(body) in reverse order of insertion.
  template <class Visit>
  void forEach(std::size_t cell, Visit visit) const {
    for (std::uint32_t i = latest_[cell]; i != kNone; i = entries_[i].next) visit(entries_[i].body);
  }
  void erase(std::size_t cell) { latest_[cell] = kNone; }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Entry {
    std::uint32_t body;
    std::uint32_t next;  ///< in the same cell
  };

  std::vector<std::uint32_t> latest_;  ///< by cell
  std::vector<Entry> entries_;
};

/// The messages of one worker to all cells: notifications of moves, the moved bodies (if few), and
/// the bodies that enter.
class Mailbox {
 public:
  void resize(std::size_t cells) {
    has_messages_.assign(cells, 0);
    moved_.resize(cells);
    arrivals_.resize(cells);
    cells_.reserve(cells);
    cells_.clear();
  }
  /// All messages must have been erased.
  void clear() {
    cells_.clear();
    moved_.clear();
    arrivals_.clear();
  }

  /// An unspecified body of the cell has moved.
  void notify(std::size_t cell) {
    if (std::exchange(has_messages_[cell], std::uint8_t{1}) == 0) {
      cells_.push_back(static_cast<std::uint32_t>(cell));
    }
  }
  void notify(std::size_t cell, std::uint32_t body) {
    notify(cell);
    moved_.add(cell, body);
  }
  void notifyArrival(std::size_t cell, std::uint32_t body) {
    notify(cell);
    arrivals_.add(cell, body);
  }

  [[nodiscard]] bool hasMessages(std::size_t cell) const { return has_messages_[cell] != 0; }
  /// The cells with messages, without duplicates.
  [[nodiscard]] const std::vector<std::uint32_t>& cells() const { return cells_; }
  [[nodiscard]] const BodiesByCell& moved() const { return moved_; }
  [[nodiscard]] const BodiesByCell& arrivals() const { return arrivals_; }
  /// Erases the messages to a cell. Thread-safe for different cells.
  void erase(std::size_t cell) {
    has_messages_[cell] = 0;
    moved_.erase(cell);
    arrivals_.erase(cell);
  }

 private:
  /// By cell; not bits, since workers write to neighbouring cells concurrently.
  std::vector<std::uint8_t> has_messages_;
  std::vector<std::uint32_t> cells_;  ///< with messages
  BodiesByCell moved_;
  BodiesByCell arrivals_;
};

}  // namespace broadmark::tracy
