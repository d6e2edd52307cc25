// Any bytes as a mesh that assimp reads, in the child process that keeps its crashes, its memory
// and its time apart; the first byte chooses the kind. What is looked for is in what we make of it.

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "import_through.h"

namespace broadmark::sources::meshes {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  namespace fs = std::filesystem;
  if (size == 0) return 0;
  static const SourceKind kind = sources::meshes::kind();
  static const auto folder = fs::temp_directory_path() / fmt::format("fuzz_mesh_{}", ::getpid());
  const std::vector<std::string>& extensions = kind.import->extensions;
  // By its name assimp knows what a file is.
  const fs::path file = folder / ("a" + extensions[data[0] % extensions.size()]);
  fs::create_directories(folder);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  ReadingOptions options;
  options.elements.value = "all";
  try {
    fuzz::readAllFrames(kind, file, options);
  } catch (const InputError&) {
  }
  fs::remove_all(folder);
  return 0;
}
