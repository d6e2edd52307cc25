// Draws recordings as numbered pictures, for videos.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "request/run_request.h"

namespace broadmark {

struct MovieOptions {
  std::filesystem::path directory;  ///< "": no movies
  std::uint32_t every = 1;          ///< frames between successive pictures
  PictureOptions picture;
};

/// Creates the directory and a context for drawing. Throws InputError, also without OpenGL.
std::unique_ptr<OffscreenContext> prepareMovies(const MovieOptions&);

/// Draws movies off-screen with the camera of the paper's figures and overlapping boxes in another
/// colour: one movie for all recordings that differ only in their kind. A movie is a folder with
/// the recording's name that contains frame_00000.png (the initial pose), frame_00001.png (`every`
/// frames later), … An existing movie is kept if its movie.json states the same recording hash and
/// options. Shows progress unless `quiet`. Returns false when interrupted. Throws InputError.
bool makeMovies(OffscreenContext&, const MovieOptions&,
                std::vector<std::filesystem::path> recordings, bool quiet);

}  // namespace broadmark
