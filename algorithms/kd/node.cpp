#include "kd/node.h"

#include <utility>

namespace broadmark::kd {
namespace {

/// Minimum number of free pairs after reserve().
constexpr std::size_t kMinFreePairs = 16;

}  // namespace

Node* NodePool::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) grow();
  Node* const pair = free_.back();
  free_.pop_back();
  pair[0] = pair[1] = {};
  return pair;
}

void NodePool::release(Node* pair) {
  const std::lock_guard lock(mutex_);
  free_.push_back(pair);
}

void NodePool::releaseChildren(Node& node) {
  if (node.isLeaf()) return;
  releaseChildren(node.left());
  releaseChildren(node.right());
  release(std::exchange(node.children, nullptr));
}

void NodePool::grow() {
  free_.push_back(pairs_.emplace_back().data());
  // So that release() never allocates.
  if (free_.capacity() < pairs_.size()) free_.reserve(2 * pairs_.size());
}

void NodePool::reserve() {
  if (free_.size() >= kMinFreePairs + pairs_.size() / 8) return;
  while (free_.size() < 2 * kMinFreePairs + pairs_.size() / 4) grow();
}

}  // namespace broadmark::kd
