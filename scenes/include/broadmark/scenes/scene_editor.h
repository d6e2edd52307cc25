// Editing an authored scene, with undo and redo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// Ids of bodies, ascending, each once.
using BodyIds = std::vector<std::uint32_t>;

/// Changes a scene in steps that can be undone. A step keeps only what it changed: the former
/// values of one property of the bodies concerned, or the bodies that were added or deleted.
///
/// Every edit acts on the selected bodies; with none selected, or with nothing to change, it does
/// nothing and is no step. Each throws InputError, and leaves all as it was, when a body would no
/// longer be valid. Undoing or redoing a step also brings back the selection before or after it.
/// O(bodies concerned); adding and deleting O(bodies).
class SceneEditor {
 public:
  /// Memory that all steps together may take. The oldest are given up for it, the latest never.
  static constexpr std::size_t kHistoryBytes = std::size_t{256} << 20;

  explicit SceneEditor(AuthoredScene scene = {}, std::size_t history_bytes = kHistoryBytes);
  ~SceneEditor();
  SceneEditor(SceneEditor&&) noexcept;
  SceneEditor& operator=(SceneEditor&&) noexcept;

  [[nodiscard]] const AuthoredScene& scene() const { return scene_; }
  /// A number that stands for this very state of the scene: undoing brings back the former one.
  [[nodiscard]] std::uint64_t revision() const;
  /// Whether the scene differs from what it was at the last markSaved(), or at first.
  [[nodiscard]] bool isModified() const { return revision() != saved_revision_; }
  void markSaved() { saved_revision_ = revision(); }

  // ---- Selection: no step of its own

  [[nodiscard]] const BodyIds& selection() const { return *selection_; }
  /// In any order. Throws InputError when there is no such body.
  void select(BodyIds bodies);
  void selectAll();
  void selectNone() { select({}); }
  /// Adds those that are not selected, takes away those that are.
  void toggle(const BodyIds& bodies);
  /// The centre of the selected bodies' positions.
  [[nodiscard]] Vec3 selectionCentre() const;

  // ---- Edits

  /// Appends bodies and selects them.
  void add(std::vector<AuthoredBody> bodies);
  void erase();
  /// Appends copies, moved by `offset`, and selects them.
  void duplicate(const Vec3& offset);
  void move(const Vec3& by);
  /// Turns the selected bodies about their common centre by a quaternion of unit length.
  void turn(const Quaternion& by);
  /// Scales places and sizes about the common centre.
  void scale(float factor);
  /// The edges of boxes; a sphere gets the first as its diameter.
  void setSize(const Vec3& edges);
  /// Boxes and spheres into each other: a cube of the sphere's diameter, a sphere of the mean edge.
  void makeBoxes();
  void makeSpheres();
  void setMass(double mass);
  void setFrozen(bool frozen);
  void setVelocity(const Vec3& linear);
  void setAngularVelocity(const Vec3& angular);
  /// These act on the scene as a whole.
  void setName(std::string name);
  void setWorld(const Aabb& world);
  /// States these parameters (see AuthoredParameters); those not named keep their values. Those of
  /// an engine that is no longer chosen are dropped.
  void setParameters(const ParameterValues& values);

  // ---- History

  /// Until endGesture() all edits are one step, called `name`: a drag of the mouse, or one touch of
  /// a slider. Repeated edits of the same property take no more memory. Gestures do not nest.
  void beginGesture(std::string name);
  void endGesture();
  [[nodiscard]] bool inGesture() const { return in_gesture_; }

  [[nodiscard]] bool canUndo() const { return done_ > 0; }
  [[nodiscard]] bool canRedo() const { return done_ < history_.size(); }
  /// What would be undone, in words: "move 12 bodies"; "": nothing.
  [[nodiscard]] std::string undoName() const;
  [[nodiscard]] std::string redoName() const;
  /// Both end a gesture, and do nothing when there is nothing to do.
  void undo();
  void redo();
  /// What the history takes at present.
  [[nodiscard]] std::size_t historyBytes() const;

  /// One change, which can be exchanged for its reverse; see the source.
  class Change;

 private:
  using SharedIds = std::shared_ptr<const BodyIds>;
  struct Step;

  /// Computes the new value of one property for each selected body, checks it and exchanges them.
  template <class Value, class Make>
  void changeBodies(std::string_view verb, Value AuthoredBody::*property, Make&& make);
  template <class Value>
  void changeScene(std::string name, Value AuthoredScene::*property, Value value,
                   const std::string& fault);
  void addCopies(std::string_view verb, std::vector<AuthoredBody> bodies);
  void perform(std::string name, std::unique_ptr<Change> change, SharedIds selected_after);
  void forgetOldest();
  [[nodiscard]] std::string nameOf(std::string_view verb, std::size_t bodies) const;

  AuthoredScene scene_;
  SharedIds selection_;
  std::size_t history_bytes_;
  std::deque<std::unique_ptr<Step>> history_;  ///< the first done_ are done, the others undone
  std::size_t done_ = 0;
  bool in_gesture_ = false;
  bool gesture_has_step_ = false;
  std::string gesture_name_;
  std::uint64_t last_revision_ = 0;
  std::uint64_t first_revision_ = 0;  ///< before the oldest step that is kept
  std::uint64_t saved_revision_ = 0;
};

}  // namespace broadmark::scenes
