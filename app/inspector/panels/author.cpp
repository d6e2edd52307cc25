// Authoring of a scene: file, brushes, selected bodies, simulation parameters.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "broadmark/scenes/authored_simulation.h"
#include "inspector/authoring/author_dialogs.h"
#include "inspector/panels/panel.h"

namespace broadmark::panels::author {
namespace {

using scenes::AuthoredBody;
using scenes::SceneEditor;
using Numbers = std::array<double, 3>;

constexpr double kMaxCoordinate = 1e9;
constexpr double kMaxVelocity = 1e6;

template <class Vector>
Numbers numbers(const Vector& v) {
  return {v[0], v[1], v[2]};
}
Vec3 vec(const Numbers& n) {
  return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
}

/// Values of the inputs until they are committed.
struct Inputs {
  std::string name;
  Numbers world_min{};
  Numbers world_max{};
  scenes::AuthoredParameters parameters;
  scenes::AuthoredBody body;  ///< the first selected body
  Numbers position{};
  Numbers angles{};
  Numbers size{};
  Numbers velocity{};
  Numbers spin{};
  double layer = 0;
  double appears = 0;
  double vanishes = 0;   ///< 0: never
  bool grouped = false;  ///< any selected body
};

class AuthorPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    reload();
    drawFile();
    drawState();
    drawBrush();
    drawSelection();
    drawBodies();
    drawSteps();
    drawScene();
  }

 private:
  /// Changes the document if `requested`; reloads the inputs to discard rejected values.
  void edit(bool requested, const std::function<void(SceneEditor&)>& change) {
    if (!requested) return;
    document_.edit(change);
    loaded_ = false;
  }

  template <class Value>
  void set(bool entered, const char* verb, Value AuthoredBody::* property, const Value& value) {
    edit(entered, [&](SceneEditor& editor) { editor.set(verb, property, value); });
  }

  /// Loads the inputs from the document if it has changed.
  void reload() {
    const SceneEditor& editor = document_.editor;
    const bool current = loaded_ && revision_ == editor.revision() && name_ == document_.title() &&
                         selection_ == editor.selection();
    if (current) return;
    loaded_ = true;
    revision_ = editor.revision();
    name_ = document_.title();
    selection_ = editor.selection();
    const scenes::AuthoredScene& scene = editor.scene();
    inputs_ = {.name = scene.name,
               .world_min = numbers(scene.world.min),
               .world_max = numbers(scene.world.max),
               .parameters = scenes::AuthoredParameters(scene.parameters)};
    if (selection_.empty()) return;
    inputs_.grouped = std::ranges::any_of(
        selection_, [&](std::uint32_t id) { return scene.bodies[id].group != 0; });
    const scenes::AuthoredBody& body = scene.bodies[selection_.front()];
    inputs_.body = body;
    inputs_.position = numbers(body.pose.position);
    inputs_.angles = numbers(scenes::anglesOf(body.pose.rotation));
    inputs_.size = numbers(scenes::edgesOf(body.shape));
    inputs_.velocity = numbers(body.linear_velocity);
    inputs_.spin = numbers(body.angular_velocity);
    inputs_.layer = body.layer;
    inputs_.appears = body.appears;
    inputs_.vanishes = body.vanishes == scenes::kNever ? 0 : body.vanishes;
  }

  void drawFile() {
    ButtonRow first(ui, 2);
    if (first.button("New", "Start an empty scene")) {
      document_.closeThen([this] { document_.load({}); });
    }
    if (first.button("From this frame", "Make a scene of the shown frame",
                     session.playback.source() && !document_.atRest())) {
      document_.closeThen([this] { document_.loadCurrentFrame(); });
    }
    ButtonRow second(ui, 3);
    if (second.button("Open…", "Open a scene (.json)")) askOpenScene(files, session);
    if (second.button("Save", "Save the scene (Ctrl+S)")) saveScene(files, session);
    if (second.button("Save as…", "Save the scene to another file")) {
      askSaveScene(files, session);
    }
    const SceneEditor& editor = document_.editor;
    ButtonRow third(ui, 2);
    const auto tip = [](const char* key, const std::string& name) {
      return name.empty() ? std::string(key) : fmt::format("{} ({})", name, key);
    };
    edit(third.button("Undo", tip("Ctrl+Z", editor.undoName()).c_str(), editor.canUndo()),
         &SceneEditor::undo);
    edit(third.button("Redo", tip("Ctrl+Shift+Z", editor.redoName()).c_str(), editor.canRedo()),
         &SceneEditor::redo);
    ButtonRow fourth(ui, 2);
    const bool bodies = !editor.scene().bodies.empty();
    if (fourth.button("Simulate", "Simulate the scene, frame by frame as it is shown (Space)",
                      bodies)) {
      document_.simulate();
      session.play(true);
    }
    BackgroundBake& bake = session.jobs.get<BackgroundBake>();
    if (bake.running()) {
      const std::string label =
          fmt::format("Cancel ({:.0f} %)###Cancel", 100 * bake.report().fraction);
      if (fourth.button(label.c_str(), "Stop; no recording is written")) bake.cancel();
    } else if (fourth.button("Bake…", "Write all frames to a recording, in the background",
                             bodies)) {
      askBakeScene(files, session);
    }
  }

  void drawState() {
    ImGui::Spacing();
    ui.valueRow("scene", document_.title() + (document_.isModified() ? " *" : ""));
    ui.valueRow("bodies", fmt::format("{}, {} selected", document_.editor.scene().bodies.size(),
                                      document_.editor.selection().size()));
    if (wideButton(document_.shown() ? "Back to the start###show" : "Show the scene###show",
                   "Show the bodies at their initial positions", !document_.atRest())) {
      document_.show();
    }
  }

  void drawBrush() {
    if (!ImGui::CollapsingHeader("Brush", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const auto scope = ui.scope("Brush");
    ImGui::PushID("brush");
    std::vector<std::string> ids;
    for (const scenes::BrushEntry& entry : document_.brushes) ids.push_back(entry.listing.id);
    std::size_t chosen = document_.chosenBrush();
    if (ui.combo("brush", chosen, ids, document_.brushes[chosen].listing.summary.c_str())) {
      document_.chooseBrush(chosen);
    }
    ui.parameters(document_.brush());
    Numbers at = numbers(document_.paint_at);
    ui.vector("at", at, -kMaxCoordinate, kMaxCoordinate, "Point to paint at, in world units");
    document_.paint_at = vec(at);
    ui.parameters(document_.paint);
    if (wideButton("Add", "Paint once, and select the added bodies")) {
      document_.add([this] { return document_.stroke(); });
    }
    ImGui::PopID();
  }

  void drawSelection() {
    if (!ImGui::CollapsingHeader("Selection", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const auto scope = ui.scope("Selection");
    ImGui::PushID("selection");
    const bool any = !selection_.empty();
    ButtonRow choose(ui, 2);
    edit(choose.button("All", "Select all bodies (Ctrl+A)"), &SceneEditor::selectAll);
    edit(choose.button("None", "Deselect all bodies (Escape)", any), &SceneEditor::selectNone);
    if (any) {
      drawTransforms();
      drawProperties();
    } else {
      ui.faintParagraph(
          "Click a body in the view to select it; drag with Shift to select several.");
    }
    ImGui::PopID();
  }

  void drawTransforms() {
    ui.vector("by", by_, -kMaxCoordinate, kMaxCoordinate,
              "Offset for Move and Duplicate, in world units");
    ui.number("factor", factor_, 1e-6, 1e6,
              "Factor for Scale: of sizes and of distances from the centre");
    ButtonRow row(ui, 2);
    edit(row.button("Move", "Move the selected bodies"),
         [&](SceneEditor& editor) { editor.move(vec(by_)); });
    edit(row.button("Scale", "Scale positions and sizes about the common centre"),
         [&](SceneEditor& editor) { editor.scale(static_cast<float>(factor_)); });
    edit(row.button("Duplicate", "Copy the selected bodies, with an offset"),
         [&](SceneEditor& editor) { editor.duplicate(vec(by_)); });
    edit(row.button("Delete", "Delete the selected bodies (Delete)"), &SceneEditor::erase);
    const bool several = selection_.size() > 1;
    edit(row.button("Group", "Let a click select the whole group, Alt+click a single body (Ctrl+G)",
                    several),
         &SceneEditor::group);
    edit(row.button("Ungroup", "Let a click select a single body again (Ctrl+Shift+G)",
                    inputs_.grouped),
         &SceneEditor::ungroup);
    if (row.button("Fly there", "Move the camera to the selected bodies (F)")) {
      session.selection.flyToSelection();
    }
    if (row.button("Paint here", "Set the brush's point to the centre of the selection")) {
      document_.paint_at = document_.editor.selectionCentre();
    }
    if (several) drawAlignments();
  }

  /// Draws a row of buttons for each axis.
  void drawAlignments() {
    using Alignment = SceneEditor::Alignment;
    constexpr std::pair<Alignment, const char*> kAlignments[] = {
        {Alignment::low, "low"}, {Alignment::middle, "middle"}, {Alignment::high, "high"}};
    ui.heading("Align");
    const auto scope = ui.scope("align");
    ButtonRow row(ui, 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const auto& [alignment, name] : kAlignments) {
        const std::string label = fmt::format("{} {}", "xyz"[axis], name);
        edit(row.button(label.c_str(), "Align the selected bodies by their tight boxes"),
             [&, to = alignment](SceneEditor& editor) { editor.align(axis, to); });
      }
    }
  }

  void drawProperties() {
    const std::uint32_t first = selection_.front();
    ui.heading(selection_.size() == 1
                   ? fmt::format("Body {}", first).c_str()
                   : fmt::format("{} bodies; values of body {}", selection_.size(), first).c_str());
    std::size_t shape = inputs_.body.shape.index();
    edit(ui.combo("shape", shape, {"box", "sphere"}),
         [&](SceneEditor& editor) { shape == 1 ? editor.makeSpheres() : editor.makeBoxes(); });
    edit(ui.vector("position", inputs_.position, -kMaxCoordinate, kMaxCoordinate,
                   "Centre of the first selected body; the others move along"),
         [&](SceneEditor& editor) { moveFirstTo(editor, vec(inputs_.position)); });
    edit(ui.vector("rotation", inputs_.angles, -360, 360,
                   "Angles in degrees, about the world's axes x, y and z, in this order"),
         [&](SceneEditor& editor) {
           editor.change("rotate", [&](AuthoredBody& body) {
             body.pose.rotation = scenes::rotationBy(vec(inputs_.angles));
           });
         });
    edit(ui.vector("size", inputs_.size, scenes::kMinEdge, scenes::kMaxEdge,
                   "Edge lengths in world units; for a sphere the first is the diameter"),
         [&](SceneEditor& editor) { editor.setSize(vec(inputs_.size)); });
    set(ui.number("mass", inputs_.body.mass, 1e-6, 1e9), "set the mass of", &AuthoredBody::mass,
        inputs_.body.mass);
    set(ui.checkbox("frozen", inputs_.body.frozen, "Make the bodies immovable obstacles"),
        inputs_.body.frozen ? "freeze" : "unfreeze", &AuthoredBody::frozen, inputs_.body.frozen);
    set(ui.vector("velocity", inputs_.velocity, -kMaxVelocity, kMaxVelocity,
                  "World units per second"),
        "set the velocity of", &AuthoredBody::linear_velocity, vec(inputs_.velocity));
    set(ui.vector("spin", inputs_.spin, -kMaxVelocity, kMaxVelocity,
                  "Angular velocity about each axis, in radians per second"),
        "set the spin of", &AuthoredBody::angular_velocity, vec(inputs_.spin));
    set(ui.number("layer", inputs_.layer, 0, LayerMatrix::kLayers - 1,
                  "Collision layer; the scene's file says which layers collide"),
        "set the layer of", &AuthoredBody::layer, static_cast<std::uint8_t>(inputs_.layer));
    set(ui.number("appears", inputs_.appears, 0, kMaxFrames,
                  "First frame in which the body is present"),
        "set the first frame of", &AuthoredBody::appears,
        static_cast<std::uint32_t>(inputs_.appears));
    const bool vanishes = ui.number("vanishes", inputs_.vanishes, 0, kMaxFrames,
                                    "First later frame in which the body is absent; 0: never");
    const auto frame = static_cast<std::uint32_t>(inputs_.vanishes);
    set(vanishes, "set the last frame of", &AuthoredBody::vanishes,
        frame == 0 ? scenes::kNever : frame);
  }

  static void moveFirstTo(SceneEditor& editor, const Vec3& to) {
    const Vec3 from = editor.scene().bodies[editor.selection().front()].pose.position;
    editor.change("move", [&](AuthoredBody& body) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Exact for the first body.
        body.pose.position[axis] = (body.pose.position[axis] - from[axis]) + to[axis];
      }
    });
  }

  void drawBodies() {
    constexpr float kRows = 10;
    const bool open = ImGui::CollapsingHeader("All bodies");
    ui.note("All bodies");
    if (!open) return;
    const auto scope = ui.scope("All bodies");
    const std::vector<AuthoredBody>& bodies = document_.editor.scene().bodies;
    const float height =
        std::min(static_cast<float>(bodies.size()), kRows) * ImGui::GetTextLineHeightWithSpacing();
    ImGui::BeginChild("bodies", {0, height + 1}, false, ImGuiWindowFlags_NavFlattened);
    clipped(bodies.size(), [&](std::size_t i) {
      const auto id = static_cast<std::uint32_t>(i);
      const Vec3& at = bodies[i].pose.position;
      const char* const shape = bodies[i].shape.index() == 1 ? "sphere" : "box";
      const bool pressed = ui.selectableLine(
          fmt::format("{} {}", shape, i).c_str(), std::ranges::binary_search(selection_, id),
          fmt::format("{:.4g}  {:.4g}  {:.4g}", at[0], at[1], at[2]), ui.theme.faint);
      if (!pressed) return;
      document_.show();
      if (ImGui::GetIO().KeyCtrl) {
        session.selection.toggle({id});
      } else {
        session.selection.select({id});
      }
    });
    ImGui::EndChild();
  }

  void drawSteps() {
    if (!ImGui::CollapsingHeader("Steps")) return;
    const auto scope = ui.scope("Steps");
    ImGui::PushID("steps");
    ui.number("move by", document_.tools.move_step, 1e-6, 1e6,
              "Step of the gizmo when it snaps, in world units");
    ui.number("rotate by", document_.tools.turn_step, 0.1, 180,
              "Rotation step of the gizmo and of the keys, in degrees");
    ui.number("scale by", document_.tools.scale_step, 0.01, 10,
              "Scale step of the gizmo and of the keys, as a factor");
    ImGui::PopID();
  }

  void drawScene() {
    if (!ImGui::CollapsingHeader("Whole scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const auto scope = ui.scope("Whole scene");
    ImGui::PushID("scene");
    edit(ui.text("name", inputs_.name), [&](SceneEditor& editor) { editor.setName(inputs_.name); });
    const bool low = ui.vector("world min", inputs_.world_min, -kMaxCoordinate, kMaxCoordinate,
                               "Lower corner of the walls");
    const bool high = ui.vector("world max", inputs_.world_max, -kMaxCoordinate, kMaxCoordinate,
                                "Upper corner of the walls");
    edit(low || high, [&](SceneEditor& editor) {
      const Vec3 min = vec(inputs_.world_min);
      const Vec3 max = vec(inputs_.world_max);
      editor.setWorld({{min[0], min[1], min[2], 0}, {max[0], max[1], max[2], 0}});
    });
    edit(ui.parameters(inputs_.parameters), [&](SceneEditor& editor) {
      scenes::AuthoredParameters before(editor.scene().parameters);
      ParameterValues changed = changedValues(inputs_.parameters.values(), before);
      // The parameters of another engine get their defaults.
      if (const auto engine = changed.find("engine"); engine != changed.end()) changed = {*engine};
      editor.setParameters(changed);
    });
    ImGui::PopID();
  }

  Document& document_ = session.document;
  bool loaded_ = false;  ///< the inputs, from this state of the document:
  std::uint64_t revision_ = 0;
  std::string name_;
  scenes::BodyIds selection_;
  Inputs inputs_;
  Numbers by_ = {1, 0, 0};
  double factor_ = 2;
};

}  // namespace

extern const PanelSpec spec = {"Author", DockArea::left, "Build a scene, body by body",
                               make<AuthorPanel>};

}  // namespace broadmark::panels::author
