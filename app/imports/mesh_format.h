// Formats of mesh files, recognised by their contents.
#pragma once

#include <filesystem>
#include <string>

#include "support/contents.h"

namespace broadmark::imports {

/// "ply", "obj", "stl" or "gltf", as in ReadingOptions::format; "": none of these.
std::string meshFormat(const FileStart&);

/// The format of a file: the `stated` one unless that is "auto", else that of its contents, else
/// that of its name. Throws InputError.
std::string meshFormat(const std::filesystem::path&, const std::string& stated);

}  // namespace broadmark::imports
