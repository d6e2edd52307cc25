// The content of a view: coloured bodies, lines and boxes over them, legends.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/render/colouring.h"
#include "broadmark/render/overlays.h"
#include "broadmark/render/scene_view.h"
#include "inspector/authoring/gizmo.h"
#include "inspector/session/session.h"
#include "inspector/session/wrong_pair.h"

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
  /// Makes the bodies transparent that hide those in focus from the eye. Call before drawing.
  void updateGlass(const Point& eye, std::span<const std::uint32_t> focus);
  /// Number of transparent bodies.
  [[nodiscard]] std::size_t glassBodies() const {
    return static_cast<std::size_t>(std::ranges::count(glass_, 1));
  }
  /// Flags of the bodies that are visible and not transparent; empty: all are.
  [[nodiscard]] std::vector<std::uint8_t> solid() const;
  /// Returns the bounds of the present ones among the bodies; empty if none is.
  [[nodiscard]] Aabb boundsOf(std::span<const std::uint32_t> bodies) const;

  SceneViewContent picture;  ///< without `space` and `scale`
  Colouring colouring;
  /// The colouring's legend for the oracle's answer, if the colours depend on another answer.
  std::vector<LegendEntry> oracle_legend;
  /// Legend of the structure's cell colours, with the number of cells of each.
  std::vector<LegendEntry> cell_legend;
  std::size_t left_out = 0;  ///< lines and boxes beyond the limit
  /// The deciding axis of the two selected bodies, drawn at this point.
  struct DecidingAxis {
    std::size_t axis = 0;
    AxisRelation relation;
    std::array<float, 3> middle{};
  };
  std::optional<DecidingAxis> deciding_axis;  ///< nothing: no pair is selected

 private:
  /// The arguments of the last update().
  struct Input {
    std::shared_ptr<const Snapshot> snapshot;
    std::shared_ptr<const PairComparison> comparison;
    std::vector<std::uint32_t> selection;
    bool is_pair = false;  ///< the selection is a pair, and in its colours
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
  void addPair();

  Input input_;
  std::vector<std::uint8_t> visible_;
  std::vector<std::uint8_t> glass_;
  std::vector<SceneLine> lines_;
  std::vector<SceneWireBox> wire_boxes_;
  std::uint64_t revision_ = 0;
};

}  // namespace broadmark
