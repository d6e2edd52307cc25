// An algorithm that fails on purpose, to show that everything else continues. A plug-in, never part
// of the program. Otherwise it is correct brute force.

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "broadmark/plugin.h"
#include "broadmark/reference_pairs.h"

namespace broadmark::unruly {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

[[noreturn]] void crash() {
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);  // no core dump
  std::signal(SIGSEGV, SIG_DFL);    // sanitizers install a handler
  std::raise(SIGSEGV);
  std::abort();
}

/// Prints a line that tests wait for.
[[noreturn]] void hang() {
  std::puts("hanging on purpose");
  std::fflush(stdout);
  while (true) ::pause();
}

[[noreturn]] void allocateWithoutEnd() {
  std::vector<std::unique_ptr<char[]>> pieces;
  while (true) {
    pieces.push_back(std::make_unique_for_overwrite<char[]>(16 * kMebibyte));
    std::memset(pieces.back().get(), 1, 16 * kMebibyte);
  }
}

/// Grows like a leak, but is not one for leak detectors.
void retainMemory() {
  static std::vector<std::unique_ptr<char[]>> retained;
  retained.push_back(std::make_unique<char[]>(1000));
}

class Unruly final : public BoxBroadPhase {
 public:
  ~Unruly() override {
    if (initialized_) misbehaveIn("destroy");
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({.name = "deed", .doc = "what it does", .value = &deed_});
    visit({.name = "call", .doc = "in which call", .value = &call_});
    visit({.name = "frame", .doc = "in which frame", .value = &frame_, .min = 1, .max = 1000});
    visit({.name = "mebibytes",
           .doc = "how much memory it takes in initialize, and gives back",
           .value = &mebibytes_,
           .min = 0,
           .max = 1000});
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    initialized_ = true;
    std::vector<char>(static_cast<std::size_t>(mebibytes_) * kMebibyte, 1).swap(taken_);
    taken_ = {};
    misbehaveIn("initialize");
  }

  void updateObjects(const Frame& frame) override {
    BoxBroadPhase::updateObjects(frame);
    now_ = frame.index;
  }

  void updateStructures() override {
    if (now_ == frame_) misbehaveIn("update");
  }

  [[nodiscard]] std::string validate() const override {
    return deed_.value == "break" && now_ == frame_ ? "broken on purpose" : "";
  }

  void visitCounters(const CounterVisitor& visit) const override {
    if (now_ == frame_) misbehaveIn("counters");
    visit("frames", static_cast<std::uint64_t>(now_));
  }

  void drawStructure(DebugDraw& draw) const override {
    misbehaveIn("draw");
    for (const Aabb& box : boxes()) draw.box(box, StructureRole::cell, 0);
  }

 private:
  void findPairs() override {
    for (const Pair pair : bruteForcePairs(boxes())) pairs().add(pair.a, pair.b);
    // The n-th such answer in this process has n extra pairs.
    static int answers = 0;
    if (deed_.value != "count" || now_ != frame_) return;
    ++answers;
    for (int i = 0; i < answers; ++i) pairs().add(0, 1);
  }

  void misbehaveIn(std::string_view call) const {
    if (call_.value != call) return;
    const std::string& deed = deed_.value;
    if (deed == "crash") crash();
    if (deed == "hang") hang();
    if (deed == "throw") throw std::runtime_error("thrown on purpose");
    if (deed == "throw-number") throw 42;
    if (deed == "exit") std::exit(3);
    if (deed == "allocate") allocateWithoutEnd();
    if (deed == "keep") retainMemory();
    if (deed == "close") ::close_range(3, 100, 0);
    if (deed == "print") {
      std::puts("printed on purpose");
      std::fflush(stdout);
    }
  }

  Choice deed_{"none",
               {"none", "crash", "hang", "throw", "throw-number", "exit", "allocate", "close",
                "print", "count", "break", "keep"}};
  Choice call_{"update", {"initialize", "update", "counters", "draw", "destroy"}};
  std::int64_t frame_ = 2;
  std::int64_t mebibytes_ = 0;
  bool initialized_ = false;
  std::int64_t now_ = 0;
  std::vector<char> taken_;
};

std::vector<Algorithm> variants() {
  return {{.id = "unruly",
           .family = "Unruly",
           .summary = "crashes, hangs or fails otherwise when asked to",
           .description = {.principle = "brute force",
                           .time = "O(n²)",
                           .space = "O(n + k)",
                           .source = "a test of Broadmark's"},
           .create = [] { return std::make_unique<Unruly>(); }}};
}

}  // namespace
}  // namespace broadmark::unruly

BROADMARK_PLUGIN(broadmark::unruly::variants);
