// The part of the panel Batch that bakes recordings: scenes × object types × object counts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "inspector/panels/panel.h"

namespace broadmark {

class BakeForm {
 public:
  BakeForm();
  void draw(PanelContext& context);

 private:
  /// What the inputs come to.
  struct Preview {
    std::vector<std::pair<std::filesystem::path, std::uint64_t>> recordings;
    std::uint64_t bytes = 0;
    std::string fault;  ///< "": none
  };

  void drawOptions(PanelContext& context);
  /// Takes over the inputs and makes the preview.
  void update();
  static void drawItems(Ui& ui, Session& session, const BackgroundBake::Report& report);
  void drawPreview(Ui& ui) const;

  std::vector<std::string> scenes_;
  std::vector<std::string> types_;
  std::vector<std::string> recorders_;
  std::vector<std::string> engines_;
  BakeOptions options_;
  std::string counts_ = "1000";
  std::int64_t frames_ = 100;
  std::size_t engine_ = 0;
  std::string directory_ = "recordings";
  bool stale_ = true;   ///< the preview is not that of the inputs
  bool begun_ = false;  ///< what the inputs say has been begun
  Preview preview_;
};

}  // namespace broadmark
