// Replaces the renderer in a build without it.

#include "broadmark/render/picture.h"

namespace broadmark {
namespace {

[[noreturn]] void refuse() { throw RenderError("this build has no renderer"); }

}  // namespace

std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource) { refuse(); }
Picture drawFrame(OffscreenContext&, const SceneInfo&, const Frame&, PairRuns, int, int) {
  refuse();
}
void writePng(const std::filesystem::path&, const Picture&) { refuse(); }
Picture readPng(const std::filesystem::path&) { refuse(); }

}  // namespace broadmark
