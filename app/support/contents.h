// Contents of files to import: uncompressed, and seekable even if they come from a pipe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "broadmark/files.h"

namespace broadmark::imports {

/// Standard input, as the name of a source; "-" is another name for it.
inline constexpr const char* kStandardInput = "/dev/stdin";

/// Opens a file for positioned reads. A gzip file is uncompressed into an unnamed file. A pipe is
/// read to its end once; its contents are kept until the process ends. Throws InputError.
FileDescriptor openContents(const std::filesystem::path&);

/// The start of a file, by which readers recognise it.
struct FileStart {
  std::filesystem::path path;
  std::string text;        ///< uncompressed, without a byte order mark, at most 64 KiB
  bool whole = false;      ///< whether `text` is all of the file
  std::uint64_t size = 0;  ///< of the file in bytes, uncompressed
};
/// Throws InputError.
FileStart startOf(const std::filesystem::path&);

}  // namespace broadmark::imports
