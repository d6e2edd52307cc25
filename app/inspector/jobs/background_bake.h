// Bakes recordings in the background.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/batch.h"
#include "inspector/jobs/job.h"
#include "request/simulation_process.h"

namespace broadmark {

enum class BakeOutcome { waiting, kept, baked, failed };
/// "" for a waiting recording.
inline constexpr NameTable kBakeOutcomes{{NamedValue{BakeOutcome::waiting, ""},
                                          {BakeOutcome::kept, "kept"},
                                          {BakeOutcome::baked, "baked"},
                                          {BakeOutcome::failed, "failed"}}};

/// `failure` is an error of the whole batch; those of single recordings are in the items.
struct BakeReport : TaskReport {
  static constexpr const char* kName = "baking";
  static constexpr const char* kPrefix = "batch";

  struct Item {
    std::filesystem::path path;
    BakeOutcome outcome = BakeOutcome::waiting;
    std::string failure = {};
  };
  std::vector<Item> items;  ///< filled when the batch is planned

  [[nodiscard]] std::size_t count(BakeOutcome outcome) const;
  [[nodiscard]] std::size_t failed() const { return count(BakeOutcome::failed); }
  /// Summary of the outcomes: "3 baked, 1 kept".
  [[nodiscard]] std::string text() const;
  [[nodiscard]] JobStatus status() const;
};

using BackgroundBake = Task<BakeReport>;

/// Plans and bakes a batch. Throws InputError while another batch is running.
void startBake(BackgroundBake& job, BakeOptions options, SimulationHost host = simulateInProcess);
/// Bakes a single recording, overwriting an existing file. Throws InputError while another batch is
/// running.
void startBake(BackgroundBake& job, std::unique_ptr<Simulation> simulation,
               std::filesystem::path path, const SimulationHost& host = simulateInProcess);

}  // namespace broadmark
