// How pictures are drawn off-screen.
#pragma once

#include "broadmark/render/picture.h"

namespace broadmark {

struct PictureOptions {
  int width = 1280;
  int height = 720;
  GlSource gl = GlSource::automatic;
};

}  // namespace broadmark
