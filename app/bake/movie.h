// Recordings as numbered pictures, for a video.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "request/run_request.h"

namespace broadmark {

struct MovieOptions {
  std::filesystem::path directory;  ///< "": no movies
  std::uint32_t every = 1;          ///< frames from one picture to the next
  PictureOptions picture;
};

/// Makes the directory. Returns what draws. Throws InputError, also when there is no OpenGL.
std::unique_ptr<OffscreenContext> prepareMovies(const MovieOptions&);

/// Draws movies off-screen with the camera of the paper's figures and overlapping boxes in another
/// colour: one for all recordings that differ only in their kind. A movie is a folder of its
/// recording's name with frame_00000.png (the initial pose), frame_00001.png (`every` frames
/// later), … One that is there is kept: a movie.json in the folder states the recording's hash and
/// how it was drawn. Shows progress unless `quiet`. False when interrupted. Throws InputError.
bool makeMovies(OffscreenContext&, const MovieOptions&,
                std::vector<std::filesystem::path> recordings, bool quiet);

}  // namespace broadmark
