#include "inspector/views/view_content.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "inspector/views/glass.h"

namespace broadmark {
namespace {

constexpr std::size_t kMaxXrayed = 2000;

}  // namespace

Aabb ViewContent::boundsOf(std::span<const std::uint32_t> bodies) const {
  Aabb bounds = kEmptyBox;
  for (const std::uint32_t body : bodies) bounds = merged(bounds, (*input_.snapshot->boxes)[body]);
  return bounds;
}

bool ViewContent::update(const std::shared_ptr<const Snapshot>& snapshot,
                         const std::shared_ptr<const PairComparison>& comparison,
                         const Session& session, bool dark) {
  // New bodies are selected before the first snapshot that contains them.
  std::vector<std::uint32_t> selection = session.selection.bodies();
  std::erase_if(selection, [&](std::uint32_t b) { return b >= snapshot->boxes->size(); });
  const bool is_pair = selection.size() == 2 && !session.document.atRest();
  Input input{snapshot, comparison, std::move(selection), is_pair, session.display, dark};
  if (input == input_) return false;
  input_ = std::move(input);
  picture.world = snapshot->scene.world;
  picture.shows_world = session.display.world_box;
  picture.shows_grid = session.display.ground;
  picture.shows_axes = session.display.axes;
  picture.theme = paletteOf(dark);
  ++revision_;
  updateBodies();
  updateVisible();
  picture.visible = visible_;
  updateLines();
  return true;
}

void ViewContent::updateBodies() {
  const Snapshot& snapshot = *input_.snapshot;
  const ColourMode& mode = input_.options.colourMode();
  ColouringInput colouring_input{
      .boxes = *snapshot.boxes,
      .previous = snapshot.boxes_before ? std::span<const Aabb>(*snapshot.boxes_before)
                                        : std::span<const Aabb>(),
      .overlaps = snapshot.overlaps,
      .tests = snapshot.structure ? std::span<const std::uint32_t>(snapshot.structure->tests())
                                  : std::span<const std::uint32_t>(),
      .layers = snapshot.scene.filter.layers(),
      .missed = snapshot.difference.missed_pairs,
      .false_pairs = snapshot.difference.false_pairs,
      .comparison = nullptr,
      .dark = input_.dark};
  ColouringInput::Comparison comparison;
  if (input_.comparison) {
    comparison = {input_.comparison->first_only, input_.comparison->second_only};
    colouring_input.comparison = &comparison;
  }
  oracle_legend.clear();
  if (mode.of_answer && snapshot.checked) {
    colouring_input.overlaps = snapshot.oracle_overlaps;
    mode.colour(colouring_input, colouring);
    oracle_legend = std::move(colouring.legend);
    colouring_input.overlaps = snapshot.overlaps;
  }
  mode.colour(colouring_input, colouring);
  picture.boxes = *snapshot.boxes;
  picture.selected = input_.selection;
  if (input_.is_pair) {
    colouring.colours[input_.selection[0]] = picture.theme.first;
    colouring.colours[input_.selection[1]] = picture.theme.second;
    picture.selected = {};
  }
  picture.colours = colouring.colours;
  picture.bodies_revision = revision_;
}

void ViewContent::updateVisible() {
  const Snapshot& snapshot = *input_.snapshot;
  const DisplayOptions& options = input_.options;
  visible_.clear();
  if (!options.hide_free && !options.filter.hides()) return;
  visible_.assign(snapshot.boxes->size(), 1);
  if (options.hide_free) {
    for (std::size_t body = 0; body < visible_.size(); ++body) {
      visible_[body] = snapshot.overlaps[body] > 0 ? 1 : 0;
    }
    // Bodies of missed pairs are always of interest.
    for (const Pair& pair : snapshot.difference.missed_pairs) {
      visible_[pair.a] = visible_[pair.b] = 1;
    }
  }
  hideBodies(options.filter,
             {.boxes = *snapshot.boxes,
              .layers = snapshot.scene.filter.layers(),
              .classes = colouring.classes,
              .world = snapshot.scene.world},
             visible_);
  for (const std::uint32_t body : input_.selection) visible_[body] = 1;
}

void ViewContent::addXray() {
  for (const std::uint32_t body :
       std::span(input_.selection).first(std::min(kMaxXrayed, input_.selection.size()))) {
    wire_boxes_.push_back({.box = (*input_.snapshot->boxes)[body],
                           .colour = picture.theme.selected,
                           .width = 2.5F,
                           .behind = OcclusionStyle::shown});
  }
}

void ViewContent::addPair() {
  const std::vector<Aabb>& boxes = *input_.snapshot->boxes;
  const auto [a, b] = nearestImages(boxes[input_.selection[0]], boxes[input_.selection[1]],
                                    input_.snapshot->scene.periodic);
  const Palette& theme = picture.theme;
  for (const auto& [box, colour] : {std::pair{a, theme.first}, {b, theme.second}}) {
    if (isEmpty(box)) return;
    wire_boxes_.push_back(
        {.box = box, .colour = colour, .width = 2.5F, .behind = OcclusionStyle::shown});
  }
  const std::size_t axis = maxSeparationAxis(a, b);
  const AxisRelation relation = axisRelation(axis, a, b);
  const Rgb colour = relationColour(theme, relation.type);
  const Aabb between = relationBox(a, b);
  SceneLine line{.behind = OcclusionStyle::shown};
  for (std::size_t i = 0; i < 3; ++i) {
    line.from[i] = line.to[i] = static_cast<float>(centreOf(between, i));
  }
  deciding_axis = {.axis = axis, .relation = relation, .middle = line.from};
  const auto add_line = [&](const Aabb& box, Rgb line_colour, float width) {
    line.from[axis] = box.min[axis];
    line.to[axis] = box.max[axis];
    line.colour = line_colour;
    line.width = width;
    lines_.push_back(line);
  };
  Aabb beyond = merged(a, b);
  const float excess = (beyond.max[axis] - beyond.min[axis]) / 4;
  beyond.min[axis] -= excess;
  beyond.max[axis] += excess;
  add_line(beyond, theme.axis[axis], 2);
  add_line(between, colour, 5);
  wire_boxes_.push_back(
      {.box = between, .colour = colour, .width = 1.5F, .behind = OcclusionStyle::shown});
}

void ViewContent::updateGlass(const Point& eye, std::span<const std::uint32_t> focus) {
  const std::vector<Aabb>& boxes = *input_.snapshot->boxes;
  std::vector<std::uint32_t> existing(focus.begin(), focus.end());
  std::erase_if(existing, [&](std::uint32_t body) { return body >= boxes.size(); });
  std::vector<std::uint8_t> glass = glassBefore(boxes, existing, eye);
  if (glass == glass_) return;
  glass_ = std::move(glass);
  picture.glass = glass_;
  picture.bodies_revision = ++revision_;
}

std::vector<std::uint8_t> ViewContent::solid() const {
  std::vector<std::uint8_t> solid = visible_;
  if (glass_.empty()) return solid;
  solid.resize(glass_.size(), 1);
  for (std::size_t body = 0; body < solid.size(); ++body) {
    if (glass_[body] != 0) solid[body] = 0;
  }
  return solid;
}

void ViewContent::add(Overlay overlay) {
  lines_.insert(lines_.end(), overlay.lines.begin(), overlay.lines.end());
  wire_boxes_.insert(wire_boxes_.end(), overlay.boxes.begin(), overlay.boxes.end());
  left_out += overlay.dropped;
  if (!overlay.legend.empty()) cell_legend = std::move(overlay.legend);
}

void ViewContent::addTrails(std::span<const Trail> trails) {
  for (const Trail& trail : trails) {
    for (std::size_t i = 1; i < trail.boxes.size(); ++i) {
      if (isEmpty(trail.boxes[i - 1]) || isEmpty(trail.boxes[i])) continue;
      const auto middle = [&](const Aabb& box) {
        std::array<float, 3> centre{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          centre[axis] = static_cast<float>(centreOf(box, axis));
        }
        return centre;
      };
      lines_.push_back({.from = middle(trail.boxes[i - 1]),
                        .to = middle(trail.boxes[i]),
                        .colour = picture.theme.selected,
                        .behind = OcclusionStyle::faint});
    }
  }
}

void ViewContent::updateLines() {
  const Snapshot& snapshot = *input_.snapshot;
  const std::span<const Aabb> boxes = *snapshot.boxes;
  const DisplayOptions& options = input_.options;
  lines_.clear();
  wire_boxes_.clear();
  left_out = 0;
  cell_legend.clear();
  deciding_axis.reset();
  const std::optional<std::span<const std::uint32_t>> selected =
      options.all_pair_lines ? std::nullopt
                             : std::optional<std::span<const std::uint32_t>>(input_.selection);
  if (options.pair_lines) {
    const PairRun pairs = snapshot.pairs;
    add(pairLines(boxes, {&pairs, 1}, {.colour = picture.theme.pair}, selected));
  }
  if (const PairRun missed = snapshot.difference.missed_pairs; !missed.empty()) {
    add(pairLines(
        boxes, {&missed, 1},
        {.colour = picture.theme.missed, .width = 2.5F, .behind = OcclusionStyle::shown}));
  }
  if (snapshot.structure && options.structure) {
    StructureStyle look{.by_population = options.structure_population, .dark = input_.dark};
    if (options.structure_level >= 0) {
      look.first_level = look.last_level = options.structure_level;
    }
    const Aabb selected_box = boundsOf(input_.selection);
    if (options.structure_near && !isEmpty(selected_box)) look.near = selected_box;
    add(structureOverlay(*snapshot.structure, look));
  }
  addTrails(snapshot.trails);
  if (options.xray) addXray();
  if (input_.is_pair) addPair();
  if (const std::optional<Aabb> plane = clipPlane(options.filter, snapshot.scene.world)) {
    wire_boxes_.push_back({.box = *plane,
                           .colour = picture.theme.world,
                           .width = 2,
                           .behind = OcclusionStyle::faint});
  }
  picture.lines = lines_;
  picture.wire_boxes = wire_boxes_;
  picture.lines_revision = revision_;
}

}  // namespace broadmark
