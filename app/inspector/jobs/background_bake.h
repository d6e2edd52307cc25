// Baking in the background.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/batch.h"
#include "inspector/jobs/background_task.h"

namespace broadmark {

/// Plans and bakes one batch at a time.
class BackgroundBake {
 public:
  enum class Outcome { waiting, kept, baked, failed };
  struct Item {
    std::filesystem::path path;
    Outcome outcome = Outcome::waiting;
    std::string failure = {};
  };
  /// A failure of the task is what kept the batch as a whole from being baked.
  struct Report : WorkReport {
    std::vector<Item> items;  ///< known once it is planned

    [[nodiscard]] std::size_t count(Outcome outcome) const;
    [[nodiscard]] std::size_t failed() const { return count(Outcome::failed); }
    /// What it has come to, in words.
    [[nodiscard]] std::string text() const;
  };

  /// Begins what the options describe. Throws InputError while another batch is running.
  void start(BakeOptions options);
  /// Begins a single recording; one that is there is replaced. Throws InputError while another
  /// batch is running.
  void start(std::unique_ptr<Simulation> simulation, std::filesystem::path path);
  /// Ends soon; finished recordings stay, others leave nothing behind.
  void cancel() { task_.cancel(); }
  void wait() { task_.wait(); }
  [[nodiscard]] bool running() const { return task_.running(); }
  [[nodiscard]] Report report() const { return task_.report(); }
  /// Whether a batch has ended since this was last asked.
  bool takeEnd() { return task_.takeEnd(); }

 private:
  void planAndBake(const BakeOptions& options);
  void bakeOne(BakeJob job);
  void bake(std::vector<BakeJob> jobs, int threads);
  void take(const BakedJob& job);

  BackgroundTask<Report> task_{"baking"};
};

/// "" for one that waits.
inline constexpr NameTable kBakeOutcomes{{NamedValue{BackgroundBake::Outcome::waiting, ""},
                                          {BackgroundBake::Outcome::kept, "kept"},
                                          {BackgroundBake::Outcome::baked, "baked"},
                                          {BackgroundBake::Outcome::failed, "failed"}}};

}  // namespace broadmark
