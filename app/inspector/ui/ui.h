// Named Dear ImGui widgets, registered with their rectangles for scripts and tests; and the theme.
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
#include <variant>
#include <vector>

#include "broadmark/parameters.h"
#include "broadmark/render/palette.h"
#include "broadmark/render/plot_canvas.h"
#include "inspector/ui/glyph_atlas.h"

namespace broadmark {

/// Rectangle and state of a widget in the last picture.
struct WidgetPlace {
  ImVec2 min;
  ImVec2 max;
  bool enabled = true;
  bool visible = true;  ///< not scrolled or clipped away
  bool cut = false;     ///< a part on the right is clipped away, outside of tables, which scroll
};

ImVec4 colourVector(Rgb rgb, float alpha = 1);
ImU32 colour(Rgb rgb, float alpha = 1);

/// The widgets of a picture. A widget's name is its label, prefixed by the enclosing scopes:
/// "Scene/objects". Methods named after a Dear ImGui widget behave like it.
class Ui {
 public:
  /// Prefixes widget names during its lifetime. (Does not affect Dear ImGui's ids.)
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

  /// Called before and after ImGui::NewFrame(); begin() clears the widgets of the last picture.
  void beforePicture();
  void begin();
  /// Whether Escape was pressed, and not consumed by an open list or a text input.
  [[nodiscard]] bool escaped() const { return escaped_; }
  /// Whether the topmost popup is a dialog.
  [[nodiscard]] static bool inDialog();
  /// Name of the widget highlighted by keyboard navigation; "": none.
  [[nodiscard]] const std::string& focused() const { return focus_; }
  /// Whether Enter was pressed, on the keypad or not.
  [[nodiscard]] static bool entered();

  /// The width of a button with this label.
  [[nodiscard]] static float buttonWidth(const char* label);
  bool button(const char* label, const char* tooltip = nullptr, float width = 0,
              bool enabled = true);
  /// A button that stays pressed while `on`.
  bool toggle(const char* label, bool& on, const char* tooltip = nullptr, float width = 0);
  bool checkbox(const char* label, bool& value, const char* tooltip = nullptr, bool enabled = true);
  /// Returns whether the choice changed.
  bool combo(const char* label, std::size_t& chosen, const std::vector<std::string>& options,
             const char* tooltip = nullptr, float width = 0);
  /// Spans all columns of a table.
  bool selectable(const char* label, bool selected, const char* tooltip = nullptr,
                  std::optional<Rgb> rgb = {});
  /// A selectable with right-aligned text; a label that does not fit is truncated.
  bool selectableLine(const char* label, bool selected, std::string_view right, Rgb right_colour,
                      const char* tooltip = nullptr);
  bool text(const char* label, std::string& value, const char* hint = "",
            ImGuiInputTextFlags flags = 0);
  /// Numbers are committed by Enter, Tab or a click elsewhere, and clamped to their range.
  bool integer(const char* label, std::int64_t& value, std::int64_t min, std::int64_t max,
               const char* tooltip = nullptr);
  bool number(const char* label, double& value, double min, double max,
              const char* tooltip = nullptr);
  /// A number without a label, with the width of ImGui::SetNextItemWidth().
  bool entry(const char* name, double& value, double min, double max, const char* tooltip);
  /// Three numbers side by side, named "LABEL x", "LABEL y" and "LABEL z".
  bool vector(const char* label, std::array<double, 3>& value, double min, double max,
              const char* tooltip = nullptr);
  /// Shows no number, which the grab would cover: put it into the label.
  bool slider(const char* label, int& value, int min, int max);
  bool menuItem(const char* label, const char* shortcut = nullptr, bool selected = false,
                bool enabled = true);
  bool beginMenu(const char* label, bool enabled = true);
  /// Draws the widget for the type of a parameter, with a tooltip.
  bool parameter(const Parameter& parameter);
  /// Draws all parameters of an object, groups folded. Returns whether one changed.
  bool parameters(Parametrised& object);

  /// Centres the next window, with this size in units (0: fits its contents) or the screen's.
  void placeInMiddle(ImVec2 size) const;
  /// Begins a centred dialog, if its popup is open. Its close button sets `open` to false. If it
  /// returns true, call ImGui::EndPopup().
  bool beginDialog(const char* title, ImVec2 size, bool* open = nullptr);
  /// Draws a dialog with a button and a tooltip for each answer, and with "Cancel" as the last.
  /// Returns the index of the answer once a button is pressed.
  std::optional<std::size_t> ask(
      const char* title, std::string_view text,
      std::initializer_list<std::pair<const char*, const char*>> answers);
  /// The "Cancel" button of a dialog, which Escape presses as well.
  bool cancel(float width = 0);

  /// Calls ImGui::SameLine() if the next item, of this width, fits on the line.
  static void sameLineIfFits(float width);
  /// Draws left-aligned text, truncated if necessary, and right-aligned text on a line.
  void line(std::string_view left, std::string_view right, Rgb right_colour);
  /// Width that remains on the line to the left of right-aligned text.
  [[nodiscard]] static float widthBefore(std::string_view right);
  /// Draws right-aligned text on the line of the last item.
  void rightAligned(std::string_view text, Rgb rgb);
  /// Begins a table with headings that explain their terms and sort its rows, see sortedRows(). If
  /// it returns true, call endTable(). Columns named "##…", which come first, have marks.
  bool beginTable(const char* name, const std::vector<std::string>& columns, int always,
                  float height = 0);
  void endTable();
  /// Copies the tables of the next picture to the clipboard, with tabs between cells.
  void copyTables() { copy_requested_ = true; }
  /// Whether the last picture had a table.
  [[nodiscard]] bool hasTables() const { return has_tables_; }
  /// Whether this picture's tables are copied.
  [[nodiscard]] bool copiesTables() const { return copies_tables_; }
  /// Draws the row of headings with these names.
  void headings(const std::vector<std::string>& names);
  using SortKey = std::variant<double, std::string>;
  /// Returns the rows of the begun table, sorted by the key of the chosen column, if any.
  static std::vector<std::size_t> sortedRows(
      std::size_t count, const std::function<SortKey(std::size_t row, std::size_t column)>& key);
  /// Draws text in the next cell of a table.
  void cell(std::string_view text);
  void cell(std::string_view text, Rgb rgb);
  /// Call before drawing a plot. Returns its shapes if they are needed, see PlotCanvas; or null.
  std::vector<PlotShape>* beginPlot(std::string_view label);
  /// Call when the plot is the last item: registers it. The right mouse button offers to save it.
  void endPlot(std::string_view label);
  /// Name of the plot last under the mouse, or the first in the last picture; "": it has none.
  [[nodiscard]] std::string plotInUse() const;
  /// Draws the plot of this name as SVG in the next picture, too.
  void requestSvg(std::string plot) { svg_requested_ = std::move(plot); }
  /// That SVG; "": the plot was not drawn.
  [[nodiscard]] const std::string& svg() const { return svg_; }
  /// Draws a name and a value in two columns.
  void valueRow(const char* name, std::string_view value);
  void plain(std::string_view text);
  void faint(std::string_view text);
  void coloured(Rgb rgb, std::string_view text);
  void heading(const char* text);
  // Wrapped text.
  void paragraph(std::string_view text) { paragraph(text, theme.text); }
  void paragraph(std::string_view text, Rgb rgb);
  void faintParagraph(std::string_view text) { paragraph(text, theme.faint); }
  void tooltip(const char* text);

  /// Registers the last item under this name.
  void note(std::string_view name);
  /// Registers a rectangle that is not an item.
  void noteAt(std::string_view name, ImVec2 min, ImVec2 max);
  /// Returns a widget of the last picture, valid until the next one; or null.
  [[nodiscard]] const WidgetPlace* find(const std::string& name) const;
  [[nodiscard]] const std::map<std::string, WidgetPlace>& places() const { return places_; }
  /// Scrolls to this widget when it is drawn next.
  void reveal(std::string name) { revealed_ = std::move(name); }

  /// Called with the name of a plot to save.
  std::function<void(const std::string&)> on_save_plot;
  /// Called with a message when an entered number is clamped.
  std::function<void(const std::string&)> on_correction;

  GlyphAtlas glyphs;  ///< of all drawn texts
  Palette theme = kDarkPalette;
  float scale = 1;          ///< pixels per unit
  ImFont* large = nullptr;  ///< for prominent text

 private:
  [[nodiscard]] std::string fullName(std::string_view label) const;
  /// Registers the last item and draws its tooltip. Returns `acted`.
  bool registered(bool acted, const char* label, const char* tooltip = nullptr);
  /// An input for a number, registered as `name`, with the width of ImGui::SetNextItemWidth().
  template <class Number>
  bool inputNumber(const char* label, std::string_view name, Number& value, Number min, Number max,
                   const char* tooltip);
  /// Sets the width of the next input, with room for its label on the right.
  static void setInputWidth(const char* label);
  /// The same for a list: wider, if it shows a long text and the label leaves room for it.
  static void setListWidth(const char* label, const char* shown);

  /// Adds a cell to the copied table.
  void copyCell(std::string_view text);

  std::string scope_;
  std::map<std::string, WidgetPlace> places_;
  std::string revealed_;
  std::string focus_;
  bool escape_consumed_ = false;  ///< by a list or a text input open before the picture
  bool escaped_ = false;

  bool has_tables_ = false;
  bool begins_tables_ = false;  ///< in this picture
  bool copy_requested_ = false;
  bool copies_tables_ = false;  ///< in this picture
  bool in_table_ = false;
  int copied_row_ = 0;  ///< of the table
  std::string copied_;

  std::vector<std::string> plots_;         ///< names, in this picture so far
  std::vector<std::string> former_plots_;  ///< in the last one
  std::string hovered_plot_;               ///< last under the mouse
  std::string svg_requested_;
  std::string svg_of_;  ///< the plot drawn as SVG in this picture
  std::vector<PlotShape> shapes_;
  std::string svg_;
};

/// Returns the text, truncated with "…" if wider than `max_width`. `font` null: the current font.
std::string fittingText(std::string text, float max_width, ImFont* font = nullptr);

/// Returns the width at which a table, laid out as in the last picture, shows no partial column: a
/// truncated number would be a wrong one. The first `always` columns are always shown.
float widthOfWholeColumns(const char* table, int always);

/// Fills the rest of the window with the histogram of the values, without their tails, and labels
/// its axis by `text`. `line`: a value to mark. Draws nothing without distinct values.
void drawHistogram(Ui& ui, std::span<const double> values,
                   const std::function<std::string(double)>& text, std::optional<double> line = {});

/// Two parts of a panel side by side, or only one of them in a narrow panel.
struct SplitPane {
  float share = 0.5F;        ///< of the width, for the first part
  float min_width = 0;       ///< pixels, for both parts
  bool second_only = false;  ///< which part a narrower panel shows

  [[nodiscard]] bool both() const;
  void draw(const std::function<void()>& first, const std::function<void()>& second) const;
};

/// Draws the visible rows of `count`; all of them, if `unclipped`.
template <class Row>
void clipped(std::size_t count, const Row& row, bool unclipped = false) {
  const auto draw = [&row](int from, int to) {
    for (int i = from; i < to; ++i) {
      ImGui::PushID(i);
      row(static_cast<std::size_t>(i));
      ImGui::PopID();
    }
  };
  if (unclipped) return draw(0, static_cast<int>(count));
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(count));
  while (clipper.Step()) draw(clipper.DisplayStart, clipper.DisplayEnd);
}

inline constexpr float kSplitterSize = 5;  ///< units
/// Begins a window with this rectangle.
void beginAt(const char* id, ImVec2 position, ImVec2 size, ImGuiWindowFlags flags = 0);

/// Returns the colours of a plot's curves, by the ids of their algorithms: the first curve of an
/// algorithm gets the algorithm's colour unless another has it already, the others get unused ones.
std::vector<Rgb> curveColours(std::span<const std::string_view> algorithms, const Palette& palette);

/// Sets colours and sizes of the current Dear ImGui context, and `ui`'s theme and scale.
void applyTheme(Ui& ui, bool dark, float scale);

}  // namespace broadmark
