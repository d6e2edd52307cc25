// Putting a scene together: its file, brushes, the selected bodies, how it is simulated.

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

constexpr double kFar = 1e9;
constexpr double kFast = 1e6;

template <class Vector>
Numbers numbers(const Vector& v) {
  return {v[0], v[1], v[2]};
}
Vec3 vec(const Numbers& n) {
  return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
}

/// The text of the inputs until it is entered.
struct Inputs {
  std::string name;
  Numbers world_min{};
  Numbers world_max{};
  scenes::AuthoredParameters parameters;
  scenes::AuthoredBody body;  ///< the first selected one
  Numbers size{};
  Numbers velocity{};
  Numbers spin{};
  double layer = 0;
  double appears = 0;
  double vanishes = 0;   ///< 0: never
  bool grouped = false;  ///< any of them
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
    drawSteps();
    drawScene();
  }

 private:
  /// Changes the document if a button was `pressed` or a value entered. What is refused does not
  /// stay in the inputs.
  void edit(bool pressed, const std::function<void(SceneEditor&)>& change) {
    if (!pressed) return;
    document_.edit(change);
    known_ = false;
  }

  template <class Value>
  void set(bool entered, const char* verb, Value AuthoredBody::*property, const Value& value) {
    edit(entered, [&](SceneEditor& editor) { editor.set(verb, property, value); });
  }

  /// Takes over what the document says, if that has changed.
  void reload() {
    const SceneEditor& editor = document_.editor;
    const bool same = known_ && revision_ == editor.revision() && name_ == document_.title() &&
                      selection_ == editor.selection();
    if (same) return;
    known_ = true;
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
    inputs_.size = numbers(scenes::edgesOf(body.shape));
    inputs_.velocity = numbers(body.linear_velocity);
    inputs_.spin = numbers(body.angular_velocity);
    inputs_.layer = body.layer;
    inputs_.appears = body.appears;
    inputs_.vanishes = body.vanishes == scenes::kNever ? 0 : body.vanishes;
  }

  void drawFile() {
    ButtonRow first(ui, 2);
    if (first.button("New", "An empty scene")) {
      document_.leave([this] { document_.start({}); });
    }
    if (first.button("From this frame", "Makes a scene of the frame that is shown",
                     session.playback.source() && !document_.atRest())) {
      document_.leave([this] { document_.startFromFrame(); });
    }
    ButtonRow second(ui, 3);
    if (second.button("Open…", "Opens a scene (.json)")) askOpenScene(files, session);
    if (second.button("Save", "Saves the scene (Ctrl+S)")) saveScene(files, session);
    if (second.button("Save as…", "Saves the scene in another file")) {
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
    if (fourth.button("Simulate", "Moves the scene on, frame by frame as it is watched (Space)",
                      bodies)) {
      document_.simulate();
      session.play(true);
    }
    BackgroundBake& bake = session.jobs.get<BackgroundBake>();
    if (bake.running()) {
      const std::string label =
          fmt::format("Cancel ({:.0f} %)###Cancel", 100 * bake.report().fraction);
      if (fourth.button(label.c_str(), "Leaves no recording behind")) bake.cancel();
    } else if (fourth.button("Bake…", "Writes all frames into a recording, in the background",
                             bodies)) {
      askBakeScene(files, session);
    }
  }

  void drawState() {
    ImGui::Spacing();
    ui.fact("scene", document_.title() + (document_.isModified() ? " *" : ""));
    ui.fact("bodies", fmt::format("{}, {} selected", document_.editor.scene().bodies.size(),
                                  document_.editor.selection().size()));
    if (wideButton(document_.shown() ? "Back to the start###show" : "Show the scene###show",
                   "Shows the bodies where they start", !document_.atRest())) {
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
    ui.vector("at", at, -kFar, kFar, "The point that is painted at, in world units");
    document_.paint_at = vec(at);
    ui.parameters(document_.paint);
    if (wideButton("Add", "Paints once, and selects what was added")) {
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
    edit(choose.button("All", "Selects all bodies (Ctrl+A)"), &SceneEditor::selectAll);
    edit(choose.button("None", "Selects nothing (Escape)", any), &SceneEditor::selectNone);
    if (any) {
      drawPlaces();
      drawProperties();
    } else {
      ui.faintParagraph(
          "Click a body in the view to select it; drag with Shift to select several.");
    }
    ImGui::PopID();
  }

  void drawPlaces() {
    ui.vector("by", by_, -kFar, kFar, "How far Move and Duplicate go, in world units");
    ui.number("factor", factor_, 1e-6, 1e6, "Of Scale: on sizes and distances to the centre");
    ButtonRow row(ui, 2);
    edit(row.button("Move", "Moves the selected bodies"),
         [&](SceneEditor& editor) { editor.move(vec(by_)); });
    edit(row.button("Scale", "Scales places and sizes about the common centre"),
         [&](SceneEditor& editor) { editor.scale(static_cast<float>(factor_)); });
    edit(row.button("Duplicate", "Copies the selected bodies, moved"),
         [&](SceneEditor& editor) { editor.duplicate(vec(by_)); });
    edit(row.button("Delete", "Deletes the selected bodies (Delete)"), &SceneEditor::erase);
    const bool several = selection_.size() > 1;
    edit(row.button("Group", "A click on one selects all of them, with Alt only the one (Ctrl+G)",
                    several),
         &SceneEditor::group);
    edit(row.button("Ungroup", "Each is selected for itself (Ctrl+Shift+G)", inputs_.grouped),
         &SceneEditor::ungroup);
    if (row.button("Fly there", "Looks at the selected bodies (F)")) {
      session.selection.flyThere();
    }
    if (row.button("Paint here", "The brush paints at the centre of the selection")) {
      document_.paint_at = document_.editor.selectionCentre();
    }
    if (several) drawAlignments();
  }

  /// A row for each axis.
  void drawAlignments() {
    using Alignment = SceneEditor::Alignment;
    constexpr std::pair<Alignment, const char*> kAlignments[] = {
        {Alignment::low, "low"}, {Alignment::middle, "middle"}, {Alignment::high, "high"}};
    const auto scope = ui.scope("align");
    ButtonRow row(ui, 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const auto& [alignment, name] : kAlignments) {
        const std::string label = fmt::format("{} {}", "xyz"[axis], name);
        edit(row.button(label.c_str(), "Lines the selected bodies up, by their tight boxes"),
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
    edit(ui.vector("size", inputs_.size, scenes::kMinEdge, scenes::kMaxEdge,
                   "Edges, in world units; of a sphere the first is the diameter"),
         [&](SceneEditor& editor) { editor.setSize(vec(inputs_.size)); });
    set(ui.number("mass", inputs_.body.mass, 1e-6, 1e9), "set the mass of", &AuthoredBody::mass,
        inputs_.body.mass);
    set(ui.checkbox("frozen", inputs_.body.frozen, "An immovable obstacle"),
        inputs_.body.frozen ? "freeze" : "unfreeze", &AuthoredBody::frozen, inputs_.body.frozen);
    set(ui.vector("velocity", inputs_.velocity, -kFast, kFast, "World units per second"),
        "set the velocity of", &AuthoredBody::linear_velocity, vec(inputs_.velocity));
    set(ui.vector("spin", inputs_.spin, -kFast, kFast,
                  "Angular velocity about each axis, in radians per second"),
        "set the spin of", &AuthoredBody::angular_velocity, vec(inputs_.spin));
    set(ui.number("layer", inputs_.layer, 0, LayerMatrix::kLayers - 1,
                  "Which layers collide is in the scene's file"),
        "set the layer of", &AuthoredBody::layer, static_cast<std::uint8_t>(inputs_.layer));
    set(ui.number("appears", inputs_.appears, 0, kMaxFrames, "The first frame that it is in"),
        "set the first frame of", &AuthoredBody::appears,
        static_cast<std::uint32_t>(inputs_.appears));
    const bool vanishes = ui.number("vanishes", inputs_.vanishes, 0, kMaxFrames,
                                    "The first frame after that which it is not in; 0: it stays");
    const auto frame = static_cast<std::uint32_t>(inputs_.vanishes);
    set(vanishes, "set the last frame of", &AuthoredBody::vanishes,
        frame == 0 ? scenes::kNever : frame);
  }

  void drawSteps() {
    if (!ImGui::CollapsingHeader("Steps")) return;
    const auto scope = ui.scope("Steps");
    ImGui::PushID("steps");
    ui.number("move by", document_.tools.move_step, 1e-6, 1e6,
              "Step of the gizmo when it snaps, in world units");
    ui.number("turn by", document_.tools.turn_step, 0.1, 180,
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
    const bool low = ui.vector("world min", inputs_.world_min, -kFar, kFar, "Walls stand there");
    const bool high = ui.vector("world max", inputs_.world_max, -kFar, kFar, "Walls stand there");
    edit(low || high, [&](SceneEditor& editor) {
      const Vec3 min = vec(inputs_.world_min);
      const Vec3 max = vec(inputs_.world_max);
      editor.setWorld({{min[0], min[1], min[2], 0}, {max[0], max[1], max[2], 0}});
    });
    edit(ui.parameters(inputs_.parameters), [&](SceneEditor& editor) {
      scenes::AuthoredParameters before(editor.scene().parameters);
      ParameterValues changed = changedValues(inputs_.parameters.values(), before);
      // Another engine comes with parameters of its own, which keep their defaults.
      if (const auto engine = changed.find("engine"); engine != changed.end()) changed = {*engine};
      editor.setParameters(changed);
    });
    ImGui::PopID();
  }

  Document& document_ = session.document;
  bool known_ = false;  ///< whether the inputs are those of:
  std::uint64_t revision_ = 0;
  std::string name_;
  scenes::BodyIds selection_;
  Inputs inputs_;
  Numbers by_ = {1, 0, 0};
  double factor_ = 2;
};

}  // namespace

extern const PanelKind kind = {"Author", DockArea::left, "Putting a scene together, body by body",
                               make<AuthorPanel>};

}  // namespace broadmark::panels::author
