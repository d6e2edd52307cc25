#include "request/logged_pairs.h"

#include <algorithm>
#include <memory>

#include "broadmark/files.h"
#include "request/pair_log.h"

namespace broadmark {
namespace {

class LoggedPairs final : public BroadPhase {
 public:
  explicit LoggedPairs(std::string file) : file_(std::move(file)) {}

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"margin", "allows pairs of boxes that overlap once each is enlarged by this much",
           &margin_, 0, 1e9});
  }
  [[nodiscard]] float margin() const override { return static_cast<float>(margin_); }

  void initialize(const SceneInfo&, const Frame& first, ExecutionContext&) override {
    log_ = std::make_unique<PairLog>(file_);
    updateObjects(first);
  }
  void updateObjects(const Frame& frame) override { pairs_ = log_->pairsOf(frame.index); }
  void searchOverlaps() override {}
  [[nodiscard]] PairRuns overlaps() const override { return {&pairs_, 1}; }

 private:
  std::string file_;
  double margin_ = 0;
  std::unique_ptr<PairLog> log_;
  PairRun pairs_;
};

}  // namespace

Algorithm loggedPairs(const std::string& file) {
  openForReading(file);
  return {.id = "logged",
          .family = "Logged",
          .summary = "the pairs that a program logged; their times are those of reading the log",
          .traits = {.changing_worlds = ChangingWorlds::native},
          .description = {.principle = "log",
                          .optimisations = "",
                          .time = "not stated",
                          .space = "not stated",
                          .source = file},
          .create = [file] { return std::make_unique<LoggedPairs>(file); }};
}

}  // namespace broadmark
