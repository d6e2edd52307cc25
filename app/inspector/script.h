// Scripts: what a user does, line by line, with assertions; for demonstrations and tests.
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

/// The first word of a line.
struct ScriptVerb {
  using Words = std::vector<std::string>;

  const char* name;
  const char* arguments;  ///< for people: "WIDGET TEXT"
  std::size_t fewest;     ///< words that follow it
  std::size_t most;
  const char* doc;
  std::function<void(ScriptPlayer&, const Words&, Inspector&)> begin;
};
const std::vector<ScriptVerb>& scriptVerbs();

/// One line of a script.
struct ScriptLine {
  int number = 0;  ///< in its file, from 1
  const ScriptVerb* verb = nullptr;
  ScriptVerb::Words words;  ///< what follows it; "quoted text" is one word
};

/// Throws InputError naming `name`, the line and what would be right.
std::vector<ScriptLine> parseScript(std::string_view text, std::string_view name);

/// Goes through a script, picture by picture.
class ScriptPlayer {
 public:
  ScriptPlayer(std::vector<ScriptLine> lines, std::string name);

  /// Before a picture: feeds `input`, or looks at what the last picture shows. Throws InputError,
  /// naming the line, when a widget is not there or an assertion fails.
  void update(Inspector& inspector, InputQueue& input);
  [[nodiscard]] bool done() const { return next_ == lines_.size() && steps_.empty(); }

  /// The size that the picture is to get; once.
  std::optional<std::pair<int, int>> takeResize() { return std::exchange(resize_, {}); }
  /// Where to write a picture; once.
  std::optional<std::filesystem::path> takeScreenshot() { return std::exchange(screenshot_, {}); }

 private:
  friend const std::vector<ScriptVerb>& scriptVerbs();
  using Words = ScriptVerb::Words;
  /// Called once a picture until it returns true.
  using Step = std::function<bool(Inspector&, InputQueue&)>;

  // Verbs: each adds its steps.
  void enter(const Words& words, Inspector& inspector);
  void type(const Words& words, Inspector& inspector);
  void key(const Words& words, Inspector& inspector);
  void drag(const Words& words, Inspector& inspector);
  void wait(const Words& words, Inspector& inspector);
  void expect(const Words& words, Inspector& inspector);
  void places(const Words& words, Inspector& inspector);
  void resize(const Words& words, Inspector& inspector);

  void pressAt(const std::string& widget, int button, int times);
  void moveInto(const std::string& widget, float x, float y);
  void reveal(const std::string& widget);
  void push(InputEvent event);
  /// Waits for this number of pictures.
  void pause(int pictures = 1);
  [[nodiscard]] float number(const std::string& text) const;
  [[nodiscard]] const WidgetPlace& place(Inspector& inspector, const std::string& widget) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::vector<ScriptLine> lines_;
  std::string name_;
  std::size_t next_ = 0;
  int number_ = 0;            ///< of the line being played
  double idle_patience_ = 2;  ///< in seconds
  std::vector<Step> steps_;   ///< pending steps of the current line
  std::optional<std::pair<int, int>> resize_;
  std::optional<std::filesystem::path> screenshot_;
};

}  // namespace broadmark
