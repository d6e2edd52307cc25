// The commands of the inspector: one table for menus, keys, the help page and the palette.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/render/input_queue.h"
#include "inspector/ui/ui.h"

namespace broadmark {

struct UserCommand {
  std::string doc;  ///< for the help page and the palette: "open a file"
  Key key = 0;      ///< 0: none
  bool ctrl = false;
  bool shift = false;
  std::string menu = {};   ///< with the menus around it: "View/Scale"; "": in no menu
  std::string label = {};  ///< in its menu
  std::function<void()> action;
  std::function<bool()> enabled = {};  ///< null: always
  std::function<bool()> checked = {};  ///< null: never
  bool begins_section = false;         ///< a line separates it from the item above

  [[nodiscard]] bool isEnabled() const { return !enabled || enabled(); }
  /// The key combination as text: "Ctrl+O"; "": none.
  [[nodiscard]] std::string keys() const;
};

/// The first enabled command with these keys, or null.
const UserCommand* commandOf(const std::vector<UserCommand>& commands, Key key, bool ctrl,
                             bool shift);

/// Draws the items of a menu ("File", "View/Scale"), and the menus in it.
void drawMenuItems(Ui& ui, const std::vector<UserCommand>& commands, const std::string& menu);

/// A list of all commands, searched by typing.
class CommandPalette {
 public:
  void open() { opening_ = true; }
  void draw(Ui& ui, const std::vector<UserCommand>& commands);

 private:
  bool opening_ = false;
  std::string search_;
  std::size_t selected_ = 0;  ///< among those found
};

}  // namespace broadmark
