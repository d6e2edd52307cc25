// Draws over the finished picture of the scene, which need not be redrawn while the mouse moves.

#include "inspector/authoring/viewport_manipulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "broadmark/error.h"
#include "broadmark/render/scene_view.h"
#include "support/words.h"

namespace broadmark {
namespace {

// In units.
constexpr float kGizmoLength = 90;
constexpr float kReach = 8;  // largest distance at which a handle is hit
constexpr float kTip = 6;    // half the size of an axis' tip
constexpr float kDabSpacing = 12;

constexpr std::size_t kMaxGhosts = 1000;
constexpr int kMaxDabsAtOnce = 8;  // per picture

Rgb colourOf(Handle handle, const Palette& theme) {
  // A plane has the colour of its normal.
  return handle == Handle::all ? theme.accent : theme.axis[static_cast<std::size_t>(handle) % 3];
}

/// In the shown frame.
Aabb boundsOfSelection(const ViewportManipulator::Input& input) {
  Aabb all = kEmptyBox;
  for (const std::uint32_t id : input.session.document.editor.selection()) {
    all = merged(all, (*input.snapshot->boxes)[id]);
  }
  return all;
}

}  // namespace

void ViewportManipulator::update(const Input& input) {
  const auto& shown = input.session.playback.source();
  const bool edited = source_ != shown;
  if (edited) {
    source_ = shown;
    centred_bodies_.clear();
    stroke_.reset();
    resumes_ = false;
    cancel(input.session);
  }
  text_.clear();
  if (input.snapshot->source == shown) ghosts_.clear();  // otherwise its bodies are not shown yet
  updateGizmo(input);
  updateBrush(input);
}

void ViewportManipulator::updateGizmo(const Input& input) {
  const Document& document = input.session.document;
  const Tools& tools = document.tools;
  const scenes::SceneEditor& editor = document.editor;
  shapes_.clear();
  const bool shown =
      document.shown() && input.snapshot->source == input.session.playback.source() &&
      !editor.selection().empty() && tools.tool != Tool::none && tools.tool != Tool::brush;
  if (!shown) {
    drag_.reset();
    hot_.reset();
    return;
  }
  pose_ = {.centre = centreOf(input)};
  if (drag_ && input.mouse) {
    const GizmoDrag::Outcome outcome = drag_->at(*input.mouse, tools, tools.snaps != input.ctrl);
    change_ = outcome.change;
    text_ = outcome.text;
    std::vector<scenes::AuthoredBody> changed = captured_;
    for (scenes::AuthoredBody& body : changed) {
      body.shape = transformedShape(body, change_);
      body.pose = transformedPose(body, change_);
    }
    ghosts_ = std::move(changed);
    for (std::size_t axis = 0; axis < 3; ++axis) pose_.centre[axis] += change_.move[axis];
  }
  if (tools.local) pose_.rotation = editor.scene().bodies[editor.selection().front()].pose.rotation;
  pose_.length = static_cast<double>(kGizmoLength * input.scale) *
                 input.projection.pixelSizeAt(pointOf(pose_.centre));
  if (!(pose_.length > 0)) return;  // behind the eye
  shapes_ = handleShapes(tools.tool, pose_, input.projection);
  if (drag_) return;
  hot_ = input.mouse ? handleUnder(shapes_, input.projection, *input.mouse, kReach * input.scale)
                     : std::nullopt;
}

Vec3 ViewportManipulator::centreOf(const Input& input) {
  const scenes::SceneEditor& editor = input.session.document.editor;
  if (!input.session.document.atRest()) {
    centred_bodies_.clear();
    const Aabb all = boundsOfSelection(input);
    Vec3 centre{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      centre[axis] = static_cast<float>(broadmark::centreOf(all, axis));
    }
    return isEmpty(all) ? Vec3{} : centre;
  }
  if (centred_bodies_ != editor.selection()) {
    centred_bodies_ = editor.selection();
    centre_ = editor.selectionCentre();
  }
  return centre_;
}

void ViewportManipulator::updateBrush(const Input& input) {
  const Document& document = input.session.document;
  if (document.tools.tool != Tool::brush || !document.atRest()) {
    painting_ = false;
    stroke_.reset();
    return;
  }
  if (!input.mouse) return;
  if (!stroke_) stroke_.emplace(document);
  try {
    if (painting_) {
      paintTo(input, *input.mouse);
    } else {
      previewDab(input);
    }
  } catch (const InputError& error) {
    cancel(input.session);
    text_ = error.what();
  }
}

void ViewportManipulator::previewDab(const Input& input) {
  const std::optional<Surface> surface = surfaceAt(input, *input.mouse);
  if (!surface) return;
  const scenes::Stroke dab = stroke_->dab(*surface, kMaxGhosts);
  ghosts_ = dab.bodies;
  if (dab.bodies.empty()) text_ = "no room here";
}

void ViewportManipulator::paintTo(const Input& input, Pixel to) {
  const Pixel motion = to - painted_at_;
  const float steps = std::ceil(motion.norm() / (kDabSpacing * input.scale));
  const int count = std::clamp(static_cast<int>(steps), 1, kMaxDabsAtOnce);
  for (int i = 1; i <= count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    const auto surface = surfaceAt(input, painted_at_ + share * motion);
    if (surface) stroke_->paint(*surface);
  }
  painted_at_ = to;
  const std::vector<scenes::AuthoredBody>& bodies = stroke_->painted().bodies;
  const std::size_t left_out = bodies.size() - std::min(bodies.size(), kMaxGhosts);
  ghosts_.assign(bodies.begin() + static_cast<std::ptrdiff_t>(left_out), bodies.end());
  text_ = counted(bodies.size(), "body", "bodies");
}

std::optional<Surface> ViewportManipulator::surfaceAt(const Input& input, Pixel pixel) {
  const bool same = last_surface_.snapshot == input.snapshot && last_surface_.pixel == pixel &&
                    last_surface_.viewpoint == input.projection.viewpoint();
  if (!same) {
    last_surface_ = {
        input.snapshot, input.projection.viewpoint(), pixel,
        surfaceUnder(*input.snapshot->boxes, input.session.document.editor.scene().world,
                     input.projection, pixel, input.visible)};
  }
  return last_surface_.surface;
}

void ViewportManipulator::captureBodies(const Input& input) {
  const scenes::SceneEditor& editor = input.session.document.editor;
  captured_.clear();
  if (!input.session.document.atRest()) {
    captured_.push_back(scenes::bodyFilling(boundsOfSelection(input)));
    return;
  }
  const std::vector<scenes::AuthoredBody>& bodies = editor.scene().bodies;
  if (editor.selection().size() <= kMaxGhosts) {
    for (const std::uint32_t id : editor.selection()) captured_.push_back(bodies[id]);
    return;
  }
  Aabb all = kEmptyBox;
  for (const std::uint32_t id : editor.selection()) {
    all = merged(all, tightBox(bodies[id].shape, bodies[id].pose));
  }
  captured_.push_back(scenes::bodyFilling(all));
}

bool ViewportManipulator::press(const Input& input) {
  if (!input.mouse) return false;
  const Document& document = input.session.document;
  if (hot_) {
    captureBodies(input);
    change_ = {};
    resumes_ = input.session.playback.playing();
    input.session.playback.pause();
    drag_.emplace(document.tools.tool, *hot_, pose_, input.projection, *input.mouse);
  } else if (stroke_ && surfaceAt(input, *input.mouse)) {
    painting_ = true;
    painted_at_ = *input.mouse;
  }
  return busy();
}

void ViewportManipulator::release(const Input& input) {
  Document& document = input.session.document;
  if (drag_) {
    drag_.reset();
    if (document.atRest()) {
      document.edit([&](scenes::SceneEditor& editor) {
        editor.transform(kTools.nameOf(document.tools.tool), change_);
      });
    } else {
      document.changeInFrame(change_, resumes_);
    }
  } else if (painting_) {
    painting_ = false;
    document.add([this] { return stroke_->painted(); });
  }
  source_ = input.session.playback.source();  // the ghosts stay until it is shown
  centred_bodies_.clear();
  stroke_.reset();
}

bool ViewportManipulator::cancel(Session& session) {
  if (!busy()) return false;
  if (drag_ && resumes_) session.playback.play(true);
  drag_.reset();
  painting_ = false;
  stroke_.reset();
  ghosts_.clear();
  return true;
}

void ViewportManipulator::draw(Ui& ui, const Input& input, ImVec2 corner) const {
  drawGhosts(ui, input.projection, corner);
  const Tool tool = input.session.document.tools.tool;
  for (const HandleShape& shape : shapes_) {
    drawHandle(ui, shape, input.projection, tool, corner);
    if (const auto grip = input.projection.pixelOf(shape.grip)) {
      const float half = kTip * input.scale;
      const ImVec2 at{corner.x + (*grip)[0], corner.y + (*grip)[1]};
      ui.noteAt(fmt::format("gizmo {}", kHandles.nameOf(shape.handle)), {at.x - half, at.y - half},
                {at.x + half, at.y + half});
    }
  }
  if (text_.empty() || !input.mouse) return;
  ui.glyphs.request(text_);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float pad = 5 * input.scale;
  const ImVec2 extent = ImGui::CalcTextSize(text_.c_str());
  const ImVec2 at{corner.x + (*input.mouse)[0] + 4 * pad, corner.y + (*input.mouse)[1] + 3 * pad};
  draw.AddRectFilled({at.x - pad, at.y - pad / 2},
                     {at.x + extent.x + pad, at.y + extent.y + pad / 2},
                     colour(ui.theme.background, 0.82F), pad);
  draw.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text_.c_str());
}

void ViewportManipulator::drawHandle(const Ui& ui, const HandleShape& shape,
                                     const ViewProjection& projection, Tool tool,
                                     ImVec2 corner) const {
  std::vector<ImVec2> points;
  for (const Point& point : shape.points) {
    if (const auto at = projection.pixelOf(point)) {
      points.push_back({corner.x + (*at)[0], corner.y + (*at)[1]});
    }
  }
  if (points.size() < 2) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const bool hot = hot_ == shape.handle;
  const Rgb rgb = hot ? ui.theme.handle : colourOf(shape.handle, ui.theme);
  const float width = (hot ? 4.0F : 3.0F) * ui.scale;
  const int count = static_cast<int>(points.size());
  if (shape.filled) draw.AddConvexPolyFilled(points.data(), count, colour(rgb, hot ? 0.6F : 0.35F));
  draw.AddPolyline(points.data(), count, colour(rgb),
                   shape.filled ? ImDrawFlags_Closed : ImDrawFlags_None,
                   shape.filled ? width / 2 : width);
  if (shape.filled || tool == Tool::turn) return;
  const ImVec2 tip = points.back();
  const float half = kTip * ui.scale;
  if (tool == Tool::scale) {
    draw.AddRectFilled({tip.x - half, tip.y - half}, {tip.x + half, tip.y + half}, colour(rgb));
    return;
  }
  const ImVec2 axis{tip.x - points.front().x, tip.y - points.front().y};
  const float length = std::max(std::hypot(axis.x, axis.y), 1.0F);
  const ImVec2 side{axis.x / length * half, axis.y / length * half};
  draw.AddTriangleFilled({tip.x + 2 * side.x, tip.y + 2 * side.y}, {tip.x - side.y, tip.y + side.x},
                         {tip.x + side.y, tip.y - side.x}, colour(rgb));
}

void ViewportManipulator::drawGhosts(const Ui& ui, const ViewProjection& projection,
                                     ImVec2 corner) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 line = colour(ui.theme.selected);
  for (const scenes::AuthoredBody& body : ghosts_) {
    const Eigen::Matrix3d half_edges =
        rotationMatrix(body.pose.rotation) * (pointOf(edgesOf(body.shape)) / 2).asDiagonal();
    std::array<std::optional<Pixel>, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto side = [i](unsigned axis) { return (i >> axis & 1U) != 0 ? 1.0 : -1.0; };
      corners[i] = projection.pixelOf(pointOf(body.pose.position) +
                                      half_edges * Point(side(0), side(1), side(2)));
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = i | (std::size_t{1} << axis);
        if (j == i || !corners[i] || !corners[j]) continue;
        draw.AddLine({corner.x + (*corners[i])[0], corner.y + (*corners[i])[1]},
                     {corner.x + (*corners[j])[0], corner.y + (*corners[j])[1]}, line,
                     1.5F * ui.scale);
      }
    }
  }
}

}  // namespace broadmark
