// Splatting: each box is projected to a rectangle of pixels. The rays through these pixels are
// tested against the box's slabs, eight at a time, and the nearest hit is stored. After all boxes,
// each pixel is shaded once, and lines are blended, tested against the depths of the boxes. The
// picture is divided into bands of rows, which workers process dynamically.
// O(boxes + lines + pixels tested).
#include "software_rasterizer.h"

#include <algorithm>

#include "broadmark/render/camera.h"
#include "broadmark/render/colour.h"
#include "shading.h"

namespace broadmark {
namespace {

static_assert(sizeof(SplatBox) == sizeof(Primitive));
static_assert(sizeof(SplatLine) == sizeof(Primitive));

/// Primitives in the kernels' type.
template <class Item>
std::span<const Item> itemsOf(std::span<const Primitive> primitives) {
  return {reinterpret_cast<const Item*>(primitives.data()), primitives.size()};
}

SplatView splatView(const Viewpoint& viewpoint) {
  const Camera& camera = viewpoint.camera;
  const CameraAxes axes = axesOf(camera);
  SplatView view;
  view.width = viewpoint.width;
  view.height = viewpoint.height;
  const float pixel_width =
      (camera.window_max[0] - camera.window_min[0]) / static_cast<float>(viewpoint.width);
  const float pixel_height = pixelSize(camera, viewpoint.height);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float forward = -axes.back[axis];
    view.eye[axis] = camera.eye[axis];
    view.forward[axis] = forward;
    view.column[axis] = (axes.right[axis] - camera.window_min[0] * forward) / pixel_width;
    view.row[axis] = (axes.up[axis] - camera.window_min[1] * forward) / pixel_height;
    view.corner[axis] =
        forward + camera.window_min[0] * axes.right[axis] + camera.window_min[1] * axes.up[axis];
    view.step_x[axis] = pixel_width * axes.right[axis];
    view.step_y[axis] = pixel_height * axes.up[axis];
  }
  view.near = camera.near;
  view.far = camera.far;
  view.pixel = pixel_height;
  view.edge_pixels = edgePixels(viewpoint.height);
  view.haze_begin = focus(camera) - kBoxShading.haze_before;
  view.haze_end = focus(camera) + kBoxShading.haze_behind;
  const std::array haze = components(viewpoint.haze);
  std::copy(haze.begin(), haze.end(), view.haze);
  return view;
}

/// RGBA8 in memory order.
std::uint32_t pixelOf(Rgb colour) {
  const std::array rgb = channels(colour);
  return 0xFF000000U | rgb[2] << 16 | rgb[1] << 8 | rgb[0];
}

}  // namespace

SoftwareRasterizer::SoftwareRasterizer(ThreadTeam& team, Isa isa)
    : kernels_(&splatKernels(isa)), team_(&team), workers_(static_cast<std::size_t>(team.size())) {}

void SoftwareRasterizer::draw(const ScenePrimitives& scene, const Viewpoint& viewpoint) {
  const SplatView view = splatView(viewpoint);
  const std::uint32_t background = pixelOf(viewpoint.haze);
  const int bands = (view.height + BandLists::kRows - 1) / BandLists::kRows;
  setPrimitives(scene, bands);
  team_->run([&](int worker) { project(view, worker); });
  colours_.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  next_band_ = 0;
  team_->run([&](int worker) {
    for (int band = next_band_++; band < bands; band = next_band_++) {
      drawBand(view, background, band, workers_[static_cast<std::size_t>(worker)]);
    }
  });
}

void SoftwareRasterizer::setPrimitives(const ScenePrimitives& scene, int bands) {
  const auto set_boxes = [&](BoxLayer& layer, std::span<const Primitive> boxes) {
    layer.boxes = itemsOf<SplatBox>(boxes);
    layer.lists.reset(boxes.size(), bands, team_->size());
  };
  set_boxes(floor_, scene.floor);
  set_boxes(bodies_, scene.boxes);
  set_boxes(glass_, scene.glass);
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    const LineLayer& from = scene.lines[i];
    StripLayer& layer = strips_[i];
    layer.opacity = from.opacity;
    layer.opacity_behind = from.opacity_behind;
    layer.where_no_box_is = from.where_no_box_is;
    layer.lines = itemsOf<SplatLine>(from.lines);
    layer.strips.resize(from.lines.size());
    layer.lists.reset(from.lines.size(), bands, team_->size());
  }
}

void SoftwareRasterizer::project(const SplatView& view, int worker) {
  for (BoxLayer* layer : {&floor_, &bodies_, &glass_}) {
    layer->lists.fill(worker, [&](std::size_t first, std::size_t last, PixelRectangle* rectangles) {
      kernels_->project_boxes(view, layer->boxes.data(), first, last, rectangles);
    });
  }
  for (StripLayer& layer : strips_) {
    layer.lists.fill(worker, [&](std::size_t first, std::size_t last, PixelRectangle* rectangles) {
      kernels_->project_lines(view, layer.lines.data(), first, last, layer.where_no_box_is,
                              layer.strips.data(), rectangles);
    });
  }
}

void SoftwareRasterizer::drawBand(const SplatView& view, std::uint32_t background, int number,
                                  Worker& worker) {
  SplatBand band;
  band.begin = number * BandLists::kRows;
  band.end = std::min(band.begin + BandLists::kRows, view.height);
  band.stride = view.width + kSplatPadding;
  const auto size = static_cast<std::size_t>(band.stride) * BandLists::kRows;
  worker.depths.resize(size);
  worker.foremost.resize(size);
  worker.colours.assign(size, background);
  band.depths = worker.depths.data();
  band.boxes = worker.foremost.data();
  band.colours = worker.colours.data();

  for (const BoxLayer* layer : {&floor_, &bodies_}) {
    std::ranges::fill(worker.depths, view.far);
    std::ranges::fill(worker.foremost, kNoBox);
    drawBoxes(view, *layer, number, band);
  }
  glass_.lists.forEach(number,
                       [&](std::span<const std::uint32_t> boxes, const PixelRectangle* rectangles) {
                         kernels_->blend_boxes(view, glass_.boxes.data(), rectangles, boxes.data(),
                                               boxes.size(), kBoxShading.glass, band);
                       });
  for (const StripLayer& layer : strips_) drawLines(layer, number, band);
  for (int y = band.begin; y < band.end; ++y) {
    const auto from = worker.colours.begin() + std::ptrdiff_t{y - band.begin} * band.stride;
    std::copy(from, from + view.width, colours_.begin() + std::ptrdiff_t{y} * view.width);
  }
}

void SoftwareRasterizer::drawBoxes(const SplatView& view, const BoxLayer& layer, int number,
                                   const SplatBand& band) const {
  layer.lists.forEach(number, [&](std::span<const std::uint32_t> boxes,
                                  const PixelRectangle* rectangles) {
    kernels_->splat_boxes(view, layer.boxes.data(), rectangles, boxes.data(), boxes.size(), band);
  });
  kernels_->shade_boxes(view, layer.boxes.data(), band);
}

void SoftwareRasterizer::drawLines(const StripLayer& layer, int number,
                                   const SplatBand& band) const {
  const auto draw = [&](const LinePass& pass) {
    layer.lists.forEach(
        number, [&](std::span<const std::uint32_t> lines, const PixelRectangle* rectangles) {
          kernels_->draw_lines(layer.lines.data(), layer.strips.data(), rectangles, lines.data(),
                               lines.size(), pass, band);
        });
  };
  if (layer.opacity_behind > 0) draw({.behind = true, .opacity = layer.opacity_behind});
  draw({.behind = false, .opacity = layer.opacity});
}

}  // namespace broadmark
