// Lines that another process writes.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "broadmark/files.h"
#include "broadmark/harness/case_executor.h"

namespace broadmark {

/// Both ends of a stream socket. Throws std::runtime_error.
std::pair<FileDescriptor, FileDescriptor> openSockets();

/// The other end, in a process that serves the one that started it: standard input, which is
/// replaced, as is standard output, so that whatever a plug-in prints is kept out. The process ends
/// with its parent, and leaves Ctrl-C to it. Throws InputError if it has no such parent.
FileDescriptor serveParent();

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
