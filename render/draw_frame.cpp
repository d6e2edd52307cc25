// A picture of one frame, as in the paper's figures.
#include "render/draw_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/box_renderer.h"
#include "render/camera.h"
#include "render/caption.h"
#include "render/framebuffer.h"

namespace broadmark {
namespace {

constexpr Rgb kGrid = 0xC6CED8;
constexpr Rgb kWorldEdge = 0x8A97A6;
constexpr Rgb kTitle = 0x1F2933;
constexpr Rgb kText = 0x52606D;

/// For each body whether it is in a pair. A pair of a wrong answer may name bodies that are not.
std::vector<bool> overlappingBodies(std::size_t bodies, PairRuns overlaps) {
  std::vector<bool> overlapping(bodies, false);
  for (const PairRun run : overlaps) {
    for (const Pair pair : run) {
      for (const std::uint32_t body : {pair.a, pair.b}) {
        if (body < bodies) overlapping[body] = true;
      }
    }
  }
  return overlapping;
}

std::vector<Primitive> colouredBoxes(std::span<const Aabb> boxes,
                                     const std::vector<bool>& overlapping, const ViewSpace& space) {
  std::vector<Primitive> primitives;
  primitives.reserve(boxes.size());
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    const Rgb colour = overlapping[body] ? kOverlappingBox : kFreeBox;
    primitives.push_back(boxPrimitive(boxes[body], colour, space));
  }
  return primitives;
}

void clear(const Gl& gl, Rgb colour) {
  const auto component = [&](int shift) {
    return static_cast<float>((colour >> shift) & 0xFFU) / 255.0F;
  };
  gl.ClearColor(component(16), component(8), component(0), 1);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

/// Floor, boxes and lines into the current framebuffer.
void drawScene(const Gl& gl, const Aabb& world, std::span<const Primitive> boxes,
               const ViewSpace& space, const Viewpoint& viewpoint, std::size_t max_batch) {
  clear(gl, kBackground);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.Disable(GL_BLEND);
  BoxRenderer box_renderer(gl, max_batch);
  // The floor lies behind whatever rests on it or sinks through it.
  Aabb floor = world;
  floor.max[1] = floor.min[1];
  gl.DepthMask(GL_FALSE);
  box_renderer.upload(std::array{boxPrimitive(floor, kFloor, space)});
  box_renderer.draw(viewpoint);

  const float line_width = std::max(1.0F, static_cast<float>(viewpoint.height) / 600);
  LineRenderer line_renderer(gl);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  line_renderer.upload(floorGrid(world, kGrid, line_width, space));
  line_renderer.draw(viewpoint);

  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  box_renderer.upload(boxes);
  box_renderer.draw(viewpoint);

  gl.DepthMask(GL_FALSE);
  gl.Enable(GL_BLEND);
  line_renderer.upload(wireframe(world, kWorldEdge, line_width, space));
  line_renderer.draw(viewpoint);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural) {
  return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

/// A recording from elsewhere may have names as long as 127 letters.
std::string abbreviated(const std::string& text) {
  constexpr std::size_t kLongest = 32;
  return text.size() <= kLongest ? text : text.substr(0, kLongest - 3) + "...";
}

void drawLegend(Picture& picture, const SceneInfo& scene, const Frame& frame,
                const std::vector<bool>& overlapping, std::uint64_t pairs) {
  const auto in_pairs =
      static_cast<std::uint64_t>(std::count(overlapping.begin(), overlapping.end(), true));
  drawCaption(
      picture,
      {{{fmt::format("{} {}", abbreviated(scene.name), abbreviated(scene.object_type)), kTitle},
        {fmt::format("frame {}", frame.index), kText}},
       {{counted(frame.boxes.size(), "body", "bodies"), kText},
        {counted(pairs, "pair", "pairs"), kText}},
       {{fmt::format("{} overlapping", in_pairs), kText, true, kOverlappingBox}},
       {{fmt::format("{} free", frame.boxes.size() - in_pairs), kText, true, kFreeBox}}},
      kBackground);
}

}  // namespace

Picture drawFrame(OffscreenContext& context, const SceneInfo& scene, const Frame& frame,
                  PairRuns overlaps, int width, int height, std::size_t max_batch) {
  for (const int side : {width, height}) {
    if (side < 1 || side > kLargestPicture) {
      throw RenderError(fmt::format("a picture of {} x {} cannot be drawn: 1 to {} pixels a side",
                                    width, height, kLargestPicture));
    }
  }
  const Gl gl(context);
  const Aabb shown = shownBox(scene.world, frame.boxes);
  const ViewSpace space = viewSpaceOf(shown);
  const double aspect = static_cast<double>(width) / height;
  const Viewpoint viewpoint{figureCamera(space.toView(shown), aspect), width, height, kBackground};
  const std::vector<bool> overlapping = overlappingBodies(frame.boxes.size(), overlaps);

  const Framebuffer framebuffer(gl, width, height);
  framebuffer.bind();
  drawScene(gl, scene.world, colouredBoxes(frame.boxes, overlapping, space), space, viewpoint,
            max_batch);
  Picture picture = framebuffer.read();
  drawLegend(picture, scene, frame, overlapping, pairCount(overlaps));
  return picture;
}

Picture drawFrame(OffscreenContext& context, const SceneInfo& scene, const Frame& frame,
                  PairRuns overlaps, int width, int height) {
  return drawFrame(context, scene, frame, overlaps, width, height,
                   std::numeric_limits<std::size_t>::max());
}

}  // namespace broadmark
