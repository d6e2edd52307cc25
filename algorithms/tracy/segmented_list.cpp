#include "tracy/segmented_list.h"

#include <algorithm>
#include <utility>

namespace broadmark::tracy {

namespace {

/// Approximate maximum number of chunks: an open set has a bit per slot, so the memory of more sets
/// would be superlinear.
constexpr std::uint32_t kMaxFullChunks = 64;

}  // namespace

void SegmentedList::clear(std::uint32_t capacity) {
  const std::uint32_t endpoints = 2 * capacity;
  if (capacity > capacity_) {
    capacity_ = capacity;
    chunk_size_ = std::max(kChunkSize, endpoints / kMaxFullChunks);
    // Two adjacent chunks are more than half a chunk together.
    const std::uint32_t max_chunks = 2 * (endpoints / (chunk_size_ / 2 + 1)) + 2;
    chunks_.resize(max_chunks);
    unused_.reserve(max_chunks);
    endpoints_ = std::make_unique_for_overwrite<Endpoint[]>(std::size_t{max_chunks} * chunk_size_);
    chunk_of_.resize(endpoints);
    if (tracks_open_) {
      open_words_ = capacity / kWordBits;
      open_.assign(std::size_t{max_chunks} * open_words_, 0);
    }
  }
  unused_.clear();
  for (auto id = static_cast<ChunkId>(chunks_.size()); id > 0; --id) {
    unused_.push_back(static_cast<ChunkId>(id - 1));
  }
  first_ = kNone;
}

void SegmentedList::build(std::span<const Endpoint> sorted, std::uint32_t capacity) {
  clear(capacity);
  first_ = addChunkAfter(kNone);
  if (tracks_open_) std::fill_n(open(first_), open_words_, 0);
  // Leave room, or the next insertions would split every chunk.
  const std::size_t fill = std::size_t{chunk_size_} / 4 * 3;
  ChunkId id = first_;
  for (std::size_t begun = 0; begun < sorted.size(); begun += fill) {
    if (begun > 0) {
      const ChunkId next = addChunkAfter(id);
      if (tracks_open_) advanceOpen(id, next);
      id = next;
    }
    for (const Endpoint endpoint : sorted.subspan(begun, std::min(fill, sorted.size() - begun))) {
      begin(id)[chunks_[id].count++] = endpoint;
      setChunk(id, endpoint);
    }
  }
}

SegmentedList::ChunkId SegmentedList::addChunkAfter(ChunkId previous) {
  const ChunkId id = unused_.back();
  unused_.pop_back();
  chunks_[id] = {.previous = previous, .next = kNone, .count = 0};
  if (previous != kNone) {
    chunks_[id].next = std::exchange(chunks_[previous].next, id);
    if (chunks_[id].next != kNone) chunks_[chunks_[id].next].previous = id;
  }
  return id;
}

/// Derives the open set of `to` from the chunk before it, `from`.
void SegmentedList::advanceOpen(ChunkId from, ChunkId to) {
  std::copy_n(open(from), open_words_, open(to));
  for (const Endpoint endpoint : contents(from)) setOpen(to, endpoint.slot(), !endpoint.isEnd());
}

/// In all chunks with a start between the two endpoints.
void SegmentedList::setOpenBetween(Endpoint start, Endpoint end, bool is_open) {
  if (!tracks_open_) return;
  for (ChunkId id = chunkOf(start); id != chunkOf(end);) {
    id = chunks_[id].next;
    setOpen(id, start.slot(), is_open);
  }
}

void SegmentedList::insert(Endpoint start, Endpoint end) {
  // The end first, so that a split in between does not find the interval open.
  insert(end, first_);
  insert(start, chunkOf(end));
  setOpenBetween(start, end, true);
}

void SegmentedList::insert(Endpoint endpoint, ChunkId near) {
  ChunkId id = near;
  while (chunks_[id].previous != kNone && endpoint < front(id)) id = chunks_[id].previous;
  const auto advance = [&] {
    while (chunks_[id].next != kNone && front(chunks_[id].next) < endpoint) id = chunks_[id].next;
  };
  advance();
  if (chunks_[id].count == chunk_size_) {
    split(id);
    advance();
  }
  Endpoint* const position = lowerBound(id, endpoint);
  std::copy_backward(position, end(id), end(id) + 1);
  *position = endpoint;
  ++chunks_[id].count;
  setChunk(id, endpoint);
}

void SegmentedList::split(ChunkId left) {
  const ChunkId right = addChunkAfter(left);
  const std::uint32_t kept = chunk_size_ / 2;
  std::copy(begin(left) + kept, end(left), begin(right));
  chunks_[right].count = chunks_[left].count - kept;
  chunks_[left].count = kept;
  for (const Endpoint endpoint : contents(right)) setChunk(right, endpoint);
  if (tracks_open_) advanceOpen(left, right);
}

void SegmentedList::remove(Endpoint start, Endpoint end) {
  setOpenBetween(start, end, false);
  remove(start);
  remove(end);
}

void SegmentedList::remove(Endpoint endpoint) {
  const ChunkId id = chunkOf(endpoint);
  Endpoint* const position = lowerBound(id, endpoint);
  std::copy(position + 1, end(id), position);
  --chunks_[id].count;
  const ChunkId previous = chunks_[id].previous;
  mergeIfSmall(id, chunks_[id].next);
  mergeIfSmall(previous, id);
}

/// The open set of the left chunk remains valid.
void SegmentedList::mergeIfSmall(ChunkId left, ChunkId right) {
  if (left == kNone || right == kNone) return;
  const std::uint32_t left_count = chunks_[left].count;
  const std::uint32_t right_count = chunks_[right].count;
  const bool is_empty = left_count == 0 || right_count == 0;
  if (!is_empty && left_count + right_count > chunk_size_ / 2) return;
  for (const Endpoint endpoint : contents(right)) setChunk(left, endpoint);
  std::copy(begin(right), end(right), end(left));
  chunks_[left].count += right_count;
  chunks_[left].next = chunks_[right].next;
  if (chunks_[left].next != kNone) chunks_[chunks_[left].next].previous = left;
  unused_.push_back(right);
}

bool SegmentedList::isNear(Endpoint from, Endpoint to) const {
  const Chunk& chunk = chunks_[chunkOf(from)];
  if (to < from) return chunk.previous == kNone || front(chunk.previous) < to;
  return chunk.next == kNone || to < contents(chunk.next).back();
}

std::vector<Endpoint> SegmentedList::endpoints() const {
  std::vector<Endpoint> result;
  forEachChunk([&](std::span<const Endpoint> chunk) {
    result.insert(result.end(), chunk.begin(), chunk.end());
  });
  return result;
}

std::string SegmentedList::validate() const {
  std::vector<Word> is_open(open_words_, 0);
  std::size_t chunks = 0;
  ChunkId previous = kNone;
  Endpoint last;
  for (ChunkId id = first_; id != kNone; previous = id, id = chunks_[id].next) {
    if (++chunks > chunks_.size()) return "the chunks form a cycle";
    if (chunks_[id].previous != previous) return "a chunk has a wrong predecessor";
    const std::span<const Endpoint> endpoints = contents(id);
    if (endpoints.size() > chunk_size_) return "a chunk is too full";
    if (previous != kNone && endpoints.size() + contents(previous).size() <= chunk_size_ / 2) {
      return "two small chunks are not merged";
    }
    if (endpoints.empty() && (previous != kNone || chunks_[id].next != kNone)) {
      return "a chunk is empty";
    }
    if (tracks_open_ && !std::equal(is_open.begin(), is_open.end(), open(id))) {
      return "an open set is wrong";
    }
    for (const Endpoint endpoint : endpoints) {
      if ((id != first_ || &endpoint != endpoints.data()) && !(last < endpoint)) {
        return "the endpoints are not sorted";
      }
      last = endpoint;
      if (chunkOf(endpoint) != id) return "an endpoint is recorded in another chunk";
      if (tracks_open_) {
        is_open[endpoint.slot() / kWordBits] ^= Word{1} << endpoint.slot() % kWordBits;
      }
    }
  }
  if (std::ranges::any_of(is_open, [](Word word) { return word != 0; })) {
    return "an interval has no end";
  }
  if (chunks + unused_.size() != chunks_.size()) return "a chunk is lost";
  return {};
}

}  // namespace broadmark::tracy
