// Editing an authored scene, with undo and redo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/transformation.h"

namespace broadmark::scenes {

/// Ids of bodies, ascending, each once.
using BodyIds = std::vector<std::uint32_t>;

/// Changes a scene in steps that can be undone. A step stores only the bodies that it changed,
/// added or deleted, or the changed property of the scene.
///
/// Every edit acts on the selected bodies. An edit without effect is not a step. An edit that would
/// make a body invalid throws InputError and changes nothing. Undo and redo also restore the
/// selection. O(selected bodies); adding and deleting O(all bodies).
class SceneEditor {
 public:
  /// Memory limit of all steps together. Beyond it the oldest steps are dropped, but never the
  /// latest.
  static constexpr std::size_t kHistoryBytes = std::size_t{256} << 20;

  explicit SceneEditor(AuthoredScene scene = {}, std::size_t history_bytes = kHistoryBytes);

  [[nodiscard]] const AuthoredScene& scene() const { return scene_; }
  /// Identifies the state of the scene; undo restores the revision, too.
  [[nodiscard]] std::uint64_t revision() const;
  /// Whether the scene has changed since the last markSaved(), or since construction.
  [[nodiscard]] bool isModified() const { return revision() != saved_revision_; }
  void markSaved() { saved_revision_ = revision(); }

  // ---- Selection: not a step

  [[nodiscard]] const BodyIds& selection() const { return *selection_; }
  /// Selects these bodies, in any order. Throws InputError if there is no such body.
  void select(BodyIds bodies);
  void selectAll();
  void selectNone() { select({}); }
  /// These bodies and all others of their groups, ascending.
  [[nodiscard]] BodyIds withGroups(BodyIds bodies) const;
  [[nodiscard]] Vec3 selectionCentre() const;

  // ---- Edits

  /// Appends bodies and selects them.
  void add(std::vector<AuthoredBody> bodies);
  void erase();
  /// Appends copies of the selected bodies, moved by `offset`, and selects them. Copies of a group
  /// form a new group.
  void duplicate(const Vec3& offset);
  /// Edits each selected body; `verb` names the step: "freeze".
  void change(std::string_view verb, const std::function<void(AuthoredBody&)>& edit);
  /// Sets a property of the selected bodies.
  template <class Value>
  void set(std::string_view verb, Value AuthoredBody::* property,
           const std::type_identity_t<Value>& value) {
    change(verb, [&](AuthoredBody& body) { body.*property = value; });
  }
  void transform(std::string_view verb, const Transformation& by);
  void move(const Vec3& by);
  /// Scales positions and sizes about the common centre.
  void scale(float factor);
  /// Moves each selected body along an axis (0, 1, 2) until the lower bound, middle or upper bound
  /// of its tight box equals that of the bounds of all their boxes.
  enum class Alignment { low, middle, high };
  void align(std::size_t axis, Alignment alignment);
  /// Sets the edges of boxes, and the diameter of spheres to the first of the three.
  void setSize(const Vec3& edges);
  /// Spheres become cubes with the diameter as edge; boxes become spheres with the mean edge as
  /// diameter.
  void makeBoxes();
  void makeSpheres();
  /// Groups two or more selected bodies, which leave their former groups.
  void group();
  void ungroup();
  // Edits of the scene as a whole.
  void setName(std::string name);
  void setWorld(const Aabb& world);
  /// Sets these parameters (see AuthoredParameters). Others retain their values, but those of a
  /// deselected engine are dropped.
  void setParameters(const ParameterValues& values);

  // ---- History

  [[nodiscard]] bool canUndo() const { return done_ > 0; }
  [[nodiscard]] bool canRedo() const { return done_ < history_.size(); }
  /// The name of the step that undo() would undo: "move 12 bodies"; "": none.
  [[nodiscard]] std::string undoName() const;
  [[nodiscard]] std::string redoName() const;
  // No effect without a step to undo or redo.
  void undo();
  void redo();
  [[nodiscard]] std::size_t historyBytes() const;

 private:
  using SharedIds = std::shared_ptr<const BodyIds>;
  struct Step {
    std::string name;
    /// Swaps the step's contents with the scene's.
    std::function<void(AuthoredScene&)> exchange;
    std::size_t bytes = 0;
    SharedIds before = {};       ///< the selection before the step
    SharedIds after;             ///< the selection after it
    std::uint64_t revision = 0;  ///< of the scene after it
  };

  template <class Value>
  void changeScene(std::string name, Value AuthoredScene::* property, Value value,
                   const std::string& fault);
  void addCopies(std::string_view verb, std::vector<AuthoredBody> bodies);
  /// Adds the bodies in `absent` under the ids, or removes the bodies with these ids if it is
  /// empty.
  void changePresence(std::string_view verb, SharedIds ids, std::vector<AuthoredBody> absent,
                      SharedIds selected_after);
  void perform(Step step);

  AuthoredScene scene_;
  SharedIds selection_;
  std::size_t history_bytes_;
  std::deque<Step> history_;  ///< the first done_ steps are done, the others undone
  std::size_t done_ = 0;
  std::uint64_t last_revision_ = 0;
  std::uint64_t first_revision_ = 0;  ///< before the oldest stored step
  std::uint64_t saved_revision_ = 0;
};

}  // namespace broadmark::scenes
