// The part of the panel Batch that runs algorithms on recordings.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "inspector/panels/panel.h"
#include "request/run_request.h"

namespace broadmark {

class BenchmarkForm {
 public:
  void draw(PanelContext& context);

 private:
  void drawOptions(PanelContext& context);
  void drawRecordings(Ui& ui);
  static void drawItems(Ui& ui, Session& session, const BackgroundBenchmark::Report& report);
  void drawPreview(Ui& ui, const Session& session);
  void findRecordings();
  /// Throws InputError for inputs that mean nothing.
  [[nodiscard]] RunRequest request() const;

  std::string directory_ = "recordings";
  std::vector<std::pair<std::filesystem::path, bool>> recordings_;  ///< whether it is marked
  bool stale_ = true;                                               ///< there may be others
  std::string algorithms_ = "sap, kd, grid2d-sap, columns";
  std::string threads_ = "1";
  std::int64_t repetitions_ = 3;
  std::size_t check_ = 0;
  std::string results_ = "results.json";
};

}  // namespace broadmark
