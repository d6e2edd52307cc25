// Each entry of a C table becomes an algorithm.

#include "request/c_plugin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "broadmark/error.h"
#include "request/described_parameters.h"

namespace broadmark {
namespace {

// Boxes and pairs are passed without being copied.
static_assert(sizeof(broadmark_box) == sizeof(Aabb));
static_assert(sizeof(broadmark_pair) == sizeof(Pair));

using Table = std::shared_ptr<const broadmark_algorithm>;

std::string textOf(const char* text) { return text == nullptr ? "" : text; }

std::string statedOf(const char* text) { return text == nullptr ? "not stated" : text; }

PairRun pairsOf(const broadmark_pairs& pairs) {
  return {reinterpret_cast<const Pair*>(pairs.pairs), pairs.count};
}

std::vector<ParameterDescription> describedBy(const broadmark_algorithm& table) {
  std::vector<ParameterDescription> descriptions;
  for (std::size_t i = 0; i < table.parameter_count; ++i) {
    const broadmark_parameter& parameter = table.parameters[i];
    descriptions.push_back({.name = textOf(parameter.name),
                            .doc = textOf(parameter.doc),
                            .value = parameter.value,
                            .min = parameter.min,
                            .max = parameter.max,
                            .is_integer = parameter.is_integer != 0});
  }
  return descriptions;
}

class CBroadPhase final : public BroadPhase {
 public:
  explicit CBroadPhase(Table table) : table_(std::move(table)), parameters_(describedBy(*table_)) {}
  ~CBroadPhase() override {
    if (instance_ != nullptr) table_->destroy(instance_);
  }
  CBroadPhase(const CBroadPhase&) = delete;
  CBroadPhase& operator=(const CBroadPhase&) = delete;

  void visitParameters(const ParameterVisitor& visit) override { parameters_.visit(visit); }
  [[nodiscard]] float margin() const override {
    return table_->margin == nullptr ? 0 : table_->margin(values().data());
  }
  void reportEvents() override { events_ = true; }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    filter_ = scene.filter;
    const std::vector<double> parameters = values();
    const broadmark_scene c_scene{.bodies = scene.objects,
                                  .frames = scene.frames,
                                  .world = *boxes(&scene.world),
                                  .threads = static_cast<std::uint32_t>(execution.threads()),
                                  .events = events_ ? 1 : 0,
                                  .parameters = parameters.data()};
    instance_ = table_->create(&c_scene, &frameOf(first));
    if (instance_ == nullptr) fail("create");
    if (events_) searchOverlaps();
  }
  void updateObjects(const Frame& frame) override {
    table_->update_objects(instance_, &frameOf(frame));
  }
  void cleanCache() override {
    if (table_->clean_cache != nullptr) table_->clean_cache(instance_);
  }
  void updateStructures() override {
    if (table_->update_structures != nullptr) table_->update_structures(instance_);
  }
  void searchOverlaps() override {
    broadmark_answer answer{};
    if (table_->search_overlaps(instance_, &answer) != 0) fail("search_overlaps");
    pairs_ = pairsOf(answer.pairs);
    ended_ = pairsOf(answer.ended);
  }
  [[nodiscard]] PairRuns overlaps() const override { return {&pairs_, 1}; }
  [[nodiscard]] PairEvents events() const override { return {{&pairs_, 1}, {&ended_, 1}}; }

  void drawStructure(DebugDraw& draw) const override {
    if (table_->draw == nullptr) return;
    const broadmark_drawing drawing{
        .context = &draw,
        .box =
            [](void* context, const broadmark_box* box, std::int32_t level) {
              static_cast<DebugDraw*>(context)->box(*reinterpret_cast<const Aabb*>(box),
                                                    StructureRole::cell, level);
            },
        .line =
            [](void* context, const float* from, const float* to) {
              static_cast<DebugDraw*>(context)->line({from[0], from[1], from[2]},
                                                     {to[0], to[1], to[2]}, StructureRole::split);
            }};
    table_->draw(instance_, &drawing);
  }

 private:
  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> values;
    parameters_.eachValue(
        [&](const std::string&, auto value) { values.push_back(static_cast<double>(value)); });
    return values;
  }

  static const broadmark_box* boxes(const Aabb* boxes) {
    return reinterpret_cast<const broadmark_box*>(boxes);
  }

  /// Valid until the next call.
  const broadmark_frame& frameOf(const Frame& frame) {
    frame_ = {.index = frame.index,
              .bodies = static_cast<std::uint32_t>(frame.boxes.size()),
              .boxes = boxes(frame.boxes.data()),
              .changed = frame.changed->data(),
              .changed_count = frame.changed->size(),
              .collides = nullptr,
              .filter = &filter_};
    if (!filter_.wantsAll()) {
      frame_.collides = [](const void* filter, std::uint32_t a, std::uint32_t b) {
        return std::int32_t{static_cast<const CollisionFilter*>(filter)->wanted(a, b)};
      };
    }
    return frame_;
  }

  [[noreturn]] void fail(const char* function) const {
    const std::string reason = table_->error == nullptr ? "" : textOf(table_->error(instance_));
    throw std::runtime_error(
        fmt::format("{} failed{}{}", function, reason.empty() ? "" : ": ", reason));
  }

  Table table_;
  DescribedParameters parameters_;
  CollisionFilter filter_;
  bool events_ = false;
  void* instance_ = nullptr;
  broadmark_frame frame_{};
  PairRun pairs_;
  PairRun ended_;
};

AlgorithmTraits traitsOf(const broadmark_algorithm& table) {
  const auto has = [&](std::uint32_t trait) { return (table.traits & trait) != 0; };
  AlgorithmTraits traits;
  traits.parallel = has(BROADMARK_PARALLEL);
  traits.incremental = has(BROADMARK_INCREMENTAL);
  traits.events = has(BROADMARK_EVENTS);
  if (has(BROADMARK_CHANGING_WORLDS)) {
    traits.changing_worlds = ChangingWorlds::native;
  } else if (has(BROADMARK_COMPACTED)) {
    traits.changing_worlds = ChangingWorlds::compacted;
  }
  if (table.max_bodies != 0) traits.max_objects = table.max_bodies;
  return traits;
}

}  // namespace

std::vector<Algorithm> algorithmsOf(const broadmark_plugin* plugin, const std::string& file) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("--plugin: {}: {}", file, reason));
  };
  if (plugin == nullptr) refuse(fmt::format("{} returns null", kCPluginSymbol));
  if (plugin->version == 0 || plugin->version > BROADMARK_PLUGIN_VERSION) {
    refuse(fmt::format("made for version {} of broadmark_plugin.h, this program supports up to {}",
                       plugin->version, BROADMARK_PLUGIN_VERSION));
  }
  if (plugin->algorithm_count == 0) refuse("has no algorithms");
  std::vector<Algorithm> algorithms;
  for (std::uint32_t i = 0; i < plugin->algorithm_count; ++i) {
    // Members that a plug-in of an older version lacks remain null.
    const auto table = std::make_shared<broadmark_algorithm>();
    std::memcpy(table.get(),
                reinterpret_cast<const char*>(plugin->algorithms) + i * plugin->algorithm_size,
                std::min(sizeof(broadmark_algorithm), plugin->algorithm_size));
    if (table->create == nullptr || table->destroy == nullptr || table->update_objects == nullptr ||
        table->search_overlaps == nullptr) {
      refuse(
          fmt::format("algorithm '{}': create, destroy, update_objects and search_overlaps must "
                      "not be null",
                      textOf(table->id)));
    }
    algorithms.push_back({.id = textOf(table->id),
                          .family = textOf(table->family),
                          .summary = textOf(table->summary),
                          .traits = traitsOf(*table),
                          .description = {.principle = statedOf(table->principle),
                                          .optimisations = "",
                                          .time = statedOf(table->time),
                                          .space = statedOf(table->space),
                                          .source = statedOf(table->source)},
                          .create = [table] { return std::make_unique<CBroadPhase>(table); }});
  }
  return algorithms;
}

}  // namespace broadmark
