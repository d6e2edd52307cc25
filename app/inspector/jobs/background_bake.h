// Baking in the background.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/batch.h"
#include "inspector/jobs/job.h"

namespace broadmark {

enum class BakeOutcome { waiting, kept, baked, failed };
/// "" for one that waits.
inline constexpr NameTable kBakeOutcomes{{NamedValue{BakeOutcome::waiting, ""},
                                          {BakeOutcome::kept, "kept"},
                                          {BakeOutcome::baked, "baked"},
                                          {BakeOutcome::failed, "failed"}}};

/// A failure of the task is what kept the batch as a whole from being baked.
struct BakeReport : TaskReport {
  static constexpr const char* kName = "baking";
  static constexpr const char* kPrefix = "batch";

  struct Item {
    std::filesystem::path path;
    BakeOutcome outcome = BakeOutcome::waiting;
    std::string failure = {};
  };
  std::vector<Item> items;  ///< known once it is planned

  [[nodiscard]] std::size_t count(BakeOutcome outcome) const;
  [[nodiscard]] std::size_t failed() const { return count(BakeOutcome::failed); }
  /// What it has come to, in words.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] JobStatus status() const;
};

using BackgroundBake = Task<BakeReport>;

/// Plans and bakes what the options describe. Throws InputError while another batch is running.
void startBake(BackgroundBake& job, BakeOptions options);
/// Bakes a single recording; one that is there is replaced. Throws InputError while another batch
/// is running.
void startBake(BackgroundBake& job, std::unique_ptr<Simulation> simulation,
               std::filesystem::path path);

}  // namespace broadmark
