// Scripts of user actions and assertions, for demonstrations and tests.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "inspector/inspector.h"

namespace broadmark {

class ScriptPlayer;

/// A command of the script language: the first word of a line.
struct ScriptVerb {
  using Words = std::vector<std::string>;

  const char* name;
  const char* arguments;  ///< for messages and help: "WIDGET TEXT"
  std::size_t min_words;  ///< minimum number of arguments
  std::size_t max_words;
  const char* doc;
  std::function<void(ScriptPlayer&, const Words&, Inspector&)> enqueue;
};
const std::vector<ScriptVerb>& scriptVerbs();

/// One line of a script.
struct ScriptLine {
  int number = 0;  ///< in the file, from 1
  const ScriptVerb* verb = nullptr;
  ScriptVerb::Words words;  ///< arguments; "quoted text" is one word
};

/// Throws InputError with `name`, the line and the expected syntax.
std::vector<ScriptLine> parseScript(std::string_view text, std::string_view name);

/// Plays a script, picture by picture.
class ScriptPlayer {
 public:
  ScriptPlayer(std::vector<ScriptLine> lines, std::string name);

  /// Call before each picture: adds to `input`, or inspects the last picture. Throws InputError
  /// with the line if a widget does not exist or an assertion fails.
  void update(Inspector& inspector, InputQueue& input);
  [[nodiscard]] bool done() const { return next_ == lines_.size() && steps_.empty(); }

  /// Returns the requested picture size, and clears the request.
  std::optional<std::pair<int, int>> takeResize() { return std::exchange(resize_, {}); }
  /// Returns the file for a requested screenshot, and clears the request.
  std::optional<std::filesystem::path> takeScreenshot() { return std::exchange(screenshot_, {}); }

 private:
  friend const std::vector<ScriptVerb>& scriptVerbs();
  using Words = ScriptVerb::Words;
  /// Called once per picture until it returns true.
  using Step = std::function<bool(Inspector&, InputQueue&)>;

  // Verbs, which enqueue their steps.
  void enter(const Words& words, Inspector& inspector);
  void type(const Words& words, Inspector& inspector);
  void key(const Words& words, Inspector& inspector);
  void drag(const Words& words, Inspector& inspector);
  void wait(const Words& words, Inspector& inspector);
  void expect(const Words& words, Inspector& inspector);
  void places(const Words& words, Inspector& inspector);
  void resize(const Words& words, Inspector& inspector);

  /// `x`: where in the widget, from 0 to 1.
  void clickWidget(const std::string& widget, int button, int times, float x = 0.5F);
  void movePointer(const std::string& widget, float x, float y);
  void reveal(const std::string& widget);
  void push(InputEvent event);
  /// Waits for a number of pictures.
  void waitPictures(int pictures = 1);
  [[nodiscard]] float number(const std::string& text) const;
  [[nodiscard]] const WidgetPlace& place(Inspector& inspector, const std::string& widget) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::vector<ScriptLine> lines_;
  std::string name_;
  std::size_t next_ = 0;
  int number_ = 0;           ///< number of the current line
  double idle_timeout_ = 2;  ///< seconds
  std::vector<Step> steps_;  ///< pending steps of the current line
  std::optional<std::pair<int, int>> resize_;
  std::optional<std::filesystem::path> screenshot_;
};

}  // namespace broadmark
