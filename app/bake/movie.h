// Recordings as numbered pictures, for a video.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "broadmark/frame.h"
#include "request/run_request.h"

namespace broadmark {

struct MovieOptions {
  std::filesystem::path directory;  ///< "": no movies
  std::uint32_t every = 1;          ///< frames from one picture to the next
  PictureOptions picture;
};

/// Draws movies off-screen with the camera of the paper's figures and overlapping boxes in another
/// colour. For one thread. A movie is a folder of its recording's name with frame_00000.png (the
/// initial pose), frame_00001.png (`every` frames later), …
class MovieMaker {
 public:
  /// Throws InputError when there is no OpenGL or the directory cannot be made.
  explicit MovieMaker(MovieOptions options);
  ~MovieMaker();

  /// Told after each picture; returning false stops.
  using PictureProgress = std::function<bool(std::uint32_t picture)>;

  /// How many pictures a movie has.
  [[nodiscard]] std::uint32_t pictures(const SceneInfo&) const;

  /// Draws a recording, unless its movie is already there: a movie.json in the folder states the
  /// recording's hash and how it was drawn. Returns the folder, or "" when stopped. Throws
  /// InputError.
  std::filesystem::path make(const std::filesystem::path& recording,
                             const PictureProgress& progress);

 private:
  MovieOptions options_;
  std::unique_ptr<OffscreenContext> context_;
};

}  // namespace broadmark
