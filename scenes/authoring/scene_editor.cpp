// Undo and redo are the same operation: every change is an exchange (scene_change.h).

#include "broadmark/scenes/scene_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "authoring/faults.h"
#include "authoring/scene_change.h"
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

SharedIds shared(BodyIds ids) { return std::make_shared<const BodyIds>(std::move(ids)); }

/// Numbers of groups that no body has.
class FreeGroups {
 public:
  explicit FreeGroups(const std::vector<AuthoredBody>& bodies) {
    for (const AuthoredBody& body : bodies) {
      if (body.group != 0) taken_.push_back(body.group);
    }
    std::ranges::sort(taken_);
  }
  /// The least one, each time another.
  std::uint32_t next() {
    ++last_;
    for (; at_ < taken_.size() && taken_[at_] <= last_; ++at_) {
      if (taken_[at_] == last_) ++last_;
    }
    return last_;
  }

 private:
  std::vector<std::uint32_t> taken_;
  std::size_t at_ = 0;
  std::uint32_t last_ = 0;
};

std::string stepName(std::string_view verb, std::size_t bodies) {
  return fmt::format("{} {} {}", verb, bodies, bodies == 1 ? "body" : "bodies");
}

}  // namespace

/// Changes that are undone together, in the order in which they were made.
struct SceneEditor::Step {
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = sizeof(Step) + (before->size() + after->size()) * sizeof(std::uint32_t);
    for (const auto& change : changes) sum += change->bytes();
    return sum;
  }
  /// Whether undoing an earlier change of this step also undoes `change`, the latest one.
  [[nodiscard]] bool covers(const SceneChange& change) const {
    for (auto earlier = changes.rbegin(); earlier != changes.rend(); ++earlier) {
      if ((*earlier)->covers(change)) return true;
      if ((*earlier)->renumbers()) return false;
    }
    return false;
  }

  std::string name;
  std::vector<std::unique_ptr<SceneChange>> changes;
  SharedIds before;            ///< the selection before the step
  SharedIds after;             ///< the selection after it
  std::uint64_t revision = 0;  ///< of the scene after it
};

SceneEditor::SceneEditor(AuthoredScene scene, std::size_t history_bytes)
    : scene_(std::move(scene)), selection_(shared({})), history_bytes_(history_bytes) {}
SceneEditor::~SceneEditor() = default;
SceneEditor::SceneEditor(SceneEditor&&) noexcept = default;
SceneEditor& SceneEditor::operator=(SceneEditor&&) noexcept = default;

std::uint64_t SceneEditor::revision() const {
  return done_ == 0 ? first_revision_ : history_[done_ - 1]->revision;
}

void SceneEditor::select(BodyIds bodies) {
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  if (!bodies.empty() && bodies.back() >= scene_.bodies.size()) {
    throw InputError(
        fmt::format("there is no body {}: the scene has {}", bodies.back(), scene_.bodies.size()));
  }
  // An equal list stays the same object, so that steps share it.
  if (bodies != *selection_) selection_ = shared(std::move(bodies));
}

void SceneEditor::selectAll() { select(idsFrom(0, scene_.bodies.size())); }

void SceneEditor::toggle(const BodyIds& bodies) {
  BodyIds sorted = bodies;
  std::ranges::sort(sorted);
  BodyIds toggled;
  std::ranges::set_symmetric_difference(*selection_, sorted, std::back_inserter(toggled));
  select(std::move(toggled));
}

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
  if (selection_->empty()) return;
  perform(stepName("delete", selection_->size()),
          std::make_unique<BodyPresence>(selection_, std::vector<AuthoredBody>()), shared({}));
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
    const auto [group, fresh] = groups.try_emplace(copy.group);
    if (fresh) group->second = free.next();
    copy.group = group->second;
  }
  addCopies("duplicate", std::move(copies));
}

void SceneEditor::transform(std::string_view verb, const Transformation& change) {
  // Two properties change: both must be valid before the first one changes.
  for (const std::uint32_t id : *selection_) {
    AuthoredBody body = scene_.bodies[id];
    body.shape = transformedShape(body, change);
    body.pose = transformedPose(body, change);
    requireSound(body, id);
  }
  const bool alone = !in_gesture_;
  if (alone) beginGesture(stepName(verb, selection_->size()));
  // The shape first: it depends on the former rotation.
  changeBodies(verb, &AuthoredBody::shape,
               [&](const AuthoredBody& body) { return transformedShape(body, change); });
  changeBodies(verb, &AuthoredBody::pose,
               [&](const AuthoredBody& body) { return transformedPose(body, change); });
  if (alone) endGesture();
}

void SceneEditor::move(const Vec3& by) { transform("move", {.move = by}); }

void SceneEditor::turn(const Quaternion& by) {
  transform("turn", {.centre = selectionCentre(), .turn = by});
}

void SceneEditor::scale(float factor) {
  transform("scale", {.centre = selectionCentre(), .scale = {factor, factor, factor}});
}

void SceneEditor::align(std::size_t axis, Alignment alignment) {
  const auto place = [&](const Aabb& box) {
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
  changeBodies("align", &AuthoredBody::pose, [&](const AuthoredBody& body) {
    Pose pose = body.pose;
    pose.position[axis] += place(all) - place(box_of(body));
    return pose;
  });
}

void SceneEditor::setSize(const Vec3& edges) {
  changeBodies("resize", &AuthoredBody::shape, [&](const AuthoredBody& body) -> Shape {
    if (std::holds_alternative<SphereShape>(body.shape)) return SphereShape{edges[0] / 2};
    return BoxShape{{edges[0] / 2, edges[1] / 2, edges[2] / 2}};
  });
}

void SceneEditor::makeBoxes() {
  changeBodies("make boxes of", &AuthoredBody::shape, [](const AuthoredBody& body) -> Shape {
    const auto* sphere = std::get_if<SphereShape>(&body.shape);
    if (sphere == nullptr) return body.shape;
    return BoxShape{{sphere->radius, sphere->radius, sphere->radius}};
  });
}

void SceneEditor::makeSpheres() {
  changeBodies("make spheres of", &AuthoredBody::shape, [](const AuthoredBody& body) -> Shape {
    const auto* box = std::get_if<BoxShape>(&body.shape);
    if (box == nullptr) return body.shape;
    const auto& [x, y, z] = box->half_extents;
    return SphereShape{(x + y + z) / 3};
  });
}

void SceneEditor::setMass(double mass) {
  changeBodies("set the mass of", &AuthoredBody::mass, [&](const AuthoredBody&) { return mass; });
}

void SceneEditor::setFrozen(bool frozen) {
  changeBodies(frozen ? "freeze" : "unfreeze", &AuthoredBody::frozen,
               [&](const AuthoredBody&) { return frozen; });
}

void SceneEditor::setVelocity(const Vec3& linear) {
  changeBodies("set the velocity of", &AuthoredBody::linear_velocity,
               [&](const AuthoredBody&) { return linear; });
}

void SceneEditor::setAngularVelocity(const Vec3& angular) {
  changeBodies("set the spin of", &AuthoredBody::angular_velocity,
               [&](const AuthoredBody&) { return angular; });
}

void SceneEditor::setLayer(std::uint8_t layer) {
  changeBodies("set the layer of", &AuthoredBody::layer,
               [&](const AuthoredBody&) { return layer; });
}

void SceneEditor::setAppears(std::uint32_t frame) {
  changeBodies("set the first frame of", &AuthoredBody::appears,
               [&](const AuthoredBody&) { return frame; });
}

void SceneEditor::setVanishes(std::uint32_t frame) {
  changeBodies("set the last frame of", &AuthoredBody::vanishes,
               [&](const AuthoredBody&) { return frame; });
}

void SceneEditor::group() {
  if (selection_->size() < 2) return;
  changeBodies("group", &AuthoredBody::group,
               [number = FreeGroups(scene_.bodies).next()](const AuthoredBody&) { return number; });
}

void SceneEditor::ungroup() {
  changeBodies("ungroup", &AuthoredBody::group, [](const AuthoredBody&) { return 0U; });
}

void SceneEditor::setName(std::string name) {
  const std::string fault = faultOfName(name);
  changeScene("rename the scene", &AuthoredScene::name, std::move(name), fault);
}

void SceneEditor::setWorld(const Aabb& world) {
  changeScene("change the world", &AuthoredScene::world, world, faultOfWorld(world));
}

void SceneEditor::setParameters(const ParameterValues& values) {
  ParameterValues wanted = scene_.parameters;
  AuthoredParameters present(wanted);
  if (const auto engine = values.find("engine");
      engine != values.end() && engine->second != present.values().at("engine")) {
    AuthoredParameters other({{"engine", engine->second}});
    const ParameterValues known = other.values();
    std::erase_if(wanted, [&](const auto& value) { return !known.contains(value.first); });
  }
  for (const auto& [name, value] : values) wanted[name] = value;
  // Equal values become equal texts.
  const ParameterValues all = AuthoredParameters(wanted).values();
  for (auto& [name, value] : wanted) value = all.at(name);
  changeScene("change parameters", &AuthoredScene::parameters, std::move(wanted), {});
}

void SceneEditor::beginGesture(std::string name) {
  in_gesture_ = true;
  gesture_has_step_ = false;
  gesture_name_ = std::move(name);
}

void SceneEditor::endGesture() { in_gesture_ = gesture_has_step_ = false; }

std::string SceneEditor::undoName() const { return canUndo() ? history_[done_ - 1]->name : ""; }
std::string SceneEditor::redoName() const { return canRedo() ? history_[done_]->name : ""; }

void SceneEditor::undo() {
  endGesture();
  if (!canUndo()) return;
  Step& step = *history_[--done_];
  for (auto change = step.changes.rbegin(); change != step.changes.rend(); ++change) {
    (*change)->exchange(scene_);
  }
  selection_ = step.before;
}

void SceneEditor::redo() {
  endGesture();
  if (!canRedo()) return;
  Step& step = *history_[done_++];
  for (const auto& change : step.changes) change->exchange(scene_);
  selection_ = step.after;
}

std::size_t SceneEditor::historyBytes() const {
  std::size_t sum = 0;
  for (const auto& step : history_) sum += step->bytes();
  return sum;
}

template <class Value, class Make>
void SceneEditor::changeBodies(std::string_view verb, Value AuthoredBody::*property, Make&& make) {
  const BodyIds& ids = *selection_;
  auto values = std::make_unique<Value[]>(ids.size());
  bool differs = false;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    AuthoredBody body = scene_.bodies[ids[i]];
    values[i] = make(std::as_const(body));
    differs |= !(values[i] == body.*property);
    body.*property = values[i];
    requireSound(body, ids[i]);
  }
  if (!differs) return;
  perform(stepName(verb, ids.size()),
          std::make_unique<BodyValues<Value>>(property, selection_, std::move(values)), selection_);
}

template <class Value>
void SceneEditor::changeScene(std::string name, Value AuthoredScene::*property, Value value,
                              const std::string& fault) {
  if (!fault.empty()) throw InputError(fault);
  if (value == scene_.*property) return;
  perform(std::move(name), std::make_unique<SceneValue<Value>>(property, std::move(value)),
          selection_);
}

void SceneEditor::addCopies(std::string_view verb, std::vector<AuthoredBody> bodies) {
  if (bodies.empty()) return;
  const std::size_t first = scene_.bodies.size();
  if (first + bodies.size() > kMostBodies) {
    throw InputError(
        fmt::format("{} more bodies: a scene has at most {}", bodies.size(), kMostBodies));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) requireSound(bodies[i], first + i);
  const SharedIds ids = shared(idsFrom(first, first + bodies.size()));
  std::string name = stepName(verb, bodies.size());
  perform(std::move(name), std::make_unique<BodyPresence>(ids, std::move(bodies)), ids);
}

void SceneEditor::perform(std::string name, std::unique_ptr<SceneChange> change,
                          SharedIds selected_after) {
  change->exchange(scene_);
  if (!gesture_has_step_) {
    history_.erase(history_.begin() + static_cast<std::ptrdiff_t>(done_), history_.end());
    auto step = std::make_unique<Step>();
    step->name = in_gesture_ ? gesture_name_ : std::move(name);
    step->before = selection_;
    step->after = selection_;
    history_.push_back(std::move(step));
    done_ = history_.size();
    gesture_has_step_ = in_gesture_;
  }
  Step& step = *history_.back();
  if (!step.covers(*change)) step.changes.push_back(std::move(change));
  step.revision = ++last_revision_;
  step.after = selection_ = std::move(selected_after);
  forgetOldest();
}

void SceneEditor::forgetOldest() {
  std::size_t bytes = historyBytes();
  while (bytes > history_bytes_ && history_.size() > 1) {
    bytes -= history_.front()->bytes();
    first_revision_ = history_.front()->revision;
    history_.pop_front();
    --done_;
  }
}

}  // namespace broadmark::scenes
