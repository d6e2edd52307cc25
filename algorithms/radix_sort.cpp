#include "radix_sort.h"

#include <utility>

namespace broadmark {

void RadixSorter::resize(std::size_t count, int workers) {
  entries_.resize(count);
  scattered_.resize(count);
  buckets_.resize(static_cast<std::size_t>(workers));
}

void RadixSorter::sort(ThreadTeam& team) {
  for (int shift = 0; shift < 32; shift += kDigitBits) {
    team.run([&](int worker) { count(worker, shift); });
    if (!placeBuckets()) continue;
    team.run([&](int worker) { scatter(worker, shift); });
    std::swap(entries_, scattered_);
  }
}

void RadixSorter::count(int worker, int shift) {
  Buckets& buckets = buckets_[static_cast<std::size_t>(worker)];
  buckets.fill(0);
  const auto [begin, end] = share(entries_.size(), static_cast<int>(buckets_.size()), worker);
  for (std::size_t i = begin; i < end; ++i) ++buckets[digit(entries_[i].key, shift)];
}

/// Turns counts into indices, by bucket and then by worker, which keeps the sort stable. False if
/// one bucket contains everything: then the order is unchanged.
bool RadixSorter::placeBuckets() {
  std::uint32_t place = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    const std::uint32_t bucket_begin = place;
    for (Buckets& buckets : buckets_) {
      place += std::exchange(buckets[bucket], place);
    }
    if (place - bucket_begin == entries_.size()) return false;
  }
  return true;
}

void RadixSorter::scatter(int worker, int shift) {
  Buckets& buckets = buckets_[static_cast<std::size_t>(worker)];
  const auto [begin, end] = share(entries_.size(), static_cast<int>(buckets_.size()), worker);
  for (std::size_t i = begin; i < end; ++i) {
    const SortEntry entry = entries_[i];
    scattered_[buckets[digit(entry.key, shift)]++] = entry;
  }
}

}  // namespace broadmark
