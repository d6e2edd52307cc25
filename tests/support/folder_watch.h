// Waits for what happens in a folder.
#pragma once

#include <filesystem>
#include <functional>

#include "broadmark/files.h"

namespace broadmark::tests {

/// Wakes at every change of what lies below a folder, and of other files.
class FolderWatch {
 public:
  explicit FolderWatch(std::filesystem::path folder);

  /// Also wakes when this open file is written to, even one without a name.
  void add(int file) const;

  /// Returns once `condition` holds; asks it after every change. False if `process`, a descriptor
  /// of one, has ended before.
  bool waitUntil(const std::function<bool()>& condition, int process = -1) const;

 private:
  void addFolders() const;

  std::filesystem::path folder_;
  FileDescriptor events_;
};

}  // namespace broadmark::tests
