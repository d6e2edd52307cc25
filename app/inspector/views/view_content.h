// What a view of the scene shows: bodies with their colours, lines and boxes over them, legends.
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

  /// Takes over what is to be seen, with the session's options and selection. `comparison`: with
  /// the other view; null: none. Returns whether anything is otherwise than before.
  bool update(const std::shared_ptr<const Snapshot>& snapshot,
              const std::shared_ptr<const PairComparison>& comparison, const Session& session,
              bool dark);

  /// Null before the first update(); all that follows is only there after it.
  [[nodiscard]] const std::shared_ptr<const Snapshot>& snapshot() const { return shown_.snapshot; }
  [[nodiscard]] const std::vector<std::uint32_t>& selection() const { return shown_.selection; }
  /// How many bodies are not drawn because the user does not want to see them.
  [[nodiscard]] std::size_t hiddenBodies() const {
    return static_cast<std::size_t>(std::ranges::count(visible_, 0));
  }
  /// Of those that are present; empty if there are none.
  [[nodiscard]] Aabb boundsOf(std::span<const std::uint32_t> bodies) const;

  SceneViewContent picture;  ///< to be drawn, once it is said in which space and at what scale
  Colouring colouring;
  /// Like the colouring's legend, of the oracle's answer where the colours tell of another one.
  std::vector<LegendEntry> oracle_legend;
  /// What the colours of the shown structure mean, and how many of its cells have each.
  std::vector<LegendEntry> cell_legend;
  std::size_t left_out = 0;  ///< lines and boxes that were too many

 private:
  /// What all was made from.
  struct Shown {
    std::shared_ptr<const Snapshot> snapshot;
    std::shared_ptr<const PairComparison> comparison;
    std::vector<std::uint32_t> selection;
    DisplayOptions options;
    bool dark = false;

    friend bool operator==(const Shown&, const Shown&) = default;
  };

  void updateBodies();
  void updateVisible();
  void updateLines();
  void add(Overlay overlay);
  void addTrails(std::span<const Trail> trails);
  void addXray();

  Shown shown_;
  std::vector<std::uint8_t> visible_;
  std::vector<SceneLine> lines_;
  std::vector<SceneWireBox> wire_boxes_;
  std::uint64_t revision_ = 0;
};

}  // namespace broadmark
