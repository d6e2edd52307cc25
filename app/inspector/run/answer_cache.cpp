#include "inspector/run/answer_cache.h"

#include <iterator>

namespace broadmark {
namespace {

/// Maps integers of small magnitude to small unsigned integers, as Protocol Buffers do.
std::uint64_t zigZagEncode(std::int64_t number) {
  return (static_cast<std::uint64_t>(number) << 1) ^ static_cast<std::uint64_t>(number >> 63);
}

std::int64_t zigZagDecode(std::uint64_t number) {
  return static_cast<std::int64_t>(number >> 1) ^ -static_cast<std::int64_t>(number & 1);
}

/// Seven bits per byte; the eighth is set if more bytes follow.
void writeVarint(std::vector<std::uint8_t>& bytes, std::int64_t number) {
  std::uint64_t bits = zigZagEncode(number);
  for (; bits >= 0x80; bits >>= 7) bytes.push_back(static_cast<std::uint8_t>(bits | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(bits));
}

std::int64_t readVarint(const std::uint8_t*& position) {
  std::uint64_t number = 0;
  for (int shift = 0;; shift += 7) {
    const std::uint8_t byte = *position++;
    number |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return zigZagDecode(number);
  }
}

std::size_t bytesOf(const std::vector<Pair>& pairs) { return pairs.capacity() * sizeof(Pair); }

/// Estimated size of an answer without its pairs.
std::size_t overheadBytes(const CachedAnswer& answer) {
  constexpr std::size_t kPerCounter = 100;
  std::size_t bytes = 500 + answer.counters.size() * kPerCounter;
  if (const auto& difference = answer.difference) {
    bytes += bytesOf(difference->missed_pairs) + bytesOf(difference->false_pairs) +
             bytesOf(difference->allowed_extra_pairs) + bytesOf(difference->invalid_pairs);
  }
  return bytes;
}

}  // namespace

PackedPairs::PackedPairs(std::span<const Pair> pairs) : count_(pairs.size()) {
  constexpr std::size_t kTypicalBytesPerPair = 4;
  bytes_.reserve(kTypicalBytesPerPair * pairs.size());
  std::int64_t previous = 0;
  for (const Pair pair : pairs) {
    writeVarint(bytes_, pair.a - previous);
    writeVarint(bytes_, std::int64_t{pair.b} - pair.a);
    previous = pair.a;
  }
  bytes_.shrink_to_fit();
}

std::vector<Pair> PackedPairs::unpacked() const {
  std::vector<Pair> pairs(count_);
  const std::uint8_t* position = bytes_.data();
  std::int64_t previous = 0;
  for (Pair& pair : pairs) {
    previous += readVarint(position);
    pair.a = static_cast<std::uint32_t>(previous);
    pair.b = static_cast<std::uint32_t>(previous + readVarint(position));
  }
  return pairs;
}

void AnswerCache::insert(int track, std::uint32_t frame, const CachedAnswer& answer) {
  const Key key{track, frame};
  if (const auto found = index_.find(key); found != index_.end()) evict(found->second);
  Entry entry{
      .key = key,
      .pairs = PackedPairs(answer.pairs),
      .oracle_pairs = PackedPairs(answer.oracle_pairs),
      .metadata = {
          .checked = answer.checked, .difference = answer.difference, .counters = answer.counters}};
  entry.bytes = entry.pairs.bytes() + entry.oracle_pairs.bytes() + overheadBytes(entry.metadata);
  if (entry.bytes > budget_bytes_) return;
  while (bytes_ + entry.bytes > budget_bytes_) evict(entries_.begin());
  bytes_ += entry.bytes;
  entries_.push_back(std::move(entry));
  index_[key] = std::prev(entries_.end());
}

std::optional<CachedAnswer> AnswerCache::find(int track, std::uint32_t frame) const {
  const auto found = index_.find({track, frame});
  if (found == index_.end()) return {};
  CachedAnswer answer = found->second->metadata;
  answer.pairs = found->second->pairs.unpacked();
  answer.oracle_pairs = found->second->oracle_pairs.unpacked();
  return answer;
}

bool AnswerCache::contains(int track, std::uint32_t frame, bool checked) const {
  const auto found = index_.find({track, frame});
  return found != index_.end() && (!checked || found->second->metadata.checked);
}

void AnswerCache::erase(int track) {
  auto at = index_.lower_bound({track, 0});
  while (at != index_.end() && at->first.first == track) evict((at++)->second);
}

void AnswerCache::clear() {
  entries_.clear();
  index_.clear();
  bytes_ = 0;
}

void AnswerCache::evict(Iterator entry) {
  bytes_ -= entry->bytes;
  index_.erase(entry->key);
  entries_.erase(entry);
}

}  // namespace broadmark
