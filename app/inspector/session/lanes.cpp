#include "inspector/session/lanes.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "request/cases.h"

namespace broadmark {

LaneSpec LaneEdit::spec() const {
  const std::unique_ptr<BroadPhase> fresh = algorithm.create();
  return {.number = number,
          .run = makeCase(algorithm, isa, threads, device,
                          changedValues(parameterValues(*parameters), *fresh), answer)};
}

LaneEdit& Lanes::add(const std::string& algorithm_id) {
  LaneEdit& added = append(requireAlgorithm(algorithm_id, algorithms_));
  changed();
  return added;
}

LaneEdit& Lanes::add(const Case& run) {
  LaneEdit& added = append(run.algorithm);
  if (run.algorithm.traits.vectorised) added.isa = run.isa;
  if (run.algorithm.traits.parallel) added.threads = run.threads;
  added.device = run.device;
  added.answer = run.answer;
  setParameters(*added.parameters, run.parameters);
  changed();
  return added;
}

LaneEdit& Lanes::append(const Algorithm& algorithm) {
  list.push_back({.number = ++last_number_,
                  .algorithm = algorithm,
                  .parameters = algorithm.create(),
                  .threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()))});
  if (list.size() == 1) shown_ = list.back().number;
  return list.back();
}

void Lanes::remove(int number) {
  std::erase_if(list, [&](const LaneEdit& edit) { return edit.number == number; });
  if (shown_ == number) shown_ = list.empty() ? 0 : list.front().number;
  changed();
}

void Lanes::clear() {
  list.clear();
  shown_ = 0;
  changed();
}

void Lanes::changed() {
  specs_.clear();
  for (const LaneEdit& edit : list) specs_.push_back(edit.spec());
  on_change();
}

LaneEdit* Lanes::find(int number) {
  const auto found = std::ranges::find(list, number, &LaneEdit::number);
  return found == list.end() ? nullptr : &*found;
}

}  // namespace broadmark
