#include "inspector/authoring/autosave.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <span>

#include "broadmark/error.h"
#include "broadmark/scenes/authored_scene.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSlots = 64;
constexpr double kMinSeconds = 2;   // between two copies
constexpr double kMaxShare = 0.02;  // of the time, for writing copies of large scenes

}  // namespace

fs::path autosaveFolder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state == '/') return fs::path(state) / "broadmark/scenes";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr ? home : "/") / ".local/state/broadmark/scenes";
}

Autosave::Autosave(fs::path folder) : folder_(std::move(folder)), interval_seconds_(kMinSeconds) {
  std::error_code failed;
  for (std::size_t slot = 0; slot < kMaxSlots; ++slot) {
    if (folder_.empty() || !fs::exists(file(slot, "json"), failed) || !lock(slot)) continue;
    try {
      const fs::path origin = readTextFile(file(slot, "lock"));
      const std::string text = readTextFile(file(slot, "json"));
      left_.push_back({slot, origin.empty() ? scenes::parseAuthoredScene(text, "").name
                                            : origin.filename().string()});
    } catch (const InputError&) {
      continue;  // not a scene of ours
    }
  }
}

fs::path Autosave::file(std::size_t slot, const char* extension) const {
  return folder_ / fmt::format("scene-{}.{}", slot, extension);
}

std::optional<FileDescriptor> Autosave::lock(std::size_t slot) const {
  const fs::path path = file(slot, "lock");
  FileDescriptor opened(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (opened.get() < 0 || ::flock(opened.get(), LOCK_EX | LOCK_NB) != 0) return {};
  return opened;
}

void Autosave::recover(const Left& left, Document& document) {
  std::optional<FileDescriptor> locked = lock(left.slot);
  if (!locked) {
    throw InputError(
        fmt::format("{}: another process is editing it", file(left.slot, "json").string()));
  }
  const fs::path path = file(left.slot, "json");
  scenes::AuthoredScene scene = scenes::parseAuthoredScene(readTextFile(path), path.string());
  discard();
  document.load(std::move(scene), readTextFile(file(left.slot, "lock")), true);
  own_.emplace(left.slot, std::move(*locked));
  std::erase_if(left_, [&](const Left& other) { return other.slot == own_->first; });
}

void Autosave::update(const Document& document, double seconds) {
  if (folder_.empty() || isSandboxed()) return;
  if (!document.isModified()) return discard();
  const State state{document.loads(), document.editor.revision(), document.path()};
  if (written_ == state) return;
  waited_seconds_ += seconds;
  if (waited_seconds_ < interval_seconds_) return;
  waited_seconds_ = 0;
  try {
    const auto start = std::chrono::steady_clock::now();
    write(document);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    interval_seconds_ = std::max(kMinSeconds, took.count() / kMaxShare);
  } catch (const InputError&) {
    folder_.clear();
    throw;
  }
  written_ = state;
}

void Autosave::claimSlot() {
  std::error_code failed;
  fs::create_directories(folder_, failed);
  for (std::size_t slot = 0; slot < kMaxSlots; ++slot) {
    if (fs::exists(file(slot, "json"), failed)) continue;
    if (std::optional<FileDescriptor> locked = lock(slot)) {
      own_.emplace(slot, std::move(*locked));
      return;
    }
  }
  throw InputError(fmt::format("{}: unsaved scenes cannot be kept there", folder_.string()));
}

void Autosave::write(const Document& document) {
  if (!own_) claimSlot();
  const auto& [slot, locked] = *own_;
  const fs::path origin_file = file(slot, "lock");
  const std::string origin = document.path().string();
  if (::ftruncate(locked.get(), 0) != 0 || ::lseek(locked.get(), 0, SEEK_SET) != 0) {
    throw InputError(fmt::format("{}: cannot be written", origin_file.string()));
  }
  writeAll(locked.get(), std::as_bytes(std::span(origin)), origin_file);
  writeTextFile(file(slot, "json"), scenes::formatAuthoredScene(document.editor.scene()));
}

void Autosave::discard() {
  written_.reset();
  waited_seconds_ = 0;
  if (!own_) return;
  std::error_code failed;
  fs::remove(file(own_->first, "json"), failed);
  own_.reset();
}

}  // namespace broadmark
