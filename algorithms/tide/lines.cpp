// Coming into cells and leaving them.

#include "tide/lines.h"

#include <utility>

namespace broadmark::tide {

void Lines::clear(std::uint32_t cells) {
  cells_ = cells;
  lines_.resize(cells);
  std::ranges::fill(lines_, Line());
  free_lines_.clear();
}

void Lines::makeRoom(std::size_t bodies) {
  const std::size_t lines = lines_.size();
  lines_.resize(lines + bodies);  // at most one line for each
  lines_.resize(lines);
}

std::uint32_t Lines::newLine() {
  if (free_lines_.empty()) {
    const auto line = static_cast<std::uint32_t>(lines_.size());
    lines_.resize(lines_.size() + 1);
    return line;
  }
  const std::uint32_t line = free_lines_.back();
  free_lines_.pop_back();
  return line;
}

/// Where a body lies that is in this line or one behind it.
Lines::Place Lines::find(std::uint32_t line, std::uint32_t body) {
  for (;; line = lines_[line].next) {
    const std::uint32_t place = lines_[line].placeOf(body);
    if (place < Line::kPlaces) return {&lines_[line], place};
  }
}

/// In a cell whose own line is full. Lines behind it are full, too: what comes and goes does so in
/// its own.
Lines::Place Lines::newPlace(std::uint32_t cell) {
  const std::uint32_t behind = newLine();
  lines_[behind] = std::exchange(lines_[cell], Line());
  lines_[cell].next = behind;
  return {&lines_[cell], 0};
}

void Lines::remove(std::uint32_t cell, std::uint32_t body) {
  const Place hole = find(cell, body);
  Line& own = lines_[cell];
  const std::uint32_t last = own.count() - 1;
  hole.line->bodies[hole.place] = own.bodies[last];
  hole.line->bounds[hole.place] = own.bounds[last];
  own.bounds[last] = kNobody;
  own.bodies[last] = kNowhere;
  if (own.next != kNowhere && last == 0) {
    free_lines_.push_back(own.next);
    own = lines_[own.next];
  }
}

std::string Lines::validate(std::size_t bodies) const {
  std::size_t in_cells = 0;
  std::size_t lines = free_lines_.size();
  for (std::uint32_t cell = 0; cell < cells_; ++cell) {
    if (lines_[cell].count() == 0 && lines_[cell].next != kNowhere) {
      return "an empty line before a full one";
    }
    for (std::uint32_t line = cell; line != kNowhere; line = lines_[line].next) {
      if (line != cell && lines_[line].count() < Line::kPlaces) {
        return "a line behind a cell's own is not full";
      }
      in_cells += lines_[line].count();
      ++lines;
    }
  }
  if (in_cells != bodies) return "a cell holds somebody else";
  return lines == lines_.size() ? std::string() : "lines are lost";
}

}  // namespace broadmark::tide
