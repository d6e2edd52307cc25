// Fixture of the tests of meshes: files, and what is read from them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "app/import_files.h"
#include "app/mesh_files.h"

namespace broadmark::tests {

class MeshImports : public Imports {
 protected:
  MeshContents readWith(MeshReader& reader, const std::string& text) const {
    // A new file each time: what replaces another is written to disk, which takes milliseconds.
    std::filesystem::remove(directory_ / "mesh");
    std::ofstream(directory_ / "mesh", std::ios::binary) << text;
    return meshIn(reader, directory_ / "mesh");
  }
  [[nodiscard]] std::string refusal(MeshReader& reader, const std::string& text) const {
    return inputErrorOf([&] { readWith(reader, text); });
  }
  /// Frames of the files of a folder, and what was understood of them.
  Source sequence(const std::string& folder, const ParameterValues& options = {}) const {
    ReadingOptions reading;
    setParameters(reading, options);
    const std::string name = (directory_ / folder).string();
    return importedSource({name}, *importOf(name), reading);
  }
};

}  // namespace broadmark::tests
