// Undo and redo are the same operation: a step swaps its contents with the scene's. No inverse is
// computed, so the former values are restored bit for bit.

#include "broadmark/scenes/scene_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <unordered_set>
#include <utility>

#include "authoring/faults.h"
#include "broadmark/error.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark::scenes {

namespace {

Vec3 plus(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

BodyIds idsFrom(std::size_t first, std::size_t end) {
  BodyIds ids(end - first);
  std::iota(ids.begin(), ids.end(), static_cast<std::uint32_t>(first));
  return ids;
}

std::shared_ptr<const BodyIds> shared(BodyIds ids) {
  return std::make_shared<const BodyIds>(std::move(ids));
}

/// Removes and returns these bodies, in the order of their ids.
std::vector<AuthoredBody> extracted(std::vector<AuthoredBody>& all, const BodyIds& ids) {
  std::vector<AuthoredBody> bodies;
  bodies.reserve(ids.size());
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (bodies.size() < ids.size() && ids[bodies.size()] == i) {
      bodies.push_back(all[i]);
    } else {
      all[remaining++] = all[i];
    }
  }
  all.resize(remaining);
  return bodies;
}

/// Inserts bodies so that they get these ids.
void insert(std::vector<AuthoredBody>& all, const BodyIds& ids,
            const std::vector<AuthoredBody>& bodies) {
  // In descending order, so that each body moves once.
  std::size_t remaining = all.size();
  all.resize(all.size() + bodies.size());
  for (std::size_t i = all.size(), to_insert = bodies.size(); to_insert > 0;) {
    --i;
    all[i] = ids[to_insert - 1] == i ? bodies[--to_insert] : all[--remaining];
  }
}

/// Unused group numbers.
class FreeGroups {
 public:
  explicit FreeGroups(const std::vector<AuthoredBody>& bodies) {
    for (const AuthoredBody& body : bodies) used_.insert(body.group);
  }
  /// Returns the next unused number, ascending.
  std::uint32_t next() {
    while (used_.contains(last_)) ++last_;
    return last_++;
  }

 private:
  std::unordered_set<std::uint32_t> used_;
  std::uint32_t last_ = 1;
};

std::string stepName(std::string_view verb, std::size_t bodies) {
  return fmt::format("{} {} {}", verb, bodies, bodies == 1 ? "body" : "bodies");
}

}  // namespace

SceneEditor::SceneEditor(AuthoredScene scene, std::size_t history_bytes)
    : scene_(std::move(scene)), selection_(shared({})), history_bytes_(history_bytes) {}

std::uint64_t SceneEditor::revision() const {
  return done_ == 0 ? first_revision_ : history_[done_ - 1].revision;
}

void SceneEditor::select(BodyIds bodies) {
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  if (!bodies.empty() && bodies.back() >= scene_.bodies.size()) {
    throw InputError(
        fmt::format("there is no body {}: the scene has {}", bodies.back(), scene_.bodies.size()));
  }
  // Equal lists share one object, also between steps.
  if (bodies != *selection_) selection_ = shared(std::move(bodies));
}

void SceneEditor::selectAll() { select(idsFrom(0, scene_.bodies.size())); }

BodyIds SceneEditor::withGroups(BodyIds bodies) const {
  std::set<std::uint32_t> groups;
  for (const std::uint32_t id : bodies) {
    if (id < scene_.bodies.size() && scene_.bodies[id].group != 0) {
      groups.insert(scene_.bodies[id].group);
    }
  }
  if (!groups.empty()) {
    for (std::uint32_t id = 0; id < scene_.bodies.size(); ++id) {
      if (groups.contains(scene_.bodies[id].group)) bodies.push_back(id);
    }
  }
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

Vec3 SceneEditor::selectionCentre() const {
  std::array<double, 3> sum{};
  for (const std::uint32_t id : *selection_) {
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += scene_.bodies[id].pose.position[axis];
  }
  Vec3 centre{};
  if (selection_->empty()) return centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    centre[axis] = static_cast<float>(sum[axis] / static_cast<double>(selection_->size()));
  }
  return centre;
}

void SceneEditor::add(std::vector<AuthoredBody> bodies) { addCopies("add", std::move(bodies)); }

void SceneEditor::erase() {
  if (!selection_->empty()) changePresence("delete", selection_, {}, shared({}));
}

void SceneEditor::duplicate(const Vec3& offset) {
  std::vector<AuthoredBody> copies;
  copies.reserve(selection_->size());
  FreeGroups free(scene_.bodies);
  std::map<std::uint32_t, std::uint32_t> groups = {{0, 0}};
  for (const std::uint32_t id : *selection_) {
    copies.push_back(scene_.bodies[id]);
    AuthoredBody& copy = copies.back();
    copy.pose.position = plus(copy.pose.position, offset);
    const auto [group, is_new] = groups.try_emplace(copy.group);
    if (is_new) group->second = free.next();
    copy.group = group->second;
  }
  addCopies("duplicate", std::move(copies));
}

void SceneEditor::transform(std::string_view verb, const Transformation& by) {
  change(verb, [&](AuthoredBody& body) {
    body.shape = transformedShape(body, by);  // depends on the former rotation
    body.pose = transformedPose(body, by);
  });
}

void SceneEditor::move(const Vec3& by) { transform("move", {.move = by}); }

void SceneEditor::scale(float factor) {
  transform("scale", {.centre = selectionCentre(), .scale = {factor, factor, factor}});
}

void SceneEditor::align(std::size_t axis, Alignment alignment) {
  const auto bound = [&](const Aabb& box) {
    switch (alignment) {
      case Alignment::low:
        return box.min[axis];
      case Alignment::high:
        return box.max[axis];
      case Alignment::middle:
        break;
    }
    return (box.min[axis] + box.max[axis]) / 2;
  };
  const auto box_of = [](const AuthoredBody& body) { return tightBox(body.shape, body.pose); };
  Aabb all = kEmptyBox;
  for (const std::uint32_t id : *selection_) all = merged(all, box_of(scene_.bodies[id]));
  change("align",
         [&](AuthoredBody& body) { body.pose.position[axis] += bound(all) - bound(box_of(body)); });
}

void SceneEditor::setSize(const Vec3& edges) {
  change("resize", [&](AuthoredBody& body) {
    if (std::holds_alternative<SphereShape>(body.shape)) {
      body.shape = SphereShape{edges[0] / 2};
    } else {
      body.shape = BoxShape{{edges[0] / 2, edges[1] / 2, edges[2] / 2}};
    }
  });
}

void SceneEditor::makeBoxes() {
  change("make boxes of", [](AuthoredBody& body) {
    const auto* sphere = std::get_if<SphereShape>(&body.shape);
    if (sphere) body.shape = BoxShape{{sphere->radius, sphere->radius, sphere->radius}};
  });
}

void SceneEditor::makeSpheres() {
  change("make spheres of", [](AuthoredBody& body) {
    const auto* box = std::get_if<BoxShape>(&body.shape);
    if (box == nullptr) return;
    const auto& [x, y, z] = box->half_extents;
    body.shape = SphereShape{(x + y + z) / 3};
  });
}

void SceneEditor::group() {
  if (selection_->size() > 1) set("group", &AuthoredBody::group, FreeGroups(scene_.bodies).next());
}

void SceneEditor::ungroup() { set("ungroup", &AuthoredBody::group, 0U); }

void SceneEditor::setName(std::string name) {
  const std::string fault = faultOfName(name);
  changeScene("rename the scene", &AuthoredScene::name, std::move(name), fault);
}

void SceneEditor::setWorld(const Aabb& world) {
  changeScene("change the world", &AuthoredScene::world, world, faultOfWorld(world));
}

void SceneEditor::setParameters(const ParameterValues& values) {
  ParameterValues updated = scene_.parameters;
  AuthoredParameters current(updated);
  if (const auto engine = values.find("engine");
      engine != values.end() && engine->second != current.values().at("engine")) {
    AuthoredParameters other({{"engine", engine->second}});
    const ParameterValues parameters = other.values();
    std::erase_if(updated, [&](const auto& value) { return !parameters.contains(value.first); });
  }
  for (const auto& [name, value] : values) updated[name] = value;
  // Normalises the values' text.
  const ParameterValues all = AuthoredParameters(updated).values();
  for (auto& [name, value] : updated) value = all.at(name);
  changeScene("change parameters", &AuthoredScene::parameters, std::move(updated), {});
}

std::string SceneEditor::undoName() const { return canUndo() ? history_[done_ - 1].name : ""; }
std::string SceneEditor::redoName() const { return canRedo() ? history_[done_].name : ""; }

void SceneEditor::undo() {
  if (!canUndo()) return;
  Step& step = history_[--done_];
  step.exchange(scene_);
  selection_ = step.before;
}

void SceneEditor::redo() {
  if (!canRedo()) return;
  Step& step = history_[done_++];
  step.exchange(scene_);
  selection_ = step.after;
}

std::size_t SceneEditor::historyBytes() const {
  std::size_t sum = 0;
  for (const Step& step : history_) sum += step.bytes;
  return sum;
}

void SceneEditor::change(std::string_view verb, const std::function<void(AuthoredBody&)>& edit) {
  std::vector<AuthoredBody> bodies;
  bodies.reserve(selection_->size());
  bool differs = false;
  for (const std::uint32_t id : *selection_) {
    AuthoredBody& body = bodies.emplace_back(scene_.bodies[id]);
    edit(body);
    requireValid(body, id);
    differs |= body != scene_.bodies[id];
  }
  if (!differs) return;
  const std::size_t count = bodies.size();
  perform({.name = stepName(verb, count),
           .exchange =
               [ids = selection_, bodies = std::move(bodies)](AuthoredScene& scene) mutable {
                 for (std::size_t i = 0; i < bodies.size(); ++i) {
                   std::swap(scene.bodies[(*ids)[i]], bodies[i]);
                 }
               },
           .bytes = count * sizeof(AuthoredBody),
           .after = selection_});
}

template <class Value>
void SceneEditor::changeScene(std::string name, Value AuthoredScene::* property, Value value,
                              const std::string& fault) {
  if (!fault.empty()) throw InputError(fault);
  if (value == scene_.*property) return;
  constexpr std::size_t kTypicalText = 4096;  // names and parameters contain no bodies
  perform({.name = std::move(name),
           .exchange = [property,
                        value](AuthoredScene& scene) mutable { std::swap(scene.*property, value); },
           .bytes = kTypicalText,
           .after = selection_});
}

void SceneEditor::changePresence(std::string_view verb, SharedIds ids,
                                 std::vector<AuthoredBody> absent, SharedIds selected_after) {
  perform({.name = stepName(verb, ids->size()),
           .exchange =
               [ids, absent = std::move(absent)](AuthoredScene& scene) mutable {
                 if (absent.empty()) {
                   absent = extracted(scene.bodies, *ids);
                 } else {
                   insert(scene.bodies, *ids, std::exchange(absent, {}));
                 }
               },
           .bytes = ids->size() * (sizeof(AuthoredBody) + sizeof(std::uint32_t)),
           .after = std::move(selected_after)});
}

void SceneEditor::addCopies(std::string_view verb, std::vector<AuthoredBody> bodies) {
  if (bodies.empty()) return;
  const std::size_t first = scene_.bodies.size();
  if (first + bodies.size() > kMaxBodies) {
    throw InputError(
        fmt::format("{} more bodies: a scene has at most {}", bodies.size(), kMaxBodies));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) requireValid(bodies[i], first + i);
  const SharedIds ids = shared(idsFrom(first, first + bodies.size()));
  changePresence(verb, ids, std::move(bodies), ids);
}

void SceneEditor::perform(Step step) {
  history_.erase(history_.begin() + static_cast<std::ptrdiff_t>(done_), history_.end());
  step.before = selection_;
  step.bytes += sizeof(Step) + (step.before->size() + step.after->size()) * sizeof(std::uint32_t);
  step.revision = ++last_revision_;
  history_.push_back(std::move(step));
  done_ = history_.size() - 1;
  redo();
  std::size_t bytes = historyBytes();
  while (bytes > history_bytes_ && history_.size() > 1) {
    bytes -= history_.front().bytes;
    first_revision_ = history_.front().revision;
    history_.pop_front();
    --done_;
  }
}

}  // namespace broadmark::scenes
