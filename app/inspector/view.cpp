#include "inspector/view.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "broadmark/render/input_queue.h"
#include "broadmark/render/ui_renderer.h"
#include "inspector/view_overlay.h"

namespace broadmark {
namespace {

constexpr float kFlightSeconds = 0.45F;
constexpr float kRadiansPerHeight = 3.2F;  // of a drag across the whole view
constexpr float kZoomPerTurn = 0.86F;
constexpr float kFlySpeed = 1.2F;   // distances to the middle per second
constexpr float kClickPixels = 3;   // a press that moves less is a click
constexpr float kSurroundings = 3;  // what is looked at is shown with so many times its size around

constexpr std::size_t kMostXrayed = 2000;

constexpr Rgb kMissed = 0xE5484D;
constexpr Rgb kLine = 0x4C8DFF;

Aabb enlargedBy(const Aabb& box, float factor) {
  float longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, box.max[axis] - box.min[axis]);
  }
  return enlarged(box, (factor - 1) * longest / 2);
}

/// Whole groups, unless Alt is down.
BodySelection::Bodies withGroups(const Session& session, BodySelection::Bodies bodies) {
  return ImGui::GetIO().KeyAlt ? bodies : session.selection.whole(std::move(bodies));
}

}  // namespace

const std::array<FlyKey, 6> kFlyKeys = {{{GLFW_KEY_W, {1, 0, 0}, "forwards"},
                                         {GLFW_KEY_S, {-1, 0, 0}, "backwards"},
                                         {GLFW_KEY_A, {0, -1, 0}, "to the left"},
                                         {GLFW_KEY_D, {0, 1, 0}, "to the right"},
                                         {GLFW_KEY_Q, {0, 0, -1}, "down"},
                                         {GLFW_KEY_E, {0, 0, 1}, "up"}}};

View::View(const Gl& gl, Role role) : role_(role), scene_(gl) {}

double View::aspect() const { return static_cast<double>(width_) / height_; }

void View::lookFrom(Direction direction) { fly(lookedFrom(camera_, direction)); }

void View::lookAtAll() {
  if (!shown_.snapshot) return;
  const Aabb all = shownBox(shown_.snapshot->scene.world, *shown_.snapshot->boxes);
  OrbitCamera whole = focusedOn(camera_, content_.space.toView(all), aspect());
  whole.cut = OrbitCamera::kUncut;
  fly(whole);
}

void View::fly(const OrbitCamera& to) { flight_ = Flight{.from = camera_, .to = to}; }

void View::moveOn(float seconds) {
  if (!flight_) return;
  flight_->part += seconds / kFlightSeconds;
  camera_ = between(flight_->from, flight_->to, std::min(flight_->part, 1.0F));
  if (flight_->part >= 1) flight_.reset();
}

Aabb View::boundsOf(std::span<const std::uint32_t> bodies) const {
  Aabb bounds = kEmptyBox;
  for (const std::uint32_t body : bodies) bounds = merged(bounds, (*shown_.snapshot->boxes)[body]);
  return bounds;
}

void View::takeFlightRequest(Session& session) {
  if (!session.selection.fly_to) return;
  std::vector<std::uint32_t> bodies = *std::exchange(session.selection.fly_to, {});
  std::erase_if(bodies, [&](std::uint32_t body) { return body >= shown_.snapshot->boxes->size(); });
  if (bodies.empty()) {
    lookAtAll();
    return;
  }
  const Aabb bounds = boundsOf(bodies);
  if (isEmpty(bounds)) return;  // all of them are absent
  const Aabb surroundings = content_.space.toView(enlargedBy(bounds, kSurroundings));
  // What stands before them would hide them.
  fly(cutAway(focusedOn(camera_, surroundings, aspect()), content_.space.toView(bounds)));
}

void View::update(Session& session, const RunProgress& progress, bool dark) {
  const auto& snapshot = role_ == Role::first ? progress.snapshot : progress.second;
  if (!snapshot) return;
  const ViewOptions& options = session.view;
  // What has just been added is selected already, but not to be seen yet.
  std::vector<std::uint32_t> selection = session.selection.bodies();
  std::erase_if(selection, [&](std::uint32_t b) { return b >= snapshot->boxes->size(); });
  const bool same = snapshot == shown_.snapshot && progress.comparison == shown_.comparison &&
                    selection == shown_.selection && options == shown_.options &&
                    dark == shown_.dark;
  if (same) return;
  const auto seen = std::exchange(footage_, snapshot->footage);
  const bool new_scene =
      !seen || (seen != footage_ && (seen->scene == 0 || seen->scene != footage_->scene));
  shown_ = {snapshot, progress.comparison, std::move(selection), options, dark};
  if (new_scene) {
    const Aabb all = shownBox(snapshot->scene.world, *snapshot->boxes);
    content_.space = viewSpaceOf(all);
    camera_ = focusedOn(lookedFrom({}, Direction::figure), content_.space.toView(all), aspect());
    flight_.reset();
  }
  content_.world = snapshot->scene.world;
  content_.shows_world = options.world_box;
  content_.shows_grid = options.ground;
  content_.shows_axes = options.axes;
  content_.theme = dark ? kDarkScene : kLightScene;
  ++revision_;
  const int chosen =
      role_ == Role::second && session.second ? session.second->lane : session.lanes.shown();
  answer_ = answerText(*snapshot, progress.lanes, chosen, shown_.selection);
  updateBodies(session);
  updateLines(session, dark);
}

void View::updateBodies(const Session& session) {
  const Snapshot& snapshot = *shown_.snapshot;
  const ColourMode& mode = colourModes()[session.view.colouring % colourModes().size()];
  ColouringInput input{.boxes = *snapshot.boxes,
                       .previous = snapshot.boxes_before
                                       ? std::span<const Aabb>(*snapshot.boxes_before)
                                       : std::span<const Aabb>(),
                       .overlaps = snapshot.overlaps,
                       .layers = snapshot.scene.filter.layers(),
                       .missed = snapshot.difference.missed_pairs,
                       .false_pairs = snapshot.difference.false_pairs,
                       .comparison = nullptr,
                       .dark = shown_.dark};
  ColouringInput::Comparison comparison;
  if (shown_.comparison) {
    comparison = {shown_.comparison->first_only, shown_.comparison->second_only};
    input.comparison = &comparison;
  }
  oracle_legend_.clear();
  if (mode.of_answer && snapshot.checked) {
    input.overlaps = snapshot.right_overlaps;
    mode.colour(input, colouring_);
    oracle_legend_ = std::move(colouring_.legend);
    input.overlaps = snapshot.overlaps;
  }
  mode.colour(input, colouring_);
  updateVisible(session.view);
  content_.boxes = *snapshot.boxes;
  content_.colours = colouring_.colours;
  content_.visible = visible_;
  content_.selected = shown_.selection;
  content_.bodies_revision = revision_;
}

void View::updateVisible(const ViewOptions& options) {
  const Snapshot& snapshot = *shown_.snapshot;
  visible_.clear();
  if (!options.hide_free && !options.filter.hides()) return;
  visible_.assign(snapshot.boxes->size(), 1);
  if (options.hide_free) {
    for (std::size_t body = 0; body < visible_.size(); ++body) {
      visible_[body] = snapshot.overlaps[body] > 0 ? 1 : 0;
    }
    // What is missing is what one looks for.
    for (const Pair& pair : snapshot.difference.missed_pairs) {
      visible_[pair.a] = visible_[pair.b] = 1;
    }
  }
  hideBodies(options.filter,
             {.boxes = *snapshot.boxes,
              .layers = snapshot.scene.filter.layers(),
              .classes = colouring_.classes,
              .world = snapshot.scene.world},
             visible_);
  for (const std::uint32_t body : shown_.selection) visible_[body] = 1;
}

std::size_t View::hiddenBodies() const {
  return static_cast<std::size_t>(std::ranges::count(visible_, 0));
}

void View::addXray(bool dark) {
  for (const std::uint32_t body :
       std::span(shown_.selection).first(std::min(kMostXrayed, shown_.selection.size()))) {
    wire_boxes_.push_back({.box = (*shown_.snapshot->boxes)[body],
                           .colour = (dark ? kDarkScene : kLightScene).selection,
                           .width = 2.5F,
                           .behind = Behind::shown});
  }
}

void View::add(Overlay overlay) {
  lines_.insert(lines_.end(), overlay.lines.begin(), overlay.lines.end());
  wire_boxes_.insert(wire_boxes_.end(), overlay.boxes.begin(), overlay.boxes.end());
  left_out_ += overlay.left_out;
  if (!overlay.legend.empty()) cell_legend_ = std::move(overlay.legend);
}

void View::updateLines(const Session& session, bool dark) {
  const Snapshot& snapshot = *shown_.snapshot;
  const std::span<const Aabb> boxes = *snapshot.boxes;
  const ViewOptions& options = session.view;
  lines_.clear();
  wire_boxes_.clear();
  left_out_ = 0;
  cell_legend_.clear();
  const std::optional<std::span<const std::uint32_t>> selected =
      options.lines_of_all ? std::nullopt
                           : std::optional<std::span<const std::uint32_t>>(shown_.selection);
  if (options.pair_lines) {
    const PairRun run = snapshot.pairs;
    add(pairLines(boxes, {&run, 1}, {.colour = kLine}, selected));
  }
  if (const PairRun missed = snapshot.difference.missed_pairs; !missed.empty()) {
    add(pairLines(boxes, {&missed, 1},
                  {.colour = kMissed, .width = 2.5F, .behind = Behind::shown}));
  }
  if (snapshot.structure) {
    StructureLook look{.by_population = options.structure_population, .dark = dark};
    if (options.structure_level >= 0) {
      look.first_level = look.last_level = options.structure_level;
    }
    const Aabb selected_box = boundsOf(shown_.selection);
    if (options.structure_near && !isEmpty(selected_box)) look.near = selected_box;
    add(structureOverlay(*snapshot.structure, look));
  }
  for (const Track& track : snapshot.tracks) {
    for (std::size_t i = 1; i < track.boxes.size(); ++i) {
      if (isEmpty(track.boxes[i - 1]) || isEmpty(track.boxes[i])) continue;
      const auto middle = [&](const Aabb& box) {
        std::array<float, 3> centre{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          centre[axis] = (box.min[axis] + box.max[axis]) / 2;
        }
        return centre;
      };
      lines_.push_back({.from = middle(track.boxes[i - 1]),
                        .to = middle(track.boxes[i]),
                        .colour = (dark ? kDarkScene : kLightScene).selection,
                        .behind = Behind::faint});
    }
  }
  if (options.xray) addXray(dark);
  if (const std::optional<Aabb> plane = clipPlane(options.filter, snapshot.scene.world)) {
    wire_boxes_.push_back({.box = *plane,
                           .colour = (dark ? kDarkScene : kLightScene).world,
                           .width = 2,
                           .behind = Behind::faint});
  }
  content_.lines = lines_;
  content_.wire_boxes = wire_boxes_;
  content_.lines_revision = revision_;
}

void View::follow(const View& leader) {
  camera_ = leader.camera_;
  content_.space = leader.content_.space;
  flight_.reset();
}

void View::drawEmpty(Ui& ui, const char* hint, ImVec2 corner, ImVec2 size) {
  ImGui::InvisibleButton("scene", size);
  ui.note("scene");
  const std::string shown = fittingText(hint, size.x);
  const ImVec2 text = ImGui::CalcTextSize(shown.c_str());
  ImGui::GetWindowDrawList()->AddText(
      {corner.x + (size.x - text.x) / 2, corner.y + (size.y - text.y) / 2}, colour(ui.theme.faint),
      shown.c_str());
}

void View::drawScene(const Ui& ui, ImVec2 corner, ImVec2 size) {
  content_.scale = ui.scale;
  scene_.resize(width_, height_);
  scene_.draw(content_, camera_);
  ImGui::GetWindowDrawList()->AddImage(uiTexture(scene_.texture()), corner,
                                       {corner.x + size.x, corner.y + size.y}, {0, 1}, {1, 0});
}

void View::draw(Ui& ui, Session& session, const RunProgress& progress, const View* leader) {
  const bool first = role_ == Role::first;
  const auto scope = ui.scope(first ? "View" : "Second view");
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 size{std::max(std::floor(room.x), 1.0F), std::max(std::floor(room.y), 1.0F)};
  width_ = static_cast<int>(size.x);
  height_ = static_cast<int>(size.y);
  moved_ = false;
  update(session, progress, ui.theme.dark);
  if (!shown_.snapshot || (!first && !progress.second)) {
    const char* hint = first ? "Simulate a scene, or drop a recording here"
                       : progress.second_failure.empty() ? "Nothing is shown yet"
                                                         : progress.second_failure.c_str();
    drawEmpty(ui, hint, corner, size);
    return;
  }
  if (leader != nullptr) {
    follow(*leader);
  } else {
    takeFlightRequest(session);
  }
  const OrbitCamera before = camera_;
  moveOn(ImGui::GetIO().DeltaTime);
  drawScene(ui, corner, size);
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton("scene", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  ui.note("scene");
  const ImGuiIO& io = ImGui::GetIO();
  Hands::Seen seen{.session = session,
                   .snapshot = shown_.snapshot,
                   .visible = visible_,
                   .sight = Sight(content_.space, scene_.viewpoint()),
                   .scale = ui.scale,
                   .mouse = {},
                   .ctrl = io.KeyCtrl};
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    seen.mouse = Pixel{io.MousePos.x - corner.x, io.MousePos.y - corner.y};
  }
  if (first) hands_.look(seen);
  handleMouse(ui, seen, corner, size);
  if (first) hands_.draw(ui, seen, corner);
  moved_ = camera_ != before;
  answer_.where = session.second ? whereText(*shown_.snapshot) : "";
  const ImVec2 taken = drawAnswer(ui, answer_, corner, size);
  drawLegend(ui,
             {.legend = colouring_.legend,
              .oracle = oracle_legend_,
              .owner = answer_.owner,
              .cells = cell_legend_,
              .left_out = left_out_},
             corner, size, taken);
  if (session.view.axes) drawAxisNames(corner);
  if (first && session.document.shown()) drawTools(ui, session, corner, size);
}

void View::beginDrag(const Hands::Seen& seen, ImVec2 mouse) {
  const ImGuiIO& io = ImGui::GetIO();
  drag_from_ = mouse;
  dragged_ = false;
  drag_ = !io.MouseDown[0]                             ? Drag::pan
          : io.KeyShift                                ? Drag::rectangle
          : role_ == Role::first && hands_.press(seen) ? Drag::hands
                                                       : Drag::orbit;
  flight_.reset();
}

void View::handleRelease(const Hands::Seen& seen, ImVec2 mouse) {
  const Drag drag = std::exchange(drag_, Drag::none);
  if (drag == Drag::hands && !hands_.busy()) return;  // given up
  if (hands_.busy() && (dragged_ || hands_.painting())) {
    hands_.release(seen);
  } else if (drag == Drag::rectangle && dragged_) {
    selectWithin(seen.session, drag_from_, mouse);
  } else if (!dragged_ && drag != Drag::pan) {
    hands_.cancel();
    click(seen.session, mouse, ImGui::GetIO().MouseDoubleClicked[0]);
  }
}

void View::handleMouse(Ui& ui, const Hands::Seen& seen, ImVec2 corner, ImVec2 size) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 mouse{io.MousePos.x - corner.x, io.MousePos.y - corner.y};
  if (ImGui::IsItemActivated()) beginDrag(seen, mouse);
  if (ImGui::IsItemActive()) handleDrag(corner, size);
  if (ImGui::IsItemDeactivated()) handleRelease(seen, mouse);
  // While a body is in hand, the camera stays where it is.
  if (!ImGui::IsItemHovered() || hands_.busy()) return;
  if (ImGui::IsMouseDoubleClicked(0)) click(seen.session, mouse, true);
  if (io.MouseWheel != 0) {
    flight_.reset();
    const float x = 2 * mouse.x / size.x - 1;
    const float y = 1 - 2 * mouse.y / size.y;
    camera_ =
        zoomed(camera_, std::pow(kZoomPerTurn, io.MouseWheel), pointUnder(camera_, aspect(), x, y));
  }
  if (!io.WantTextInput && !io.KeyCtrl) handleKeys();
  if (drag_ == Drag::rectangle && dragged_) {
    const ImVec2 from{corner.x + drag_from_.x, corner.y + drag_from_.y};
    ImGui::GetWindowDrawList()->AddRectFilled(from, io.MousePos, colour(ui.theme.accent, 0.15F));
    ImGui::GetWindowDrawList()->AddRect(from, io.MousePos, colour(ui.theme.accent));
  }
}

void View::handleDrag(ImVec2 corner, ImVec2 size) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 mouse{io.MousePos.x - corner.x, io.MousePos.y - corner.y};
  if (!dragged_ && std::hypot(mouse.x - drag_from_.x, mouse.y - drag_from_.y) <= kClickPixels) {
    return;
  }
  const ImVec2 moved =
      dragged_ ? io.MouseDelta : ImVec2{mouse.x - drag_from_.x, mouse.y - drag_from_.y};
  dragged_ = true;
  if (drag_ == Drag::orbit) {
    camera_ = orbited(camera_, -moved.x / size.y * kRadiansPerHeight,
                      moved.y / size.y * kRadiansPerHeight);
  } else if (drag_ == Drag::pan) {
    camera_ = panned(camera_, moved.x / size.y, -moved.y / size.y);
  }
}

void View::handleKeys() {
  const float step = kFlySpeed * ImGui::GetIO().DeltaTime;
  std::array<float, 3> way{};
  bool any = false;
  for (const FlyKey& fly : kFlyKeys) {
    if (!ImGui::IsKeyDown(fly.key)) continue;
    any = true;
    for (std::size_t i = 0; i < way.size(); ++i) way[i] += step * fly.direction[i];
  }
  if (!any) return;
  flight_.reset();
  camera_ = flown(camera_, way[0], way[1], way[2]);
}

void View::click(Session& session, ImVec2 at, bool fly_there) {
  const auto picked =
      pickBody(*shown_.snapshot->boxes, content_.space, scene_.viewpoint(), at.x, at.y, visible_);
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
  if (fly_there) session.selection.fly_to = std::vector<std::uint32_t>{picked->body};
}

void View::selectWithin(Session& session, ImVec2 from, ImVec2 to) {
  session.selection.select(
      withGroups(session, bodiesWithin(*shown_.snapshot->boxes, content_.space, scene_.viewpoint(),
                                       {{from.x, from.y}, {to.x, to.y}}, visible_)));
}

void View::drawAxisNames(ImVec2 corner) const {
  const auto tips = axisTips(scene_.viewpoint(), content_.scale);
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const ImVec2 text = ImGui::CalcTextSize(kNames[axis]);
    ImGui::GetWindowDrawList()->AddText(
        {corner.x + tips[axis][0] - text.x / 2, corner.y + tips[axis][1] - text.y / 2},
        ImGui::GetColorU32(ImGuiCol_Text), kNames[axis]);
  }
}

}  // namespace broadmark
