// A part of the window.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "broadmark/names.h"
#include "inspector/session/session.h"
#include "inspector/ui/file_dialog.h"
#include "inspector/ui/ui.h"

namespace broadmark {

class View;

/// Where a panel stands: as a tab beside the others of its place.
enum class Place { left, right, bottom };
inline constexpr NameTable kPlaces{
    {NamedValue{Place::left, "left"}, {Place::right, "right"}, {Place::bottom, "bottom"}}};

/// What a panel draws with and works on, lent for a call.
struct PanelContext {
  Ui& ui;
  Session& session;
  const RunProgress& progress;
  View& view;
  FileDialog& files;  ///< to ask for a file

  /// Of the curves of `progress`'s lanes.
  [[nodiscard]] std::vector<Rgb> laneColours() const {
    std::vector<std::string_view> families;
    for (const LaneReport& lane : progress.lanes) {
      families.emplace_back(lane.spec.run.algorithm.family);
    }
    return curveColours(families, ui.theme);
  }
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

/// A button as wide as the panel.
inline bool wideButton(Ui& ui, const char* label, const char* tooltip, bool enabled = true) {
  return ButtonRow(ui, 1).button(label, tooltip, enabled);
}

/// One implementation per file, listed in CMakeLists.txt. Keeps what only it needs between two
/// pictures.
class Panel {
 public:
  Panel(const char* name, Place place, const char* tooltip)
      : name_(name), tooltip_(tooltip), place_(place) {}
  virtual ~Panel() = default;

  [[nodiscard]] const char* name() const { return name_; }
  [[nodiscard]] const char* tooltip() const { return tooltip_; }
  [[nodiscard]] Place place() const { return place_; }

  virtual void draw(PanelContext& context) = 0;

 private:
  const char* name_;
  const char* tooltip_;
  Place place_;
};

/// All of them, in the order of the list in CMakeLists.txt.
std::vector<std::unique_ptr<Panel>> makePanels();

}  // namespace broadmark
