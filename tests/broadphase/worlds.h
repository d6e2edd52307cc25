// What the tests of the broad-phase library share: its options, and the right answers.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "broadmark/broadphase.hpp"
#include "broadmark/execution.h"
#include "broadmark/reference_pairs.h"
#include "torture/changing.h"
#include "torture/inputs.h"

namespace broadmark::tests {

namespace bp = broadphase;

using BoxList = std::vector<Aabb>;
using PairList = std::vector<Pair>;

inline std::vector<inputs::Input> allInputs() {
  std::vector<inputs::Input> all(inputs::kAll.begin(), inputs::kAll.end());
  all.push_back({"limits", inputs::limits});
  return all;
}

inline std::vector<bp::Box> publicBoxes(const BoxList& boxes) {
  std::vector<bp::Box> result;
  for (const Aabb& box : boxes) {
    result.push_back({{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}});
  }
  return result;
}

inline PairList listOf(std::span<const bp::Pair> pairs) {
  PairList list;
  for (const auto [a, b] : pairs) list.push_back({a, b});
  return list;
}

inline PairList sortedList(std::span<const bp::Pair> pairs) {
  PairList list = listOf(pairs);
  std::ranges::sort(list);
  return list;
}

inline PairList oracle(const BoxList& boxes, const CollisionFilter& filter = {}) {
  return boxes.size() <= 1000 ? bruteForcePairs(boxes, filter) : sweptPairs(boxes, filter);
}

inline PairList difference(const PairList& from, const PairList& without) {
  PairList result;
  std::ranges::set_difference(from, without, std::back_inserter(result));
  return result;
}

/// The caller's job system, on one thread: the last job first.
inline void runBackwards(int jobs, const std::function<void(int)>& job) {
  for (int i = jobs; i-- > 0;) job(i);
}

/// All combinations of method, answer and order.
inline std::vector<bp::Options> allOptions() {
  std::vector<bp::Options> all;
  for (const bp::Method method : {bp::Method::tide, bp::Method::columns}) {
    for (const bp::Answer answer : {bp::Answer::pairs, bp::Answer::events}) {
      for (const bp::Order order : {bp::Order::sorted, bp::Order::any}) {
        bp::Options options;
        options.method = method;
        options.answer = answer;
        options.order = order;
        all.push_back(options);
      }
    }
  }
  return all;
}

inline std::vector<bp::InstructionSet> instructionSets() {
  constexpr std::pair<Isa, bp::InstructionSet> kSets[] = {
      {Isa::scalar, bp::InstructionSet::scalar}, {Isa::sse2, bp::InstructionSet::sse2},
      {Isa::neon, bp::InstructionSet::neon},     {Isa::simd128, bp::InstructionSet::simd128},
      {Isa::avx2, bp::InstructionSet::avx2},     {Isa::avx512, bp::InstructionSet::avx512},
  };
  std::vector<bp::InstructionSet> sets;
  for (const auto& [isa, set] : kSets) {
    if (isaSupported(isa)) sets.push_back(set);
  }
  return sets;
}

inline std::string describe(const bp::Options& options) {
  return std::string(options.method == bp::Method::tide ? "tide" : "columns") +
         (options.answer == bp::Answer::pairs ? " pairs" : " events") +
         (options.order == bp::Order::sorted ? " sorted" : "") + " isa " +
         std::to_string(static_cast<int>(options.instruction_set)) + " threads " +
         std::to_string(options.threads) + (options.parallel_for ? " jobs" : "");
}

/// The message of the exception that a call must throw.
template <class Error, class Call>
std::string messageOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no exception";
}

template <class Call>
std::string invalidArgument(Call call) {
  return messageOf<std::invalid_argument>(call);
}

/// Updates a broad phase, and knows what is right.
class CheckedBroadPhase {
 public:
  explicit CheckedBroadPhase(const bp::Options& options) : options_(options), object(options) {}

  /// Throws the name of what is wrong in the answer; "" otherwise.
  std::string update(const BoxList& boxes, const CollisionFilter& filter = {}) {
    object.update(publicBoxes(boxes));
    return faultOf(oracle(boxes, filter));
  }

  std::string faultOf(PairList right) {
    const PairList before = std::exchange(right_, std::move(right));
    if (options_.answer == bp::Answer::pairs) {
      return inOrder(object.pairs()) == right_ ? "" : "pairs";
    }
    if (inOrder(object.began()) != difference(right_, before)) return "began";
    return inOrder(object.ended()) == difference(before, right_) ? "" : "ended";
  }

 private:
  [[nodiscard]] PairList inOrder(std::span<const bp::Pair> pairs) const {
    return options_.order == bp::Order::sorted ? listOf(pairs) : sortedList(pairs);
  }

  bp::Options options_;
  PairList right_;

 public:
  bp::BroadPhase object;
};

}  // namespace broadmark::tests
