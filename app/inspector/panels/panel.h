// A part of the window.
#pragma once

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

/// The tab bar of a panel.
enum class DockArea { left, right, bottom };
inline constexpr NameTable kDockAreas{
    {NamedValue{DockArea::left, "left"}, {DockArea::right, "right"}, {DockArea::bottom, "bottom"}}};

/// What a panel draws with and works on, which outlives it.
struct PanelContext {
  Ui& ui;
  Session& session;
  View& view;
  FileDialog& files;                      ///< to ask for a file
  const RunProgress* progress = nullptr;  ///< of the picture being drawn

  /// Of the curves of `progress`'s tracks.
  [[nodiscard]] std::vector<Rgb> trackColours() const;
  /// Draws the frames that `zoom` shows into the rest of the panel. The mouse moves them, and goes
  /// to one if `plays` says that they are those of the playback.
  PlotResult plotFrames(const char* name, const std::vector<PlotCurve>& curves, PlotOptions options,
                        Timeline& zoom, bool plays = true) const;
  /// A button as wide as the panel.
  bool wideButton(const char* label, const char* tooltip, bool enabled = true) const;
};

/// Several buttons side by side that share the width.
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

/// One implementation per file, listed in CMakeLists.txt. Keeps what only it needs between two
/// pictures.
class Panel : protected PanelContext {
 public:
  explicit Panel(const PanelContext& context) : PanelContext(context) {}
  virtual ~Panel() = default;

  void drawOf(const RunProgress& seen) {
    progress = &seen;
    draw();
  }

 private:
  virtual void draw() = 0;
};

/// What stands on a panel's tab, and how the panel is made.
struct PanelKind {
  const char* name;
  DockArea area;
  const char* tooltip;
  std::unique_ptr<Panel> (*make)(const PanelContext& context);
};
template <class PanelType>
std::unique_ptr<Panel> make(const PanelContext& context) {
  return std::make_unique<PanelType>(context);
}

struct PanelTab : PanelKind {
  std::unique_ptr<Panel> panel;
};
/// All of them, in the order of the list in CMakeLists.txt.
std::vector<PanelTab> makePanels(const PanelContext& context);

}  // namespace broadmark
