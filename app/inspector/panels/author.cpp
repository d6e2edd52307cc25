// Putting a scene together: its file, brushes, the selected bodies, how it is simulated.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

Numbers numbers(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 vec(const Numbers& n) {
  return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
}

/// Several buttons side by side that share the width.
class ButtonRow {
 public:
  ButtonRow(Ui& ui, int count) : ui_(&ui), count_(count) {
    const float gaps = ImGui::GetStyle().ItemSpacing.x * static_cast<float>(count - 1);
    width_ = std::floor((ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(count));
    width_ = std::max(width_, 1.0F);
  }
  bool button(const char* label, const char* tooltip, bool enabled = true) {
    if (drawn_++ % count_ != 0) ImGui::SameLine();
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ui_->button(label, tooltip, width_);
    ImGui::EndDisabled();
    return pressed;
  }

 private:
  Ui* ui_;
  int count_;
  int drawn_ = 0;
  float width_ = 0;
};

/// The text of the inputs until it is entered.
struct Inputs {
  std::string name;
  Numbers world_min{};
  Numbers world_max{};
  scenes::AuthoredParameters parameters;
  Numbers size{};
  bool sphere = false;
  double mass = 1;
  bool frozen = false;
  Numbers velocity{};
  Numbers spin{};
  double layer = 0;
  double appears = 0;
  double vanishes = 0;   ///< 0: never
  bool grouped = false;  ///< any of them
};

class AuthorPanel final : public Panel {
 public:
  AuthorPanel() : Panel("Author", Place::left, "Putting a scene together, body by body") {}

  void draw(PanelContext& context) override {
    Session& session = context.session;
    reload(session);
    drawFile(context);
    drawState(context.ui, session);
    drawBrush(context.ui, session);
    drawSelection(context.ui, session);
    drawSteps(context.ui, session.document.desk.tools);
    drawScene(context.ui, session);
    while (!changes_.empty()) {
      const auto change = std::move(changes_.front());
      changes_.erase(changes_.begin());
      session.document.edit(change);
    }
  }

 private:
  /// Done once the panel is drawn.
  void edit(std::function<void(SceneEditor&)> change) { changes_.push_back(std::move(change)); }

  template <class Value>
  void set(const char* verb, Value AuthoredBody::*property, const Value& value) {
    edit([=](SceneEditor& editor) { editor.set(verb, property, value); });
  }

  /// Takes over what the document says, if that has changed.
  void reload(const Session& session) {
    const SceneEditor& editor = session.document.desk.editor;
    const bool same = known_ && revision_ == editor.revision() &&
                      name_ == session.document.desk.title() && selection_ == editor.selection();
    if (same) return;
    known_ = true;
    revision_ = editor.revision();
    name_ = session.document.desk.title();
    selection_ = editor.selection();
    const scenes::AuthoredScene& scene = editor.scene();
    inputs_ = {.name = scene.name, .parameters = scenes::AuthoredParameters(scene.parameters)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inputs_.world_min[axis] = scene.world.min[axis];
      inputs_.world_max[axis] = scene.world.max[axis];
    }
    if (selection_.empty()) return;
    inputs_.grouped = std::ranges::any_of(
        selection_, [&](std::uint32_t id) { return scene.bodies[id].group != 0; });
    const scenes::AuthoredBody& body = scene.bodies[selection_.front()];
    inputs_.sphere = std::holds_alternative<scenes::SphereShape>(body.shape);
    inputs_.size = numbers(scenes::edgesOf(body.shape));
    inputs_.mass = body.mass;
    inputs_.frozen = body.frozen;
    inputs_.velocity = numbers(body.linear_velocity);
    inputs_.spin = numbers(body.angular_velocity);
    inputs_.layer = body.layer;
    inputs_.appears = body.appears;
    inputs_.vanishes = body.vanishes == scenes::kNever ? 0 : body.vanishes;
  }

  static void drawFile(PanelContext& context) {
    Ui& ui = context.ui;
    Session& session = context.session;
    ButtonRow first(ui, 2);
    if (first.button("New", "An empty scene")) {
      session.document.leave([&session] { session.document.start({}); });
    }
    if (first.button("From this frame", "Makes a scene of the frame that is shown",
                     session.playback.footage() && !session.document.atRest())) {
      session.document.leave([&session] { session.document.startFromFrame(); });
    }
    ButtonRow second(ui, 3);
    if (second.button("Open…", "Opens a scene (.json)")) askOpenScene(context.files, session);
    if (second.button("Save", "Saves the scene (Ctrl+S)")) saveScene(context.files, session);
    if (second.button("Save as…", "Saves the scene in another file")) {
      askSaveScene(context.files, session);
    }
    const SceneEditor& editor = session.document.desk.editor;
    ButtonRow third(ui, 2);
    const auto tip = [](const char* key, const std::string& name) {
      return name.empty() ? std::string(key) : fmt::format("{} ({})", name, key);
    };
    if (third.button("Undo", tip("Ctrl+Z", editor.undoName()).c_str(), editor.canUndo())) {
      session.document.edit(&SceneEditor::undo);
    }
    if (third.button("Redo", tip("Ctrl+Shift+Z", editor.redoName()).c_str(), editor.canRedo())) {
      session.document.edit(&SceneEditor::redo);
    }
    ButtonRow fourth(ui, 2);
    const bool bodies = !editor.scene().bodies.empty();
    if (fourth.button("Simulate", "Moves the scene on, frame by frame as it is watched (Space)",
                      bodies)) {
      session.document.simulate();
      session.play(true);
    }
    BackgroundBake& bake = session.jobs.get<BackgroundBake>();
    if (bake.running()) {
      const std::string label =
          fmt::format("Cancel ({:.0f} %)###Cancel", 100 * bake.report().fraction);
      if (fourth.button(label.c_str(), "Leaves no recording behind")) bake.cancel();
    } else if (fourth.button("Bake…", "Writes all frames into a recording, in the background",
                             bodies)) {
      askBakeScene(context.files, session);
    }
  }

  static void drawState(Ui& ui, Session& session) {
    const AuthorDesk& desk = session.document.desk;
    ImGui::Spacing();
    ui.fact("scene", desk.title() + (desk.isModified() ? " *" : ""));
    ui.fact("bodies", fmt::format("{}, {} selected", desk.editor.scene().bodies.size(),
                                  desk.editor.selection().size()));
    ImGui::BeginDisabled(session.document.atRest());
    if (ui.button(session.document.shown() ? "Back to the start###show" : "Show the scene###show",
                  "Shows the bodies where they start", ImGui::GetContentRegionAvail().x)) {
      session.document.show();
    }
    ImGui::EndDisabled();
  }

  static void drawBrush(Ui& ui, Session& session) {
    if (!ImGui::CollapsingHeader("Brush", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const auto scope = ui.scope("Brush");
    ImGui::PushID("brush");
    AuthorDesk& desk = session.document.desk;
    std::vector<std::string> ids;
    for (const scenes::BrushEntry& entry : desk.brushes) ids.push_back(entry.listing.id);
    std::size_t chosen = desk.chosenBrush();
    if (ui.combo("brush", chosen, ids, desk.brushes[chosen].listing.summary.c_str())) {
      desk.chooseBrush(chosen);
    }
    ui.parameters(desk.brush());
    Numbers at = numbers(desk.paint_at);
    ui.vector("at", at, -kFar, kFar, "The point that is painted at, in world units");
    desk.paint_at = vec(at);
    ui.parameters(desk.paint);
    if (ui.button("Add", "Paints once, and selects what was added",
                  ImGui::GetContentRegionAvail().x)) {
      session.document.add([&desk] { return desk.stroke(); });
    }
    ImGui::PopID();
  }

  void drawSelection(Ui& ui, Session& session) {
    if (!ImGui::CollapsingHeader("Selection", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const auto scope = ui.scope("Selection");
    ImGui::PushID("selection");
    const bool any = !selection_.empty();
    ButtonRow choose(ui, 2);
    if (choose.button("All", "Selects all bodies (Ctrl+A)")) edit(&SceneEditor::selectAll);
    if (choose.button("None", "Selects nothing (Escape)", any)) edit(&SceneEditor::selectNone);
    if (any) {
      drawPlaces(ui, session);
      drawProperties(ui);
    } else {
      ui.faintParagraph(
          "Click a body in the view to select it; drag with Shift to select several.");
    }
    ImGui::PopID();
  }

  void drawPlaces(Ui& ui, Session& session) {
    ui.vector("by", by_, -kFar, kFar, "How far Move and Duplicate go, in world units");
    ui.number("factor", factor_, 1e-6, 1e6, "Of Scale: on sizes and distances to the centre");
    ButtonRow row(ui, 2);
    if (row.button("Move", "Moves the selected bodies")) {
      edit([by = vec(by_)](SceneEditor& editor) { editor.move(by); });
    }
    if (row.button("Scale", "Scales places and sizes about the common centre")) {
      edit([f = static_cast<float>(factor_)](SceneEditor& editor) { editor.scale(f); });
    }
    if (row.button("Duplicate", "Copies the selected bodies, moved")) {
      edit([by = vec(by_)](SceneEditor& editor) { editor.duplicate(by); });
    }
    if (row.button("Delete", "Deletes the selected bodies (Delete)")) edit(&SceneEditor::erase);
    const bool several = selection_.size() > 1;
    if (row.button("Group", "A click on one selects all of them, with Alt only the one (Ctrl+G)",
                   several)) {
      edit(&SceneEditor::group);
    }
    if (row.button("Ungroup", "Each is selected for itself (Ctrl+Shift+G)", inputs_.grouped)) {
      edit(&SceneEditor::ungroup);
    }
    if (row.button("Fly there", "Looks at the selected bodies (F)")) {
      session.selection.flyThere();
    }
    if (row.button("Paint here", "The brush paints at the centre of the selection")) {
      session.document.desk.paint_at = session.document.desk.editor.selectionCentre();
    }
    drawAlignments(ui);
  }

  /// A row for each axis.
  void drawAlignments(Ui& ui) {
    using Alignment = SceneEditor::Alignment;
    constexpr std::pair<Alignment, const char*> kAlignments[] = {
        {Alignment::low, "low"}, {Alignment::middle, "middle"}, {Alignment::high, "high"}};
    if (selection_.size() < 2) return;
    const auto scope = ui.scope("align");
    ButtonRow row(ui, 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const auto& [alignment, name] : kAlignments) {
        const std::string label = fmt::format("{} {}", "xyz"[axis], name);
        if (row.button(label.c_str(), "Lines the selected bodies up, by their tight boxes")) {
          edit([axis, alignment = alignment](SceneEditor& editor) {
            editor.align(axis, alignment);
          });
        }
      }
    }
  }

  void drawProperties(Ui& ui) {
    if (selection_.size() == 1) {
      ui.heading(fmt::format("Body {}", selection_.front()).c_str());
    } else {
      ui.heading(fmt::format("{} bodies; values of body {}", selection_.size(), selection_.front())
                     .c_str());
    }
    std::size_t shape = inputs_.sphere ? 1 : 0;
    if (ui.combo("shape", shape, {"box", "sphere"})) {
      edit(shape == 1 ? &SceneEditor::makeSpheres : &SceneEditor::makeBoxes);
    }
    if (ui.vector("size", inputs_.size, scenes::kLeastEdge, scenes::kMostEdge,
                  "Edges, in world units; of a sphere the first is the diameter")) {
      edit([size = vec(inputs_.size)](SceneEditor& editor) { editor.setSize(size); });
    }
    if (ui.number("mass", inputs_.mass, 1e-6, 1e9)) {
      set("set the mass of", &AuthoredBody::mass, inputs_.mass);
    }
    if (ui.checkbox("frozen", inputs_.frozen, "An immovable obstacle")) {
      set(inputs_.frozen ? "freeze" : "unfreeze", &AuthoredBody::frozen, inputs_.frozen);
    }
    if (ui.vector("velocity", inputs_.velocity, -kFast, kFast, "World units per second")) {
      set("set the velocity of", &AuthoredBody::linear_velocity, vec(inputs_.velocity));
    }
    if (ui.vector("spin", inputs_.spin, -kFast, kFast,
                  "Angular velocity about each axis, in radians per second")) {
      set("set the spin of", &AuthoredBody::angular_velocity, vec(inputs_.spin));
    }
    drawPresence(ui);
  }

  void drawPresence(Ui& ui) {
    if (ui.number("layer", inputs_.layer, 0, LayerMatrix::kLayers - 1,
                  "Which layers collide is in the scene's file")) {
      set("set the layer of", &AuthoredBody::layer, static_cast<std::uint8_t>(inputs_.layer));
    }
    if (ui.number("appears", inputs_.appears, 0, kMostFrames, "The first frame that it is in")) {
      set("set the first frame of", &AuthoredBody::appears,
          static_cast<std::uint32_t>(inputs_.appears));
      known_ = false;  // a frame that is refused does not stay
    }
    if (ui.number("vanishes", inputs_.vanishes, 0, kMostFrames,
                  "The first frame after that which it is not in; 0: it stays")) {
      const auto frame = static_cast<std::uint32_t>(inputs_.vanishes);
      set("set the last frame of", &AuthoredBody::vanishes, frame == 0 ? scenes::kNever : frame);
      known_ = false;
    }
  }

  static void drawSteps(Ui& ui, Tools& tools) {
    if (!ImGui::CollapsingHeader("Steps")) return;
    const auto scope = ui.scope("Steps");
    ImGui::PushID("steps");
    ui.number("move by", tools.move_step, 1e-6, 1e6,
              "Step of the gizmo when it snaps, in world units");
    ui.number("turn by", tools.turn_step, 0.1, 180, "Likewise, in degrees");
    ui.number("scale by", tools.scale_step, 0.01, 10, "Likewise, of the factor");
    ImGui::PopID();
  }

  void drawScene(Ui& ui, const Session& session) {
    if (!ImGui::CollapsingHeader("Whole scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const auto scope = ui.scope("Whole scene");
    ImGui::PushID("scene");
    if (ui.text("name", inputs_.name)) {
      edit([name = inputs_.name](SceneEditor& editor) { editor.setName(name); });
      known_ = false;  // a name that is refused does not stay
    }
    const bool low = ui.vector("world min", inputs_.world_min, -kFar, kFar, "Walls stand there");
    const bool high = ui.vector("world max", inputs_.world_max, -kFar, kFar, "Walls stand there");
    if (low || high) {
      const Vec3 min = vec(inputs_.world_min);
      const Vec3 max = vec(inputs_.world_max);
      edit([min, max](SceneEditor& editor) {
        editor.setWorld({{min[0], min[1], min[2], 0}, {max[0], max[1], max[2], 0}});
      });
      known_ = false;
    }
    if (ui.parameters(inputs_.parameters)) enterParameters(session.document.desk.editor);
    ImGui::PopID();
  }

  void enterParameters(const SceneEditor& editor) {
    scenes::AuthoredParameters before(editor.scene().parameters);
    ParameterValues changed = changedValues(inputs_.parameters.values(), before);
    // Another engine comes with parameters of its own, which keep their defaults.
    if (const auto engine = changed.find("engine"); engine != changed.end()) changed = {*engine};
    edit([changed](SceneEditor& e) { e.setParameters(changed); });
  }

  bool known_ = false;  ///< whether the inputs are those of:
  std::uint64_t revision_ = 0;
  std::string name_;
  scenes::BodyIds selection_;
  Inputs inputs_;
  Numbers by_ = {1, 0, 0};
  double factor_ = 2;
  std::vector<std::function<void(SceneEditor&)>> changes_;
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<AuthorPanel>(); }

}  // namespace broadmark::panels::author
