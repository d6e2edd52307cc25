// Simulated folders /proc and /sys.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <string>

#include "broadmark/cores.h"
#include "engine/helpers.h"

namespace broadmark::tests {

class MadeUpSystem {
 public:
  [[nodiscard]] SystemFolders folders() const {
    return {.proc = directory_ / "proc", .sys = directory_ / "sys"};
  }

  /// `path` begins with "proc/" or "sys/".
  void write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = directory_ / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  void haveCores(int count) const {
    std::string stat;
    for (int core = 0; core < count; ++core) stat += fmt::format("cpu{} 1 1 1 1\n", core);
    write("proc/stat", stat);
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace broadmark::tests
