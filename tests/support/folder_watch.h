// Waits for changes in a folder.
#pragma once

#include <filesystem>
#include <functional>

#include "broadmark/files.h"

namespace broadmark::tests {

/// Wakes at every change below a folder, and of added files.
class FolderWatch {
 public:
  explicit FolderWatch(std::filesystem::path folder);

  /// Also wakes when this open file is written to, even one without a name.
  void add(int file) const;

  /// Returns once `condition` holds; tests it after every change. False if the process with the
  /// descriptor `process` has ended before.
  bool waitUntil(const std::function<bool()>& condition, int process = -1) const;

 private:
  void addFolders() const;

  std::filesystem::path folder_;
  FileDescriptor events_;
};

}  // namespace broadmark::tests
