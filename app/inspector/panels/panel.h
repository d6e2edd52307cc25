// Panels: the tabs of the docked areas.
#pragma once

#include <imgui.h>

#include <memory>
#include <string_view>
#include <vector>

#include "broadmark/names.h"
#include "broadmark/render/plot.h"
#include "inspector/session/session.h"
#include "inspector/ui/file_dialog.h"
#include "inspector/ui/ui.h"

namespace broadmark {

class View;

/// The area of the window in which a panel is docked.
enum class DockArea { left, right, bottom };
inline constexpr NameTable kDockAreas{
    {NamedValue{DockArea::left, "left"}, {DockArea::right, "right"}, {DockArea::bottom, "bottom"}}};

/// The objects that a panel uses; all outlive it.
struct PanelContext {
  Ui& ui;
  Session& session;
  View& view;
  FileDialog& files;
  const RunProgress* progress = nullptr;  ///< in the current picture

  /// Returns the curve colours of `progress`'s tracks.
  [[nodiscard]] std::vector<Rgb> trackColours() const;
  /// Plots the frames in the range of `zoom`, filling the panel. The mouse zooms and pans; if
  /// `is_playback`, the plot has a playhead, and a click seeks.
  PlotResult plotFrames(const char* name, const std::vector<PlotCurve>& curves, PlotOptions options,
                        Timeline& zoom, bool is_playback = true) const;
  /// Draws a button as wide as the panel.
  bool wideButton(const char* label, const char* tooltip, bool enabled = true) const;
};

/// Limits how often a panel computes a summary that takes a while.
template <class Key>
class SummaryThrottle {
 public:
  /// Whether to compute it now: for another key, or some time after the last one.
  bool isDue(const Key& key) {
    constexpr double kSeconds = 0.25;
    const double now = ImGui::GetTime();
    if (key == key_ && now < next_) return false;
    key_ = key;
    next_ = now + kSeconds;
    return true;
  }

 private:
  Key key_{};
  double next_ = 0;  ///< seconds of the user interface
};

/// Lays out buttons of equal width, `count` per row, or fewer if their labels need more.
class ButtonRow {
 public:
  ButtonRow(Ui& ui, int count);
  bool button(const char* label, const char* tooltip, bool enabled = true);

 private:
  Ui& ui_;
  int count_;
  int drawn_ = 0;
  float width_;
};

/// Implemented by one class per file; holds the state that only its panel needs.
class Panel : protected PanelContext {
 public:
  explicit Panel(const PanelContext& context) : PanelContext(context) {}
  virtual ~Panel() = default;

  void drawOf(const RunProgress& current) {
    progress = &current;
    draw();
  }

 private:
  virtual void draw() = 0;
};

/// A panel's tab and factory.
struct PanelSpec {
  const char* name;
  DockArea area;
  const char* tooltip;
  std::unique_ptr<Panel> (*make)(const PanelContext& context);
};
template <class PanelType>
std::unique_ptr<Panel> make(const PanelContext& context) {
  return std::make_unique<PanelType>(context);
}

struct PanelTab : PanelSpec {
  std::unique_ptr<Panel> panel;
};
/// Makes all panels, in the order of the list in CMakeLists.txt.
std::vector<PanelTab> makePanels(const PanelContext& context);

}  // namespace broadmark
