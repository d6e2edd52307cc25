#include "inspector/run/answer_cache.h"

#include <iterator>

namespace broadmark {
namespace {

/// Small numbers of either sign become small ones without.
std::uint64_t folded(std::int64_t number) {
  return (static_cast<std::uint64_t>(number) << 1) ^ static_cast<std::uint64_t>(number >> 63);
}

std::int64_t unfolded(std::uint64_t number) {
  return static_cast<std::int64_t>(number >> 1) ^ -static_cast<std::int64_t>(number & 1);
}

/// Seven bits a byte; the eighth says that more follow.
void put(std::vector<std::uint8_t>& bytes, std::int64_t number) {
  std::uint64_t rest = folded(number);
  for (; rest >= 0x80; rest >>= 7) bytes.push_back(static_cast<std::uint8_t>(rest | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(rest));
}

std::int64_t take(const std::uint8_t*& at) {
  std::uint64_t number = 0;
  for (int shift = 0;; shift += 7) {
    const std::uint8_t byte = *at++;
    number |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return unfolded(number);
  }
}

std::size_t bytesOf(const std::vector<Pair>& pairs) { return pairs.capacity() * sizeof(Pair); }

/// Roughly: what stands beside the pairs.
std::size_t bytesBeside(const CachedAnswer& answer) {
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
  constexpr std::size_t kUsual = 4;  // bytes a pair
  bytes_.reserve(kUsual * pairs.size());
  std::int64_t before = 0;
  for (const Pair pair : pairs) {
    put(bytes_, pair.a - before);
    put(bytes_, std::int64_t{pair.b} - pair.a);
    before = pair.a;
  }
  bytes_.shrink_to_fit();
}

std::vector<Pair> PackedPairs::unpacked() const {
  std::vector<Pair> pairs(count_);
  const std::uint8_t* at = bytes_.data();
  std::int64_t before = 0;
  for (Pair& pair : pairs) {
    before += take(at);
    pair.a = static_cast<std::uint32_t>(before);
    pair.b = static_cast<std::uint32_t>(before + take(at));
  }
  return pairs;
}

void AnswerCache::remember(int track, std::uint32_t frame, const CachedAnswer& answer) {
  const Key key{track, frame};
  if (const auto found = entries_.find(key); found != entries_.end()) drop(found->second);
  Kept kept{
      .key = key,
      .pairs = PackedPairs(answer.pairs),
      .right = PackedPairs(answer.right),
      .rest = {
          .judged = answer.judged, .difference = answer.difference, .counters = answer.counters}};
  kept.bytes = kept.pairs.bytes() + kept.right.bytes() + bytesBeside(kept.rest);
  if (kept.bytes > budget_bytes_) return;
  while (bytes_ + kept.bytes > budget_bytes_) drop(kept_.begin());
  bytes_ += kept.bytes;
  kept_.push_back(std::move(kept));
  entries_[key] = std::prev(kept_.end());
}

std::optional<CachedAnswer> AnswerCache::recall(int track, std::uint32_t frame) const {
  const auto found = entries_.find({track, frame});
  if (found == entries_.end()) return {};
  CachedAnswer answer = found->second->rest;
  answer.pairs = found->second->pairs.unpacked();
  answer.right = found->second->right.unpacked();
  return answer;
}

bool AnswerCache::holds(int track, std::uint32_t frame, bool judged) const {
  const auto found = entries_.find({track, frame});
  return found != entries_.end() && (!judged || found->second->rest.judged);
}

void AnswerCache::forget(int track) {
  auto at = entries_.lower_bound({track, 0});
  while (at != entries_.end() && at->first.first == track) drop((at++)->second);
}

void AnswerCache::clear() {
  kept_.clear();
  entries_.clear();
  bytes_ = 0;
}

void AnswerCache::drop(Entry entry) {
  bytes_ -= entry->bytes;
  entries_.erase(entry->key);
  kept_.erase(entry);
}

}  // namespace broadmark
