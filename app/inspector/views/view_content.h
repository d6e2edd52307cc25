// The content of a view: coloured bodies, lines and boxes over them, legends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadmark/render/colouring.h"
#include "broadmark/render/overlays.h"
#include "broadmark/render/scene_view.h"
#include "inspector/session/session.h"

namespace broadmark {

class ViewContent {
 public:
  ViewContent() = default;
  ViewContent(const ViewContent&) = delete;
  ViewContent& operator=(const ViewContent&) = delete;

  /// Updates the content from the snapshot and the session's options and selection. `comparison`:
  /// with the other view; null: none. Returns whether anything has changed.
  bool update(const std::shared_ptr<const Snapshot>& snapshot,
              const std::shared_ptr<const PairComparison>& comparison, const Session& session,
              bool dark);

  /// Null before the first update(); the other members are valid only after it.
  [[nodiscard]] const std::shared_ptr<const Snapshot>& snapshot() const { return input_.snapshot; }
  [[nodiscard]] const std::vector<std::uint32_t>& selection() const { return input_.selection; }
  /// Number of bodies hidden by the display options.
  [[nodiscard]] std::size_t hiddenBodies() const {
    return static_cast<std::size_t>(std::ranges::count(visible_, 0));
  }
  /// Returns the bounds of the present ones among the bodies; empty if none is.
  [[nodiscard]] Aabb boundsOf(std::span<const std::uint32_t> bodies) const;

  SceneViewContent picture;  ///< without `space` and `scale`
  Colouring colouring;
  /// The colouring's legend for the oracle's answer, if the colours depend on another answer.
  std::vector<LegendEntry> oracle_legend;
  /// Legend of the structure's cell colours, with the number of cells of each.
  std::vector<LegendEntry> cell_legend;
  std::size_t left_out = 0;  ///< lines and boxes beyond the limit

 private:
  /// The arguments of the last update().
  struct Input {
    std::shared_ptr<const Snapshot> snapshot;
    std::shared_ptr<const PairComparison> comparison;
    std::vector<std::uint32_t> selection;
    DisplayOptions options;
    bool dark = false;

    friend bool operator==(const Input&, const Input&) = default;
  };

  void updateBodies();
  void updateVisible();
  void updateLines();
  void add(Overlay overlay);
  void addTrails(std::span<const Trail> trails);
  void addXray();

  Input input_;
  std::vector<std::uint8_t> visible_;
  std::vector<SceneLine> lines_;
  std::vector<SceneWireBox> wire_boxes_;
  std::uint64_t revision_ = 0;
};

}  // namespace broadmark
