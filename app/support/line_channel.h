// Lines that another process writes.
#pragma once

#include <optional>
#include <string>

#include "broadmark/files.h"
#include "broadmark/harness/case_executor.h"

namespace broadmark {

class LineChannel {
 public:
  LineChannel() = default;
  /// A pipe or a socket.
  explicit LineChannel(FileDescriptor from) : from_(std::move(from)) {}

  /// Waits for the next line, and returns it without its line feed; nullopt once the other side
  /// has closed the channel. Throws Cancelled, and std::runtime_error for one of more than a
  /// mebibyte.
  std::optional<std::string> read(const CancelQuery& cancelled = {});
  /// What has been read of the next line.
  [[nodiscard]] const std::string& unfinished() const { return unread_; }
  [[nodiscard]] int descriptor() const { return from_.get(); }

 private:
  FileDescriptor from_;
  std::string unread_;
};

}  // namespace broadmark
