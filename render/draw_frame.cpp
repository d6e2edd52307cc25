// Pictures of frames, as in the paper's figures.

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/render/camera.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/palette.h"
#include "broadmark/render/picture.h"
#include "broadmark/render/scene_view.h"
#include "caption.h"

namespace broadmark {
namespace {

constexpr const Palette& kPalette = kLightPalette;

/// Whether each body is in a pair. A wrong pair may name absent or nonexistent bodies.
std::vector<bool> overlappingBodies(std::span<const Aabb> boxes, PairRuns overlaps) {
  std::vector<bool> overlapping(boxes.size(), false);
  for (const PairRun pair_run : overlaps) {
    for (const Pair pair : pair_run) {
      for (const std::uint32_t body : {pair.a, pair.b}) {
        if (body < boxes.size() && !isEmpty(boxes[body])) overlapping[body] = true;
      }
    }
  }
  return overlapping;
}

std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural) {
  return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

/// Names in a recording may have up to kMaxNameLength characters.
std::string abbreviated(const std::string& text) {
  constexpr std::size_t kMaxLength = 32;
  return text.size() <= kMaxLength ? text : text.substr(0, kMaxLength - 3) + "...";
}

void drawLegend(Picture& picture, const SceneInfo& scene, const Frame& frame,
                const std::vector<bool>& overlapping, std::uint64_t pairs) {
  const auto in_pairs =
      static_cast<std::uint64_t>(std::count(overlapping.begin(), overlapping.end(), true));
  const auto absent = static_cast<std::uint64_t>(std::ranges::count_if(frame.boxes, isEmpty));
  const std::uint64_t bodies = frame.boxes.size() - absent;
  drawCaption(picture,
              {{{fmt::format("{} {}", abbreviated(scene.name), abbreviated(scene.object_type)),
                 kPalette.text},
                {fmt::format("frame {}", frame.index), kPalette.faint}},
               {{counted(bodies, "body", "bodies"), kPalette.faint},
                {counted(pairs, "pair", "pairs"), kPalette.faint}},
               {{fmt::format("{} overlapping", in_pairs), kPalette.faint, kPalette.overlapping}},
               {{fmt::format("{} free", bodies - in_pairs), kPalette.faint, kPalette.free}}},
              kPalette.background);
}

}  // namespace

Picture drawFrame(OffscreenContext& context, const SceneInfo& scene, const Frame& frame,
                  PairRuns overlaps, int width, int height) {
  for (const int side : {width, height}) {
    if (side < 1 || side > kMaxPictureSide) {
      throw RenderError(fmt::format("a picture of {} x {} cannot be drawn: 1 to {} pixels a side",
                                    width, height, kMaxPictureSide));
    }
  }
  const Gl gl(context);
  const Aabb shown = shownBox(scene.world, frame.boxes);
  const std::vector<bool> overlapping = overlappingBodies(frame.boxes, overlaps);
  std::vector<Rgb> colours(frame.boxes.size());
  for (std::size_t body = 0; body < colours.size(); ++body) {
    colours[body] = overlapping[body] ? kPalette.overlapping : kPalette.free;
  }

  SceneViewContent content;
  content.space = viewSpaceOf(shown);
  content.world = scene.world;
  content.boxes = frame.boxes;
  content.colours = colours;
  content.scale = std::max(1.0F, static_cast<float>(height) / 600);
  // Always by OpenGL, even if it is slow, because only OpenGL draws smooth borders.
  SceneViewOptions options;
  options.technique = Technique::gl;
  options.samples = Framebuffer::kSamples;
  options.threads = 1;
  SceneView view(gl, options);
  view.resize(width, height);
  view.draw(content,
            figureCamera(content.space.toView(shown), static_cast<double>(width) / height));
  Picture picture = view.read();
  drawLegend(picture, scene, frame, overlapping, pairCount(overlaps));
  return picture;
}

}  // namespace broadmark
