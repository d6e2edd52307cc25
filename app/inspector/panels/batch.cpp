// Long work: baking many recordings, running many cases.

#include "inspector/panels/bake_form.h"
#include "inspector/panels/benchmark_form.h"
#include "inspector/panels/panel.h"

namespace broadmark::panels::batch {
namespace {

class BatchPanel final : public Panel {
 public:
  BatchPanel() : Panel("Batch", Place::left, "Baking many recordings, running many cases") {}

  void draw(PanelContext& context) override {
    context.ui.combo("task", task_, {"bake recordings", "run algorithms"});
    if (task_ == 0) {
      bake_.draw(context);
    } else {
      benchmark_.draw(context);
    }
  }

 private:
  std::size_t task_ = 0;
  BakeForm bake_;
  BenchmarkForm benchmark_;
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<BatchPanel>(); }

}  // namespace broadmark::panels::batch
