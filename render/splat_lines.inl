// Lines: projected to strips of constant width, as in line.vert, then blended into the picture in
// front of the boxes or behind them, as in line.frag.

/// The ends of eight lines, by coordinate.
struct Ends {
  Floats at[3][2];
};

/// Clips lines at a limit. `height`: of the ends above the limit. Returns a mask of the lines that
/// are partly above it.
inline Ints clipBelow(const Floats (&height)[2], Ends& ends) {
  for (int end = 0; end < 2; ++end) {
    const int other = 1 - end;
    const Floats part = height[end] / (height[end] - height[other]);
    for (auto& at : ends.at) {
      // If both ends are below, the values are undefined; the line is not drawn.
      at[end] = height[end] < 0.0F ? at[end] + (at[other] - at[end]) * part : at[end];
    }
  }
  return (height[0] >= 0.0F) | (height[1] >= 0.0F);
}

/// Computes x and y in pixels times depth, and the depth, relative to the eye. Clips the lines at
/// the near plane, and returns a mask of the lines that are partly behind it.
inline Ints viewedEnds(const SplatView& view, const Floats (&points)[3][2], Ends& ends) {
  const float* rows[3] = {view.column, view.row, view.forward};
  for (int i = 0; i < 3; ++i) {
    for (int end = 0; end < 2; ++end) {
      ends.at[i][end] =
          rows[i][0] * points[0][end] + rows[i][1] * points[1][end] + rows[i][2] * points[2][end];
    }
  }
  const Floats height[2] = {ends.at[2][0] - view.near, ends.at[2][1] - view.near};
  return clipBelow(height, ends);
}

/// Clips lines at `margin` pixels beside the picture, to keep the numbers small. Returns a mask of
/// the lines that are partly inside.
inline Ints clipToPicture(const SplatView& view, Floats margin, Ends& ends) {
  Ints is_inside = Ints{} == 0;
  const int sizes[2] = {view.width, view.height};
  for (int axis = 0; axis < 2; ++axis) {
    const Floats(&at)[2] = ends.at[axis];
    const Floats above[2] = {at[0] + margin, at[1] + margin};
    is_inside &= clipBelow(above, ends);
    const Floats limit = margin + static_cast<float>(sizes[axis]);
    const Floats below[2] = {limit - at[0], limit - at[1]};
    is_inside &= clipBelow(below, ends);
  }
  return is_inside;
}

void projectLines(const SplatView& view, const SplatLine* lines, std::size_t begin, std::size_t end,
                  bool at_far_end, SplatStrip* strips, PixelRectangle* rectangles) {
  for (std::size_t first = begin; first < end; first += kLanes) {
    const std::size_t count = end - first < kLanes ? end - first : kLanes;
    const auto line = [&](int lane) -> const SplatLine& {
      return itemOf(lines + first, count, lane);
    };
    Floats points[3][2];
    for (int axis = 0; axis < 3; ++axis) {
      points[axis][0] = gather([&](int lane) { return line(lane).from[axis]; });
      points[axis][1] = gather([&](int lane) { return line(lane).to[axis]; });
      for (Floats& at : points[axis]) at = (at - view.eye[axis]) * (1.0F - kLineShading.lift);
    }
    Ends ends;
    Ints is_visible = viewedEnds(view, points, ends);
    for (int side = 0; side < 2; ++side) {
      const Floats depth = ends.at[2][side];
      ends.at[0][side] /= depth;
      ends.at[1][side] /= depth;
      ends.at[2][side] = at_far_end ? broadcast(1) : windowDepth(view, depth);
    }
    const Floats half_width = 0.5F * gather([&](int lane) { return line(lane).width; });
    const Floats reach = half_width + 0.5F;  // plus half a pixel for the smooth border
    is_visible &= clipToPicture(view, reach + 1.0F, ends);

    const auto& [x, y, z] = ends.at;
    const Floats difference[2] = {x[1] - x[0], y[1] - y[0]};
    const Floats square = difference[0] * difference[0] + difference[1] * difference[1];
    Floats length;
    for (int lane = 0; lane < kLanes; ++lane) length[lane] = __builtin_sqrtf(square[lane]);
    is_visible &= length > 0.0F;
    const Floats direction[2] = {difference[0] / length, difference[1] / length};
    const Floats depth_step = (z[1] - z[0]) / length;
    for (std::size_t lane = 0; lane < count; ++lane) {
      strips[first + lane] = {{x[0][lane], y[0][lane]},
                              {direction[0][lane], direction[1][lane]},
                              length[lane],
                              half_width[lane],
                              z[0][lane],
                              depth_step[lane]};
    }
    storeRectangles(
        pixelExtent(smaller(x[0], x[1]) - reach, larger(x[0], x[1]) + reach, view.width),
        pixelExtent(smaller(y[0], y[1]) - reach, larger(y[0], y[1]) + reach, view.height),
        is_visible, count, rectangles + first);
  }
}

/// The range of a row's pixels that a strip may cover.
struct Span {
  float left;
  float right;

  /// Clips the span to a distance of `reach` from `middle`.
  void clipTo(float middle, float reach) {
    left = larger(left, middle - reach);
    right = smaller(right, middle + reach);
  }
};

/// `from_start`: the row's middle relative to the strip's start, upwards.
inline Span spanOf(const SplatStrip& strip, const PixelRectangle& rectangle, float from_start) {
  // A nearly horizontal or vertical strip is bounded by its rectangle.
  constexpr float kSlope = 1e-3F;
  const auto [x, y] = strip.direction;
  Span span{static_cast<float>(rectangle.left), static_cast<float>(rectangle.right)};
  const float origin = strip.start[0] - 0.5F;  // in pixel indices; middles of pixels are at + 0.5
  const float slack = 0.05F;
  if (y > kSlope || y < -kSlope) {
    const float across = (strip.half_width + 0.5F) / (y > 0 ? y : -y);
    span.clipTo(origin + from_start * x / y, across + slack);
  }
  if (x > kSlope || x < -kSlope) {
    const float half = 0.5F * strip.length;
    span.clipTo(origin + (half - from_start * y) / x, half / (x > 0 ? x : -x) + slack);
  }
  return span;
}

void drawLines(const SplatLine* lines, const SplatStrip* strips, const PixelRectangle* rectangles,
               const std::uint32_t* which, std::size_t count, const LinePass& pass,
               const SplatBand& band) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = which[i];
    const SplatStrip& strip = strips[index];
    const PixelRectangle& rectangle = rectangles[index];
    const Ints rgb = static_cast<int>(lines[index].colour) - Ints{};
    const Ints over = ((rgb >> 16) & 0xFF) | (rgb & 0xFF00) | ((rgb & 0xFF) << 16);
    const Rows rows = rowsIn(band, rectangle);
    for (int y = rows.begin; y < rows.end; ++y) {
      const int row = (y - band.begin) * band.stride;
      const float from_start = static_cast<float>(y) + 0.5F - strip.start[1];
      const Span span = spanOf(strip, rectangle, from_start);
      const auto last = static_cast<int>(span.right);
      for (auto x = static_cast<int>(span.left); x <= last; x += kLanes) {
        const Floats right = kLaneNumbers + (static_cast<float>(x) + 0.5F - strip.start[0]);
        const Floats along = right * strip.direction[0] + from_start * strip.direction[1];
        const Floats across = from_start * strip.direction[0] - right * strip.direction[1];
        const Floats covered =
            clamped(strip.half_width + 0.5F - magnitude(across), 0, 1) * pass.opacity;
        const Floats depth = strip.depth + along * strip.depth_step;
        const Floats box_depth = load<Floats>(band.depths + row + x);
        const Ints is_drawn = (pass.behind ? depth > box_depth : depth <= box_depth) &
                              (depth <= 1.0F) & (along >= 0.0F) & (along <= strip.length);
        if (!any(is_drawn & (covered > 0.0F))) continue;
        std::uint32_t* colours = band.colours + row + x;
        store(colours, blended(load<Ints>(colours), over, is_drawn ? covered : Floats{}));
      }
    }
  }
}
