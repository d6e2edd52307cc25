// The overlay is drawn over the finished picture of the scene, which therefore need not be redrawn
// while the mouse moves.

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
constexpr float kReach = 8;  // of the mouse, around a handle
constexpr float kTip = 6;    // half the size of what an axis ends in
constexpr float kBetweenDabs = 12;

constexpr std::size_t kMaxGhosts = 1000;
constexpr int kMaxDabsAtOnce = 8;  // in a picture, between two places of the mouse

Rgb colourOf(Handle handle, const Palette& theme) {
  // A plane has the colour of the axis across it.
  return handle == Handle::all ? theme.accent : theme.axis[static_cast<std::size_t>(handle) % 3];
}

}  // namespace

void ViewportManipulator::look(const Seen& seen) {
  const auto& shown = seen.session.playback.source();
  const bool edited = document_ != shown;
  if (edited) {
    document_ = shown;
    centred_.clear();
    stroke_.reset();
    cancel();
  }
  text_.clear();
  if (seen.snapshot->source == shown) ghosts_.clear();  // else the bodies are still to come
  lookAtGizmo(seen);
  lookAtBrush(seen);
}

void ViewportManipulator::lookAtGizmo(const Seen& seen) {
  const Document& document = seen.session.document;
  const Tools& tools = document.tools;
  const scenes::SceneEditor& editor = document.editor;
  shapes_.clear();
  const bool shown = document.atRest() && !editor.selection().empty() && tools.tool != Tool::none &&
                     tools.tool != Tool::brush;
  if (!shown) {
    drag_.reset();
    hot_.reset();
    return;
  }
  place_ = {.centre = centreOf(seen.session)};
  if (drag_ && seen.mouse) {
    const GizmoDrag::Outcome outcome = drag_->at(*seen.mouse, tools, tools.snaps != seen.ctrl);
    change_ = outcome.change;
    text_ = outcome.text;
    std::vector<scenes::AuthoredBody> changed = taken_;
    for (scenes::AuthoredBody& body : changed) {
      body.shape = transformedShape(body, change_);
      body.pose = transformedPose(body, change_);
    }
    ghosts_ = std::move(changed);
    for (std::size_t axis = 0; axis < 3; ++axis) place_.centre[axis] += change_.move[axis];
  }
  if (tools.local) place_.turn = editor.scene().bodies[editor.selection().front()].pose.rotation;
  place_.length =
      static_cast<double>(kGizmoLength * seen.scale) * seen.sight.pixelAt(pointOf(place_.centre));
  if (!(place_.length > 0)) return;  // behind the eye
  shapes_ = handleShapes(tools.tool, place_, seen.sight);
  if (drag_) return;
  hot_ = seen.mouse ? handleUnder(shapes_, seen.sight, *seen.mouse, kReach * seen.scale)
                    : std::nullopt;
}

Vec3 ViewportManipulator::centreOf(const Session& session) {
  const scenes::SceneEditor& editor = session.document.editor;
  if (centred_ != editor.selection()) {
    centred_ = editor.selection();
    centre_ = editor.selectionCentre();
  }
  return centre_;
}

void ViewportManipulator::lookAtBrush(const Seen& seen) {
  const Document& document = seen.session.document;
  if (document.tools.tool != Tool::brush || !document.atRest()) {
    painting_ = false;
    stroke_.reset();
    return;
  }
  if (!seen.mouse) return;
  if (!stroke_) stroke_.emplace(document);
  try {
    if (painting_) {
      paintTo(seen, *seen.mouse);
    } else {
      previewDab(seen);
    }
  } catch (const InputError& error) {
    cancel();
    text_ = error.what();
  }
}

void ViewportManipulator::previewDab(const Seen& seen) {
  const std::optional<Surface> surface = surfaceAt(seen, *seen.mouse);
  if (!surface) return;
  const scenes::Stroke dab = stroke_->dab(*surface, kMaxGhosts);
  ghosts_ = dab.bodies;
  if (dab.bodies.empty()) text_ = "no room here";
}

void ViewportManipulator::paintTo(const Seen& seen, Pixel to) {
  const Pixel way = to - painted_at_;
  const float steps = std::ceil(way.norm() / (kBetweenDabs * seen.scale));
  const int count = std::clamp(static_cast<int>(steps), 1, kMaxDabsAtOnce);
  for (int i = 1; i <= count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    const auto surface = surfaceAt(seen, painted_at_ + share * way);
    if (surface) stroke_->paint(*surface);
  }
  painted_at_ = to;
  const std::vector<scenes::AuthoredBody>& bodies = stroke_->painted().bodies;
  const std::size_t left_out = bodies.size() - std::min(bodies.size(), kMaxGhosts);
  ghosts_.assign(bodies.begin() + static_cast<std::ptrdiff_t>(left_out), bodies.end());
  text_ = counted(bodies.size(), "body", "bodies");
}

std::optional<Surface> ViewportManipulator::surfaceAt(const Seen& seen, Pixel pixel) {
  const bool same = pointed_.snapshot == seen.snapshot && pointed_.pixel == pixel &&
                    pointed_.viewpoint == seen.sight.viewpoint();
  if (!same) {
    pointed_ = {seen.snapshot, seen.sight.viewpoint(), pixel,
                surfaceUnder(*seen.snapshot->boxes, seen.session.document.editor.scene().world,
                             seen.sight, pixel, seen.visible)};
  }
  return pointed_.surface;
}

void ViewportManipulator::takeBodies(const scenes::SceneEditor& editor) {
  taken_.clear();
  const std::vector<scenes::AuthoredBody>& bodies = editor.scene().bodies;
  if (editor.selection().size() <= kMaxGhosts) {
    for (const std::uint32_t id : editor.selection()) taken_.push_back(bodies[id]);
    return;
  }
  Aabb all = kEmptyBox;
  for (const std::uint32_t id : editor.selection()) {
    all = merged(all, tightBox(bodies[id].shape, bodies[id].pose));
  }
  taken_.push_back(scenes::bodyIn(all));
}

bool ViewportManipulator::press(const Seen& seen) {
  if (!seen.mouse) return false;
  const Document& document = seen.session.document;
  if (hot_) {
    takeBodies(document.editor);
    change_ = {};
    drag_.emplace(document.tools.tool, *hot_, place_, seen.sight, *seen.mouse);
  } else if (stroke_ && surfaceAt(seen, *seen.mouse)) {
    painting_ = true;
    painted_at_ = *seen.mouse;
  }
  return busy();
}

void ViewportManipulator::release(const Seen& seen) {
  Document& document = seen.session.document;
  if (drag_) {
    drag_.reset();
    document.edit([&](scenes::SceneEditor& editor) {
      editor.transform(kTools.nameOf(document.tools.tool), change_);
    });
  } else if (painting_) {
    painting_ = false;
    document.add([this] { return stroke_->painted(); });
  }
  document_ = seen.session.playback.source();  // the ghosts stay until it is seen
  centred_.clear();
  stroke_.reset();
}

bool ViewportManipulator::cancel() {
  if (!busy()) return false;
  drag_.reset();
  painting_ = false;
  stroke_.reset();
  ghosts_.clear();
  return true;
}

void ViewportManipulator::draw(Ui& ui, const Seen& seen, ImVec2 corner) const {
  drawGhosts(ui, seen.sight, corner);
  const Tool tool = seen.session.document.tools.tool;
  for (const HandleShape& shape : shapes_) {
    drawHandle(ui, shape, seen.sight, tool, corner);
    if (const auto grip = seen.sight.pixelOf(shape.grip)) {
      const float half = kTip * seen.scale;
      const ImVec2 at{corner.x + (*grip)[0], corner.y + (*grip)[1]};
      ui.noteAt(fmt::format("gizmo {}", kHandles.nameOf(shape.handle)), {at.x - half, at.y - half},
                {at.x + half, at.y + half});
    }
  }
  if (text_.empty() || !seen.mouse) return;
  ui.glyphs.request(text_);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float pad = 5 * seen.scale;
  const ImVec2 extent = ImGui::CalcTextSize(text_.c_str());
  const ImVec2 at{corner.x + (*seen.mouse)[0] + 4 * pad, corner.y + (*seen.mouse)[1] + 3 * pad};
  draw.AddRectFilled({at.x - pad, at.y - pad / 2},
                     {at.x + extent.x + pad, at.y + extent.y + pad / 2},
                     colour(ui.theme.background, 0.82F), pad);
  draw.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text_.c_str());
}

void ViewportManipulator::drawHandle(const Ui& ui, const HandleShape& shape,
                                     const ViewProjection& sight, Tool tool, ImVec2 corner) const {
  std::vector<ImVec2> points;
  for (const Point& point : shape.points) {
    if (const auto at = sight.pixelOf(point)) {
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
  const ImVec2 way{tip.x - points.front().x, tip.y - points.front().y};
  const float length = std::max(std::hypot(way.x, way.y), 1.0F);
  const ImVec2 on{way.x / length * half, way.y / length * half};
  draw.AddTriangleFilled({tip.x + 2 * on.x, tip.y + 2 * on.y}, {tip.x - on.y, tip.y + on.x},
                         {tip.x + on.y, tip.y - on.x}, colour(rgb));
}

void ViewportManipulator::drawGhosts(const Ui& ui, const ViewProjection& sight,
                                     ImVec2 corner) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 line = colour(ui.theme.selected);
  for (const scenes::AuthoredBody& body : ghosts_) {
    const Eigen::Matrix3d half_edges =
        turnOf(body.pose.rotation) * (pointOf(edgesOf(body.shape)) / 2).asDiagonal();
    std::array<std::optional<Pixel>, 8> seen;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const auto side = [i](unsigned axis) { return (i >> axis & 1U) != 0 ? 1.0 : -1.0; };
      seen[i] = sight.pixelOf(pointOf(body.pose.position) +
                              half_edges * Point(side(0), side(1), side(2)));
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = i | (std::size_t{1} << axis);
        if (j == i || !seen[i] || !seen[j]) continue;
        draw.AddLine({corner.x + (*seen[i])[0], corner.y + (*seen[i])[1]},
                     {corner.x + (*seen[j])[0], corner.y + (*seen[j])[1]}, line, 1.5F * ui.scale);
      }
    }
  }
}

}  // namespace broadmark
