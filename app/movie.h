// Recordings as pictures, one after the other, for a video.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "broadmark/render/picture.h"

namespace broadmark {

struct MovieOptions {
  std::filesystem::path directory;  ///< "": no movies
  std::uint32_t every = 1;          ///< frames from one picture to the next
  int width = 1280;
  int height = 720;
  GlSource gl = GlSource::automatic;
};

/// Draws movies off-screen with the camera of the paper's figures, boxes that overlap another in
/// another colour. To be used by one thread. A movie is a folder called as its recording, with
/// frame_00000.png (the initial pose), frame_00001.png (`every` frames later), …
class MovieMaker {
 public:
  /// Throws InputError: no OpenGL to draw with, or no such directory to be had.
  explicit MovieMaker(MovieOptions options);
  ~MovieMaker();

  /// Told after each picture; returning false stops.
  using PictureProgress = std::function<bool(std::uint32_t picture)>;

  [[nodiscard]] std::uint32_t pictures(const SceneInfo&) const;

  /// Draws a recording, unless its movie is there already (a movie.json in the folder says of which
  /// recording, by hash, and how). Returns the folder, or "" when stopped. Throws InputError.
  std::filesystem::path make(const std::filesystem::path& recording,
                             const PictureProgress& progress);

 private:
  MovieOptions options_;
  std::unique_ptr<OffscreenContext> context_;
};

}  // namespace broadmark
