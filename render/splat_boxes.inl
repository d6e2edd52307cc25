// Boxes: projected to rectangles of pixels, depth-tested per pixel, then shaded.

/// The corners of a box relative to the eye; Number is float, or Floats for a box per lane.
template <class Number>
struct Corners {
  Number low[3];
  Number high[3];
};

/// Enlarges every side to at least this number of pixels.
template <class Number>
inline void enlarge(Corners<Number>& box, Number pixels, const SplatView& view) {
  Number centre[3];
  for (int axis = 0; axis < 3; ++axis) centre[axis] = 0.5F * (box.low[axis] + box.high[axis]);
  const Number depth =
      view.forward[0] * centre[0] + view.forward[1] * centre[1] + view.forward[2] * centre[2];
  const Number half = 0.5F * view.pixel * pixels * depth;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = smaller(box.low[axis], centre[axis] - half);
    box.high[axis] = larger(box.high[axis], centre[axis] + half);
  }
}

inline Corners<float> cornersOf(const SplatView& view, const SplatBox& box) {
  Corners<float> corners;
  for (int axis = 0; axis < 3; ++axis) {
    corners.low[axis] = box.low[axis] - view.eye[axis];
    corners.high[axis] = box.high[axis] - view.eye[axis];
  }
  enlarge(corners, box.width, view);
  return corners;
}

/// The corners of the boxes box(lane).
template <class BoxOf>
inline Corners<Floats> cornersOf(const SplatView& view, const BoxOf& box) {
  Corners<Floats> corners;
  for (int axis = 0; axis < 3; ++axis) {
    corners.low[axis] = gather([&](int lane) { return box(lane).low[axis]; });
    corners.high[axis] = gather([&](int lane) { return box(lane).high[axis]; });
    corners.low[axis] -= view.eye[axis];
    corners.high[axis] -= view.eye[axis];
  }
  enlarge(corners, gather([&](int lane) { return box(lane).width; }), view);
  return corners;
}

void projectBoxes(const SplatView& view, const SplatBox* boxes, std::size_t begin, std::size_t end,
                  PixelRectangle* rectangles) {
  const auto width = static_cast<float>(view.width);
  const auto height = static_cast<float>(view.height);
  for (std::size_t first = begin; first < end; first += kLanes) {
    const std::size_t count = end - first < kLanes ? end - first : kLanes;
    const Corners<Floats> box = cornersOf(
        view, [&](int lane) -> const SplatBox& { return itemOf(boxes + first, count, lane); });

    // Each corner is a sum of three parts, one per axis.
    Floats x[3][2];
    Floats y[3][2];
    Floats depth[3][2];
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const Floats at = side == 0 ? box.low[axis] : box.high[axis];
        x[axis][side] = view.column[axis] * at;
        y[axis][side] = view.row[axis] * at;
        depth[axis][side] = view.forward[axis] * at;
      }
    }
    const float kHuge = 3e38F;
    Floats left = broadcast(kHuge);
    Floats right = broadcast(-kHuge);
    Floats bottom = left;
    Floats top = right;
    Floats nearest = left;
    Floats farthest = right;
    for (int corner = 0; corner < 8; ++corner) {
      const int i = corner & 1;
      const int j = (corner >> 1) & 1;
      const int k = corner >> 2;
      const Floats corner_depth = depth[0][i] + depth[1][j] + depth[2][k];
      const Floats inverse = 1.0F / corner_depth;
      const Floats corner_x = (x[0][i] + x[1][j] + x[2][k]) * inverse;
      const Floats corner_y = (y[0][i] + y[1][j] + y[2][k]) * inverse;
      left = smaller(left, corner_x);
      right = larger(right, corner_x);
      bottom = smaller(bottom, corner_y);
      top = larger(top, corner_y);
      nearest = smaller(nearest, corner_depth);
      farthest = larger(farthest, corner_depth);
    }
    // A box that intersects the near plane may cover any pixel; a nearer box covers no pixel.
    const Ints crosses = nearest < view.near;
    const Ints is_visible = (farthest >= view.near) & (nearest <= view.far);
    const Extent columns =
        pixelExtent(crosses ? broadcast(0) : left, crosses ? broadcast(width) : right, view.width);
    const Extent rows = pixelExtent(crosses ? broadcast(0) : bottom,
                                    crosses ? broadcast(height) : top, view.height);
    storeRectangles(columns, rows, is_visible, count, rectangles + first);
  }
}

/// The directions through the middles of eight pixels of a row.
struct Rays {
  Floats direction[3];
};
inline Rays raysFrom(const SplatView& view, int x, int y) {
  const Floats columns = kLaneNumbers + (static_cast<float>(x) + 0.5F);
  const float row = static_cast<float>(y) + 0.5F;
  Rays rays;
  for (int axis = 0; axis < 3; ++axis) {
    rays.direction[axis] =
        (view.corner[axis] + row * view.step_y[axis]) + columns * view.step_x[axis];
  }
  return rays;
}

/// The minimum depth of a box.
inline float nearestOf(const SplatView& view, const Corners<float>& box) {
  float nearest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    nearest += smaller(view.forward[axis] * box.low[axis], view.forward[axis] * box.high[axis]);
  }
  return nearest;
}

/// The depths at which rays enter and leave a box; they miss it if `enter` > `leave`.
struct Crossing {
  Floats enter;
  Floats leave;
};
inline Crossing crossingOf(const Corners<float>& box, const Rays& rays) {
  Crossing crossing;
  for (int axis = 0; axis < 3; ++axis) {
    const Floats inverse = 1.0F / rays.direction[axis];
    const Floats a = box.low[axis] * inverse;
    const Floats b = box.high[axis] * inverse;
    const Floats first = smaller(a, b);
    const Floats last = larger(a, b);
    crossing.enter = axis == 0 ? first : larger(crossing.enter, first);
    crossing.leave = axis == 0 ? last : smaller(crossing.leave, last);
  }
  return crossing;
}

void splatBoxes(const SplatView& view, const SplatBox* boxes, const PixelRectangle* rectangles,
                const std::uint32_t* which, std::size_t count, const SplatBand& band) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = which[i];
    const PixelRectangle& rectangle = rectangles[index];
    const Corners<float> box = cornersOf(view, boxes[index]);
    const float nearest = nearestOf(view, box);
    const Rows rows = rowsIn(band, rectangle);
    for (int y = rows.begin; y < rows.end; ++y) {
      const int row = (y - band.begin) * band.stride;
      // Rays beside the rectangle miss the box, so the last eight pixels may cross its border.
      for (int x = rectangle.left; x <= rectangle.right; x += kLanes) {
        float* depths = band.depths + row + x;
        const Floats before = load<Floats>(depths);
        // In a dense scene, most boxes are hidden by boxes drawn before.
        if (!any(before > nearest)) continue;
        const auto [enter, leave] = crossingOf(box, raysFrom(view, x, y));
        std::uint32_t* foremost = band.boxes + row + x;
        const Ints hit = (enter <= leave) & (enter >= view.near) & (enter < before);
        store(depths, hit ? enter : before);
        store(foremost, hit ? static_cast<int>(index) - Ints{} : load<Ints>(foremost));
      }
    }
  }
}

/// x, y or z, selected by the axis of each lane.
inline Floats selectByAxis(Ints is_x, Ints is_y, Floats x, Floats y, Floats z) {
  return is_x ? x : (is_y ? y : z);
}

/// The colours of eight pixels covered by the boxes box(lane) at these depths.
template <class BoxOf>
inline Ints shaded(const SplatView& view, const BoxOf& box_of, const Rays& rays, Floats depth) {
  const Corners<Floats> box = cornersOf(view, box_of);
  const Floats* ray = rays.direction;

  // The ray enters the box through the slab with the greatest entry depth.
  Floats enter[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Floats inverse = 1.0F / ray[axis];
    enter[axis] = smaller(box.low[axis] * inverse, box.high[axis] * inverse);
  }
  const Ints is_x = (enter[0] >= enter[1]) & (enter[0] >= enter[2]);
  const Ints is_y = ~is_x & (enter[1] >= enter[2]);

  // By axis: the relative position of the hit point between the faces, and its change per pixel.
  Floats fraction[3];
  Floats change[3];
  const Floats along = selectByAxis(is_x, is_y, ray[0], ray[1], ray[2]);
  const auto change_along = [&](const float* step, int axis) {
    const Floats turn =
        selectByAxis(is_x, is_y, broadcast(step[0]), broadcast(step[1]), broadcast(step[2]));
    return magnitude(depth * (step[axis] - turn / along * ray[axis]));
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Floats size = box.high[axis] - box.low[axis];
    fraction[axis] = clamped((depth * ray[axis] - box.low[axis]) / size, 0, 1);
    change[axis] =
        larger((change_along(view.step_x, axis) + change_along(view.step_y, axis)) / size,
               broadcast(1e-6F));
  }
  const Floats u = selectByAxis(is_x, is_y, fraction[2], fraction[0], fraction[0]);
  const Floats v = selectByAxis(is_x, is_y, fraction[1], fraction[2], fraction[1]);
  const Floats pixel_u = selectByAxis(is_x, is_y, change[2], change[0], change[0]);
  const Floats pixel_v = selectByAxis(is_x, is_y, change[1], change[2], change[1]);

  // The rest is the same as in box.frag.
  const Floats from_edge = smaller(smaller(u, 1.0F - u) / pixel_u, smaller(v, 1.0F - v) / pixel_v);
  Floats edge = 1.0F - smoothstep(broadcast(view.edge_pixels - 0.5F),
                                  broadcast(view.edge_pixels + 0.7F), from_edge);
  edge *= smoothstep(broadcast(2), broadcast(14), smaller(1.0F / pixel_u, 1.0F / pixel_v));
  const Ints looks_down = box.low[1] + box.high[1] > 0.0F;
  const Floats light_y =
      looks_down ? broadcast(kBoxShading.underside) : broadcast(kBoxShading.light[1]);
  const Floats light = selectByAxis(is_x, is_y, broadcast(kBoxShading.light[0]), light_y,
                                    broadcast(kBoxShading.light[2]));
  const Floats foot = is_y ? Floats{} : kBoxShading.foot_darkness * (1.0F - v);
  const Floats brightness = light * (1.0F - foot) * (1.0F - kBoxShading.edge_darkness * edge);
  const Floats haze =
      kBoxShading.haze * smoothstep(broadcast(view.haze_begin), broadcast(view.haze_end), depth);

  const Ints rgb =
      __builtin_convertvector(gather([&](int lane) { return box_of(lane).colour; }), Ints);
  Ints rgba = static_cast<int>(0xFF000000U) - Ints{};
  for (int channel = 0; channel < 3; ++channel) {
    const Floats full = channelOf(rgb, channel) / 255.0F;
    const Floats value = mixed(full * brightness, broadcast(view.haze[channel]), haze);
    rgba |= __builtin_convertvector(clamped(value, 0, 1) * 255.0F + 0.5F, Ints) << (8 * channel);
  }
  return rgba;
}

void shadeBoxes(const SplatView& view, const SplatBox* boxes, const SplatBand& band) {
  for (int y = band.begin; y < band.end; ++y) {
    const int row = (y - band.begin) * band.stride;
    for (int x = 0; x < view.width; x += kLanes) {
      float* depths = band.depths + row + x;
      std::uint32_t* colours = band.colours + row + x;
      const std::uint32_t* which = band.boxes + row + x;
      // Lanes without a box use the box of another lane.
      std::uint32_t fallback = kNoBox;
      for (int lane = 0; lane < kLanes; ++lane)
        fallback = which[lane] != kNoBox ? which[lane] : fallback;
      if (fallback == kNoBox) {
        store(depths, broadcast(1));
        continue;
      }
      const Ints is_covered = load<Ints>(which) != static_cast<int>(kNoBox);
      const auto depth = load<Floats>(depths);
      const Ints colour = shaded(
          view,
          [&](int lane) -> const SplatBox& {
            return boxes[which[lane] != kNoBox ? which[lane] : fallback];
          },
          raysFrom(view, x, y), depth);
      store(colours, is_covered ? colour : load<Ints>(colours));
      store(depths, is_covered ? windowDepth(view, depth) : broadcast(1));
    }
  }
}

void blendBoxes(const SplatView& view, const SplatBox* boxes, const PixelRectangle* rectangles,
                const std::uint32_t* which, std::size_t count, float opacity,
                const SplatBand& band) {
  for (std::size_t i = 0; i < count; ++i) {
    const SplatBox& box = boxes[which[i]];
    const PixelRectangle& rectangle = rectangles[which[i]];
    const Corners<float> corners = cornersOf(view, box);
    const Rows rows = rowsIn(band, rectangle);
    for (int y = rows.begin; y < rows.end; ++y) {
      const int row = (y - band.begin) * band.stride;
      for (int x = rectangle.left; x <= rectangle.right; x += kLanes) {
        const Rays rays = raysFrom(view, x, y);
        const auto [enter, leave] = crossingOf(corners, rays);
        const Ints hit = (enter <= leave) & (enter >= view.near) &
                         (windowDepth(view, enter) <= load<Floats>(band.depths + row + x));
        if (!any(hit)) continue;
        std::uint32_t* colours = band.colours + row + x;
        const auto under = load<Ints>(colours);
        const Ints over = shaded(view, [&](int) -> const SplatBox& { return box; }, rays, enter);
        store(colours, hit ? blended(under, over, broadcast(opacity)) : under);
      }
    }
  }
}
