// Splatting: each box is projected to a rectangle of pixels. The rays through these pixels are
// tested against the box's slabs, eight at a time; the nearest hit is kept. In the end each pixel
// is coloured once. The picture is cut into bands of rows, which the workers take one after
// another. O(boxes + pixels tested).
#include "box_splatter.h"

#include <algorithm>

#include "box_look.h"
#include "broadmark/render/camera.h"
#include "colour.h"

namespace broadmark {
namespace {

/// Small enough that the depths of a band stay in a core's cache, large enough that few boxes lie
/// in two bands.
constexpr int kBandRows = 32;

static_assert(sizeof(SplatBox) == sizeof(Primitive));

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
  view.haze_begin = focus(camera) - kBoxLook.haze_before;
  view.haze_end = focus(camera) + kBoxLook.haze_behind;
  const std::array haze = components(viewpoint.haze);
  std::copy(haze.begin(), haze.end(), view.haze);
  const std::array background = channels(viewpoint.haze);
  view.background = 0xFF000000U | background[2] << 16 | background[1] << 8 | background[0];
  return view;
}

}  // namespace

BoxSplatter::BoxSplatter(ThreadTeam& team, Isa isa)
    : kernels_(&splatKernels(isa)), team_(&team), workers_(static_cast<std::size_t>(team.size())) {}

void BoxSplatter::draw(std::span<const Primitive> primitives, const Viewpoint& viewpoint) {
  const SplatView view = splatView(viewpoint);
  const std::span boxes(reinterpret_cast<const SplatBox*>(primitives.data()), primitives.size());
  const auto pixels =
      static_cast<std::size_t>(viewpoint.width) * static_cast<std::size_t>(viewpoint.height);
  colours_.resize(pixels);
  depths_.resize(pixels);
  rectangles_.resize(boxes.size());
  const int bands = (view.height + kBandRows - 1) / kBandRows;
  for (Worker& worker : workers_) worker.boxes_by_band.resize(static_cast<std::size_t>(bands));

  team_->run([&](int worker) { project(view, boxes, worker); });
  next_band_ = 0;
  team_->run([&](int worker) {
    for (int band = next_band_++; band < bands; band = next_band_++) {
      drawBand(view, boxes, band, workers_[static_cast<std::size_t>(worker)]);
    }
  });
}

void BoxSplatter::project(const SplatView& view, std::span<const SplatBox> boxes, int worker) {
  auto& boxes_by_band = workers_[static_cast<std::size_t>(worker)].boxes_by_band;
  for (std::vector<std::uint32_t>& list : boxes_by_band) list.clear();
  const auto [begin, end] = share(boxes.size(), team_->size(), worker);
  // In pieces: the rectangles are still in the cache when they are sorted into bands.
  constexpr std::size_t kPiece = 1024;
  for (std::size_t first = begin; first < end; first += kPiece) {
    const std::size_t last = std::min(first + kPiece, end);
    kernels_->project(view, boxes.data(), first, last, rectangles_.data());
    for (std::size_t box = first; box < last; ++box) {
      const PixelRectangle& rectangle = rectangles_[box];
      if (rectangle.left > rectangle.right) continue;
      for (int band = rectangle.bottom / kBandRows; band <= rectangle.top / kBandRows; ++band) {
        boxes_by_band[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(box));
      }
    }
  }
}

void BoxSplatter::drawBand(const SplatView& view, std::span<const SplatBox> boxes, int number,
                           Worker& worker) {
  SplatBand band;
  band.begin = number * kBandRows;
  band.end = std::min(band.begin + kBandRows, view.height);
  band.stride = view.width + kSplatPadding;
  const auto room = static_cast<std::size_t>(band.stride) * kBandRows;
  worker.depths.assign(room, view.far);
  worker.foremost.assign(room, kNoBox);
  band.depths = worker.depths.data();
  band.boxes = worker.foremost.data();
  // The shares follow one another: the boxes come in the same order for every number of workers.
  for (const Worker& from : workers_) {
    const std::vector<std::uint32_t>& which = from.boxes_by_band[static_cast<std::size_t>(number)];
    kernels_->splat(view, boxes.data(), rectangles_.data(), which.data(), which.size(), band);
  }
  kernels_->shade(view, boxes.data(), band, colours_.data(), depths_.data());
}

}  // namespace broadmark
