// Batch work: baking many recordings, running many cases.

#include "inspector/panels/bake_form.h"
#include "inspector/panels/benchmark_form.h"
#include "inspector/panels/panel.h"

namespace broadmark::panels::batch {
namespace {

class BatchPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    ui.combo("task", task_, {"bake recordings", "run algorithms"});
    if (task_ == 0) {
      bake_.draw();
    } else {
      benchmark_.draw();
    }
  }

 private:
  std::size_t task_ = 0;
  BakeForm bake_{*this};
  BenchmarkForm benchmark_{*this};
};

}  // namespace

extern const PanelSpec spec = {"Batch", DockArea::left, "Bake many recordings, run many cases",
                               make<BatchPanel>};

}  // namespace broadmark::panels::batch
