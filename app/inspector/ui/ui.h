// Widgets, by name: Dear ImGui's, each noted with its place, so that scripts and tests find them;
// and the look of all of them.
#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/parameters.h"
#include "broadmark/render/palette.h"
#include "inspector/ui/glyph_atlas.h"

namespace broadmark {

/// Where a widget was in the last picture.
struct WidgetPlace {
  ImVec2 min;
  ImVec2 max;
  bool enabled = true;
  bool visible = true;  ///< not scrolled or clipped away
};

ImVec4 colourVector(Rgb rgb, float alpha = 1);
ImU32 colour(Rgb rgb, float alpha = 1);

/// The widgets of one picture. A widget's name is its label, after the names of the scopes around
/// it: "Scene/objects". Every method that is called as a Dear ImGui widget behaves like it.
class Ui {
 public:
  /// Until destroyed, names are in this scope. (Dear ImGui does not see it.)
  class Scope {
   public:
    Scope(Ui& ui, std::string_view name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Ui* ui_;
    std::size_t length_;
  };
  [[nodiscard]] Scope scope(std::string_view name) { return {*this, name}; }

  /// To be called before and after a picture is begun: forgets the places of the last one.
  void beforePicture();
  void begin();
  /// Whether Escape was pressed, for what is in front: a list that is open or text that is being
  /// typed takes it first.
  [[nodiscard]] bool escaped() const { return escaped_; }
  /// Whether a dialog is in front.
  [[nodiscard]] static bool inDialog();
  /// The widget that keys have moved to; "": none.
  [[nodiscard]] const std::string& focused() const { return focus_; }
  /// Whether Enter was pressed outside a text input.
  [[nodiscard]] static bool entered();

  bool button(const char* label, const char* tooltip = nullptr, float width = 0,
              bool enabled = true);
  /// A button that stays pressed while `on`.
  bool toggle(const char* label, bool& on, const char* tooltip = nullptr, float width = 0);
  bool checkbox(const char* label, bool& value, const char* tooltip = nullptr, bool enabled = true);
  /// Chooses one of `options`; returns whether it changed.
  bool combo(const char* label, std::size_t& chosen, const std::vector<std::string>& options,
             const char* tooltip = nullptr, float width = 0);
  /// In a table it is as wide as the row.
  bool selectable(const char* label, bool selected, const char* tooltip = nullptr,
                  std::optional<Rgb> rgb = {});
  /// The same with words at the right end of its line; what does not fit of the label is cut.
  bool selectableLine(const char* label, bool selected, std::string_view right, Rgb right_colour,
                      const char* tooltip = nullptr);
  bool text(const char* label, std::string& value, const char* hint = "");
  /// Numbers count when they are entered (Enter, Tab, or a click elsewhere), within their range.
  bool integer(const char* label, std::int64_t& value, std::int64_t min, std::int64_t max,
               const char* tooltip = nullptr);
  bool number(const char* label, double& value, double min, double max,
              const char* tooltip = nullptr);
  /// The same without a label beside it, as wide as has been set.
  bool entry(const char* name, double& value, double min, double max, const char* tooltip);
  /// Three numbers side by side, called "LABEL x", "LABEL y" and "LABEL z".
  bool vector(const char* label, std::array<double, 3>& value, double min, double max,
              const char* tooltip = nullptr);
  /// Without the number, which the grab would cover: that belongs into the label.
  bool slider(const char* label, int& value, int min, int max);
  bool menuItem(const char* label, const char* shortcut = nullptr, bool selected = false,
                bool enabled = true);
  bool beginMenu(const char* label, bool enabled = true);
  /// The widget that suits a parameter, its explanation as a tooltip.
  bool parameter(const Parameter& parameter);
  /// All parameters of an object. Returns whether one changed.
  bool parameters(Parametrised& object);

  /// Puts the next window in the middle of the screen, of this size (in units; 0: what its contents
  /// need) or as large as the screen allows.
  void placeInMiddle(ImVec2 size) const;
  /// A dialog, placed like a window; its popup must be open. Its cross sets `keep` to false.
  /// Returns whether it is drawn: then ImGui::EndPopup() follows.
  bool beginDialog(const char* title, ImVec2 size, bool* keep = nullptr);
  /// A dialog that asks, with a button for each answer and its tooltip, and "Cancel". Returns the
  /// number of the answer once it is given; Cancel is the last.
  std::optional<std::size_t> ask(
      const char* title, std::string_view text,
      std::initializer_list<std::pair<const char*, const char*>> answers);
  /// A dialog's button "Cancel", which Escape presses, too.
  bool cancel(float width = 0);

  /// Puts what is `width` wide beside the last item, or, without room for it, into the next line.
  static void besideIfRoom(float width);
  /// Words on the left, which are cut if need be, and on the right end of the line others.
  void line(std::string_view left, std::string_view right, Rgb right_colour);
  /// What remains of the line once there is room on its right for these words.
  [[nodiscard]] static float roomBefore(std::string_view right);
  /// Writes at the right end of the line that an item has begun.
  void atRightEnd(std::string_view words, Rgb rgb);
  /// Begins a table below a row of its columns' names, no wider than widthOfWholeColumns(). Returns
  /// whether it is drawn: then ImGui::EndTable() follows.
  static bool beginTable(const char* name, const std::vector<std::string>& columns, int always,
                         float height = 0);
  /// The next cell of a table.
  void cell(std::string_view text);
  void cell(std::string_view text, Rgb rgb);
  /// A table row "name: value" in two columns.
  void fact(const char* name, std::string_view value);
  void plain(std::string_view text);
  void faint(std::string_view text);
  void coloured(Rgb rgb, std::string_view text);
  void heading(const char* text);
  // Wrapped text.
  void paragraph(std::string_view text) { paragraph(text, theme.text); }
  void paragraph(std::string_view text, Rgb rgb);
  void faintParagraph(std::string_view text) { paragraph(text, theme.faint); }
  void tooltip(const char* text);

  /// Notes the item drawn last under a name of its own.
  void note(std::string_view name);
  /// Notes a place that is not an item's.
  void noteAt(std::string_view name, ImVec2 min, ImVec2 max);
  /// The place of a widget in the last picture, until the next one; or null.
  [[nodiscard]] const WidgetPlace* find(const std::string& name) const;
  [[nodiscard]] const std::map<std::string, WidgetPlace>& places() const { return places_; }
  /// Scrolls to this widget when it is drawn next.
  void reveal(std::string name) { revealed_ = std::move(name); }

  /// Called when a number that was entered is not taken as it is, with why.
  std::function<void(const std::string&)> on_correction;

  GlyphAtlas glyphs;  ///< of all texts that pass through here
  Palette theme = kDarkPalette;
  float scale = 1;          ///< pixels per unit
  ImFont* large = nullptr;  ///< for what is to be seen first

 private:
  [[nodiscard]] std::string fullName(std::string_view label) const;
  /// Notes the item drawn last with its tooltip. Returns `acted`.
  bool noted(bool acted, const char* label, const char* tooltip = nullptr);
  /// An input for a number, noted as `name`, as wide as has been set.
  template <class Number>
  bool enterNumber(const char* label, std::string_view name, Number& value, Number min, Number max,
                   const char* tooltip);
  /// Sets the width of an input with its label on the right.
  void labelledWidth() const;

  std::string scope_;
  std::map<std::string, WidgetPlace> places_;
  std::string revealed_;
  std::string focus_;
  bool taken_ = false;  ///< Escape, by what is open before the picture
  bool escaped_ = false;
};

/// The text; of one that is wider than `room` as much of its beginning as fits, and "…". `font`:
/// the present one if null.
std::string fittingText(std::string text, float room, ImFont* font = nullptr);

/// How wide a table may be here so that of its columns, as they were in the last picture, each one
/// in sight is seen wholly: half a number would be a wrong one. The first `always` are shown
/// anyhow.
float widthOfWholeColumns(const char* table, int always);

/// Fills what is left of the window with the histogram of the values, without their tails, and
/// writes a few of them below, as `text` has them. `line`: a value that is marked. Without values,
/// or where all are the same, it draws nothing.
void drawHistogram(Ui& ui, std::span<const double> values,
                   const std::function<std::string(double)>& text, std::optional<double> line = {});

/// A panel of two parts: beside each other, or, where there is no room for that, one of them.
struct SplitPane {
  float share = 0.5F;         ///< of the width: the first one's
  float narrowest = 0;        ///< pixels that both need
  bool second_alone = false;  ///< which of them, where there is room for one only

  [[nodiscard]] bool both() const;
  void draw(const std::function<void()>& first, const std::function<void()>& second) const;
};

/// Draws those of `count` rows that are in sight.
template <class Row>
void clipped(std::size_t count, const Row& row) {
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(count));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      ImGui::PushID(i);
      row(static_cast<std::size_t>(i));
      ImGui::PopID();
    }
  }
}

inline constexpr float kSplitterSize = 5;  ///< units: between two parts of the window
/// Opens a window that fills a rectangle.
void beginAt(const char* id, ImVec2 position, ImVec2 size, ImGuiWindowFlags flags = 0);

/// The colours of curves in one plot, by the families of their algorithms: the first of a family
/// has its own, the others have those that are left.
std::vector<Rgb> curveColours(std::span<const std::string_view> families, const Palette& palette);

/// Sets colours, sizes and fonts of the current Dear ImGui context, and `ui`'s theme.
void applyTheme(Ui& ui, bool dark, float scale);

}  // namespace broadmark
