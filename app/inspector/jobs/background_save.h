// Saves frames as a recording in the background.
#pragma once

#include <filesystem>
#include <memory>

#include "broadmark/frame.h"
#include "inspector/jobs/job.h"

namespace broadmark {

struct SaveReport : TaskReport {
  static constexpr const char* kName = "saving a recording";
  static constexpr const char* kPrefix = "save";

  std::filesystem::path file;

  [[nodiscard]] JobStatus status() const;
};

using BackgroundSave = Task<SaveReport>;

/// Starts to write all frames of `source`, which no other thread may use, to a recording; replaces
/// an existing file once it is complete. Throws InputError if the file cannot be written, or while
/// another recording is saved.
void startSave(BackgroundSave& job, std::unique_ptr<FrameSource> source,
               std::filesystem::path file);

}  // namespace broadmark
