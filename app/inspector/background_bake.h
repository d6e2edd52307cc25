// Baking while the window lives on.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "batch.h"
#include "options.h"

namespace broadmark {

/// Plans and bakes one batch at a time, on threads of its own.
class BackgroundBake {
 public:
  enum class State { idle, planning, baking, done, cancelled, failed };
  enum class Outcome { waiting, kept, baked, failed };
  struct Item {
    std::filesystem::path path;
    Outcome outcome = Outcome::waiting;
    std::string failure;
  };
  struct Report {
    State state = State::idle;
    std::vector<Item> items;
    float fraction = 0;        ///< of the work
    double seconds_left = 0;   ///< while baking
    std::string doing;         ///< at present, in words
    std::string failure = {};  ///< what kept the batch as a whole from being baked

    [[nodiscard]] std::size_t count(Outcome outcome) const;
    [[nodiscard]] std::size_t failed() const { return count(Outcome::failed); }
    /// What it has come to, in words.
    [[nodiscard]] std::string text() const;
  };

  BackgroundBake() = default;
  /// Cancels, and waits until all is still.
  ~BackgroundBake();
  BackgroundBake(const BackgroundBake&) = delete;
  BackgroundBake& operator=(const BackgroundBake&) = delete;

  /// Begins what the options describe. Throws InputError while another batch is running.
  void start(BakeOptions options);
  /// Begins a single recording; one that is there is replaced. Likewise.
  void start(std::unique_ptr<Simulation> simulation, std::filesystem::path path);
  /// Ends soon; finished recordings stay, others leave nothing behind.
  void cancel() { stopping_ = true; }
  [[nodiscard]] bool running() const;
  [[nodiscard]] Report report() const;
  /// Whether a batch has ended since the last call.
  bool takeEnd() { return ended_.exchange(false); }

 private:
  void begin(std::function<void()> work);
  void planAndBake(const BakeOptions& options);
  void bake(std::vector<BakeJob> jobs, int threads);
  void take(const BakedJob& job);

  std::atomic<bool> stopping_ = false;
  std::atomic<bool> ended_ = false;
  mutable std::mutex mutex_;
  Report report_;  ///< guarded by mutex_
  std::thread thread_;
};

std::string_view bakeStateName(BackgroundBake::State state);

/// Object counts from text, "1000, 8000": each at least 1. Throws InputError.
std::vector<std::uint32_t> parseCounts(std::string_view text);

}  // namespace broadmark
