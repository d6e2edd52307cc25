#include "inspector/views/view.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "broadmark/render/ui_renderer.h"
#include "inspector/session/wrong_pair.h"
#include "inspector/views/view_overlay.h"

namespace broadmark {
namespace {

constexpr float kFlightSeconds = 0.45F;
constexpr float kRadiansPerHeight = 3.2F;  // of a drag across the whole view
constexpr float kZoomPerTurn = 0.86F;
constexpr float kFlySpeed = 1.2F;   // distances to the target per second
constexpr float kClickPixels = 3;   // a press that moves less is a click
constexpr float kSurroundings = 2;  // size of the framed area around a body, in its sizes

/// Adds the groups of the bodies, unless Alt is down.
BodySelection::Bodies withGroups(const Session& session, BodySelection::Bodies bodies) {
  return ImGui::GetIO().KeyAlt ? bodies : session.selection.withGroups(std::move(bodies));
}

}  // namespace

std::span<const FlyKey> flyKeys() {
  static constexpr std::array<FlyKey, 6> kKeys = {{{GLFW_KEY_W, {1, 0, 0}, "forwards"},
                                                   {GLFW_KEY_S, {-1, 0, 0}, "backwards"},
                                                   {GLFW_KEY_A, {0, -1, 0}, "to the left"},
                                                   {GLFW_KEY_D, {0, 1, 0}, "to the right"},
                                                   {GLFW_KEY_Q, {0, 0, -1}, "down"},
                                                   {GLFW_KEY_E, {0, 0, 1}, "up"}}};
  return kKeys;
}

double View::aspect() const { return static_cast<double>(size_.x) / static_cast<double>(size_.y); }

void View::viewFrom(Direction direction) { flyTo(viewedFrom(camera_, direction)); }

void View::showWholeScene() {
  if (!content_.snapshot()) return;
  const Aabb all = shownBox(content_.snapshot()->scene.world, *content_.snapshot()->boxes);
  flyTo(focusedOn(camera_, space_.toView(all), aspect()));
}

void View::flyTo(const OrbitCamera& to) { flight_ = Flight{.from = camera_, .to = to}; }

void View::advanceFlight(float seconds) {
  if (!flight_) return;
  flight_->progress += seconds / kFlightSeconds;
  camera_ = between(flight_->from, flight_->to, std::min(flight_->progress, 1.0F));
  if (flight_->progress >= 1) flight_.reset();
}

void View::startRequestedFlight(Session& session) {
  if (!session.selection.fly_to) return;
  std::vector<std::uint32_t> bodies = *std::exchange(session.selection.fly_to, {});
  std::erase_if(bodies,
                [&](std::uint32_t body) { return body >= content_.snapshot()->boxes->size(); });
  if (bodies.empty()) {
    showWholeScene();
    return;
  }
  const Aabb bounds = content_.boundsOf(bodies);
  if (isEmpty(bounds)) return;  // all bodies are absent
  double longest = 0;
  for (const std::uint32_t body : bodies) {
    longest = std::max(longest, longestEdge((*content_.snapshot()->boxes)[body]));
  }
  const float margin = (kSurroundings - 1) * static_cast<float>(longest) / 2;
  flyTo(focusedOn(camera_, space_.toView(enlarged(bounds, margin)), aspect()));
}

void View::placeCamera(const Snapshot& snapshot, Session& session) {
  const auto previous = std::exchange(source_, snapshot.source);
  const bool new_scene = !previous || (previous != source_ &&
                                       (previous->scene == 0 || previous->scene != source_->scene));
  if (!new_scene) return;
  const Aabb all = shownBox(snapshot.scene.world, *snapshot.boxes);
  space_ = viewSpaceOf(all);
  camera_ = focusedOn(viewedFrom({}, Direction::figure), space_.toView(all), aspect());
  if (session.first_camera) camera_ = *std::exchange(session.first_camera, {});
  flight_.reset();
}

void View::copyCamera(const View& leader) {
  camera_ = leader.camera_;
  space_ = leader.space_;
  flight_.reset();
}

void View::drawEmpty(Ui& ui, const std::string& hint) {
  ImGui::InvisibleButton("scene", size_);
  ui.note("scene");
  const std::string text = fittingText(hint, size_.x);
  const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
  ImGui::GetWindowDrawList()->AddText(
      {corner_.x + (size_.x - extent.x) / 2, corner_.y + (size_.y - extent.y) / 2},
      colour(ui.theme.faint), text.c_str());
}

void View::drawScene(const Ui& ui, const Session& session) {
  const Viewpoint viewpoint{.camera = toCamera(camera_, aspect(), {})};
  content_.updateGlass(ViewProjection(space_, viewpoint).eye(), session.selection.focus());
  SceneViewContent picture = content_.picture;
  picture.space = space_;
  picture.scale = ui.scale;
  scene_.resize(static_cast<int>(size_.x), static_cast<int>(size_.y));
  scene_.draw(picture, camera_);
  ImGui::GetWindowDrawList()->AddImage(uiTexture(scene_.texture()), corner_,
                                       {corner_.x + size_.x, corner_.y + size_.y}, {0, 1}, {1, 0});
}

void View::draw(Ui& ui, Session& session, const RunProgress& progress, const Input& input) {
  const auto scope = ui.scope(input.name);
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 available = ImGui::GetContentRegionAvail();
  corner_ = ImGui::GetCursorScreenPos();
  size_ = {std::max(std::floor(available.x), 1.0F), std::max(std::floor(available.y), 1.0F)};
  mouse_ = {io.MousePos.x - corner_.x, io.MousePos.y - corner_.y};
  camera_moved_ = false;
  if (!input.snapshot) return drawEmpty(ui, input.hint);
  if (content_.update(input.snapshot, progress.comparison, session, ui.theme.dark)) {
    placeCamera(*input.snapshot, session);
    answer_ = answerText(*input.snapshot, progress.tracks, input.track, content_.selection());
  }
  if (input.leader != nullptr) {
    copyCamera(*input.leader);
  } else {
    startRequestedFlight(session);
  }
  const OrbitCamera before = camera_;
  advanceFlight(io.DeltaTime);
  drawScene(ui, session);
  ImGui::SetCursorScreenPos(corner_);
  ImGui::InvisibleButton("scene", size_,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  ui.note("scene");
  ViewportManipulator::Input mouse_input{.session = session,
                                         .snapshot = content_.snapshot(),
                                         .visible = content_.picture.visible,
                                         .projection = ViewProjection(space_, scene_.viewpoint()),
                                         .scale = ui.scale,
                                         .mouse = {},
                                         .ctrl = io.KeyCtrl};
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    mouse_input.mouse = Pixel{mouse_.x, mouse_.y};
  }
  if (input.editable) manipulator_.update(mouse_input);
  handleMouse(ui, mouse_input);
  if (input.editable) manipulator_.draw(ui, mouse_input, corner_);
  camera_moved_ = camera_ != before;
  const std::string source = sourceText(input.snapshot->source.get());
  answer_.where = session.second ? fmt::format("frame {}, {}", input.snapshot->frame, source) : "";
  answer_.waiting = input.waiting;
  if (content_.deciding_axis)
    drawDecidingAxis(ui, *content_.deciding_axis, mouse_input.projection, corner_, size_);
  const ImVec2 answer_end = drawAnswer(ui, answer_, corner_, size_);
  if (input.editable && session.mismatches.examined()) {
    drawReplay(ui, session, {corner_.x, answer_end.y});
  }
  const bool tools = input.editable && session.document.shown();
  const float free_height = tools ? drawTools(ui, session, corner_, size_) : size_.y;
  drawLegend(ui, content_, answer_.owner, corner_, {size_.x, free_height}, answer_end);
  if (session.display.axes) drawAxisNames(ui.scale);
}

void View::beginDrag(const ViewportManipulator::Input& input) {
  const ImGuiIO& io = ImGui::GetIO();
  drag_from_ = mouse_;
  dragged_ = false;
  drag_ = !io.MouseDown[0]            ? Drag::pan
          : io.KeyShift               ? Drag::rectangle
          : manipulator_.press(input) ? Drag::manipulate
                                      : Drag::orbit;
  flight_.reset();
}

void View::handleRelease(const ViewportManipulator::Input& input) {
  const Drag drag = std::exchange(drag_, Drag::none);
  if (drag == Drag::manipulate && !manipulator_.busy()) return;  // cancelled
  // A click paints, but drags nothing.
  if (manipulator_.busy() && (dragged_ || manipulator_.painting())) {
    manipulator_.release(input);
  } else if (drag == Drag::rectangle && dragged_) {
    selectWithin(input.session);
  } else if (!dragged_ && drag != Drag::pan) {
    manipulator_.cancel(input.session);
    click(input.session, ImGui::GetIO().MouseDoubleClicked[0]);
  }
}

void View::handleMouse(Ui& ui, const ViewportManipulator::Input& input) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActivated()) beginDrag(input);
  if (ImGui::IsItemActive()) handleDrag();
  if (ImGui::IsItemDeactivated()) handleRelease(input);
  // The camera does not move while a body is dragged.
  if (!ImGui::IsItemHovered() || manipulator_.busy()) return;
  if (ImGui::IsMouseDoubleClicked(0)) click(input.session, true);
  if (io.MouseWheel != 0) {
    flight_.reset();
    const float x = 2 * mouse_.x / size_.x - 1;
    const float y = 1 - 2 * mouse_.y / size_.y;
    camera_ =
        zoomed(camera_, std::pow(kZoomPerTurn, io.MouseWheel), pointUnder(camera_, aspect(), x, y));
  }
  if (!io.WantTextInput && !io.KeyCtrl) handleKeys();
  if (drag_ == Drag::rectangle && dragged_) {
    const ImVec2 from{corner_.x + drag_from_.x, corner_.y + drag_from_.y};
    ImGui::GetWindowDrawList()->AddRectFilled(from, io.MousePos, colour(ui.theme.accent, 0.15F));
    ImGui::GetWindowDrawList()->AddRect(from, io.MousePos, colour(ui.theme.accent));
  }
}

void View::handleDrag() {
  const ImVec2 total{mouse_.x - drag_from_.x, mouse_.y - drag_from_.y};
  if (!dragged_ && std::hypot(total.x, total.y) <= kClickPixels) return;
  const ImVec2 moved = dragged_ ? ImGui::GetIO().MouseDelta : total;
  dragged_ = true;
  if (drag_ == Drag::orbit) {
    camera_ = orbited(camera_, -moved.x / size_.y * kRadiansPerHeight,
                      moved.y / size_.y * kRadiansPerHeight);
  } else if (drag_ == Drag::pan) {
    camera_ = panned(camera_, moved.x / size_.y, -moved.y / size_.y);
  }
}

void View::handleKeys() {
  const float step = kFlySpeed * ImGui::GetIO().DeltaTime;
  std::array<float, 3> motion{};
  bool any = false;
  for (const FlyKey& key : flyKeys()) {
    if (!ImGui::IsKeyDown(static_cast<ImGuiKey>(key.key))) continue;
    any = true;
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i] += step * key.direction[i];
  }
  if (!any) return;
  flight_.reset();
  camera_ = flown(camera_, motion[0], motion[1], motion[2]);
}

void View::click(Session& session, bool fly_there) {
  const auto pick = [&](BodyMask mask) {
    return pickBody(*content_.snapshot()->boxes, space_, scene_.viewpoint(), mouse_.x, mouse_.y,
                    mask);
  };
  auto picked = pick(content_.solid());
  if (!picked) picked = pick(content_.picture.visible);
  if (!picked) {
    if (!ImGui::GetIO().KeyCtrl) session.selection.select({});
    return;
  }
  const BodySelection::Bodies bodies = withGroups(session, {picked->body});
  if (ImGui::GetIO().KeyCtrl) {
    session.selection.toggle(bodies);
  } else {
    session.selection.select(bodies);
  }
  if (fly_there) session.selection.flyTo({picked->body});
}

void View::selectWithin(Session& session) {
  session.selection.select(
      withGroups(session, bodiesWithin(*content_.snapshot()->boxes, space_, scene_.viewpoint(),
                                       {{drag_from_.x, drag_from_.y}, {mouse_.x, mouse_.y}},
                                       content_.picture.visible)));
}

void View::drawAxisNames(float scale) const {
  const auto tips = axisTips(scene_.viewpoint(), scale);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const ImVec2 text = ImGui::CalcTextSize(kAxes[axis]);
    ImGui::GetWindowDrawList()->AddText(
        {corner_.x + tips[axis][0] - text.x / 2, corner_.y + tips[axis][1] - text.y / 2},
        ImGui::GetColorU32(ImGuiCol_Text), kAxes[axis]);
  }
}

void Views::draw(Ui& ui, Session& session, const RunProgress& progress, ImVec2 position,
                 ImVec2 size) {
  const std::string hint =
      session.playback.source() ? progress.activity : "Simulate a scene, or drop a recording here";
  std::vector<View::Input> inputs = {{.name = "View",
                                      .snapshot = progress.snapshot,
                                      .hint = hint,
                                      .waiting = session.waitsFor(progress),
                                      .track = session.tracks.shown(),
                                      .editable = true}};
  if (session.second) {
    const std::string& failure = progress.second_failure;
    inputs.push_back({.name = "Second view",
                      .snapshot = progress.second,
                      .hint = failure.empty() ? "Nothing is shown yet" : failure,
                      .track = session.second->track,
                      .leader = session.cameras_linked ? &first() : nullptr});
  }
  const auto count = static_cast<float>(inputs.size());
  const float gap = kSplitterSize * ui.scale;
  const float width = std::max((size.x - (count - 1) * gap) / count, 1.0F);
  // Every view with a camera of its own gets the request.
  const std::optional<BodySelection::Bodies> fly_to = session.selection.fly_to;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    View& view = list_[i];
    const View::Input& input = inputs[i];
    if (input.leader == nullptr && !session.selection.fly_to) session.selection.fly_to = fly_to;
    beginAt(input.name, {position.x + static_cast<float>(i) * (size.x - width), position.y},
            {width, size.y}, ImGuiWindowFlags_NoScrollbar);
    view.draw(ui, session, progress, input);
    ImGui::End();
    if (input.leader != nullptr && view.cameraMoved()) first().copyCamera(view);
  }
  ImGui::PopStyleVar();
}

}  // namespace broadmark
