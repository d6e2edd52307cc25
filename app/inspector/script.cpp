#include "inspector/script.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/names.h"
#include "request/former_names.h"
#include "support/clock.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// Longest wait for an expected value while the session is busy, in seconds.
constexpr double kTimeout = 60;
/// Where to press an input: its label, on the right, does not take the focus.
constexpr float kBeforeLabel = 0.1F;

std::vector<std::string> splitWords(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false;
  bool started = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
      started = true;
    } else if (!quoted && c == '#' && !started) {
      break;
    } else if (!quoted && (c == ' ' || c == '\t' || c == '\r')) {
      if (started) words.push_back(std::exchange(word, {}));
      started = false;
    } else {
      word += c;
      started = true;
    }
  }
  if (started) words.push_back(word);
  return words;
}

bool satisfies(const std::string& value, const std::string& relation, const std::string& expected) {
  if (relation == "=") return value == expected;
  if (relation == "!=") return value != expected;
  if (relation == "~") return value.find(expected) != std::string::npos;
  const auto a = numberIn(value);
  const auto b = numberIn(expected);
  if (!a || !b) return false;
  if (relation == "<") return *a < *b;
  if (relation == ">") return *a > *b;
  if (relation == "<=") return *a <= *b;
  return *a >= *b;
}

ImVec2 pointIn(const WidgetPlace& place, float x, float y) {
  return {place.min.x + x * (place.max.x - place.min.x),
          place.min.y + y * (place.max.y - place.min.y)};
}

InputEvent moveTo(ImVec2 at) { return {.kind = InputEvent::Kind::move, .x = at.x, .y = at.y}; }
InputEvent buttonEvent(int button, bool down) {
  return {.kind = InputEvent::Kind::button, .code = button, .down = down};
}
InputEvent keyEvent(Key key, bool down) {
  return {.kind = InputEvent::Kind::key, .code = key, .down = down};
}

}  // namespace

const std::vector<ScriptVerb>& scriptVerbs() {
  using P = ScriptPlayer;
  using Words = ScriptVerb::Words;
  static const std::vector<ScriptVerb> verbs = {
      {"click", "WIDGET", 1, 1, "presses a widget, by name: \"Playback/Play\"",
       [](P& player, const Words& words, Inspector&) { player.clickWidget(words[0], 0, 1); }},
      {"doubleclick", "WIDGET", 1, 1, "presses it twice",
       [](P& player, const Words& words, Inspector&) { player.clickWidget(words[0], 0, 2); }},
      {"rightclick", "WIDGET", 1, 1, "presses it with the right button",
       [](P& player, const Words& words, Inspector&) { player.clickWidget(words[0], 1, 1); }},
      {"enter", "WIDGET TEXT", 2, 2, "replaces the text of an input, and confirms it", &P::enter},
      {"choose", "WIDGET OPTION", 2, 2, "opens a list, and selects an option",
       [](P& player, const Words& words, Inspector&) {
         player.clickWidget(words[0], 0, 1, kBeforeLabel);
         player.clickWidget(fmt::format("{}/{}", words[0], words[1]), 0, 1);
       }},
      {"type", "TEXT", 1, 1, "types into the focused widget", &P::type},
      {"key", "KEYS", 1, 1, "presses keys together: Space, Ctrl+O", &P::key},
      {"move", "WIDGET X Y", 3, 3, "moves the mouse to a position in a widget, from 0 to 1",
       [](P& player, const Words& words, Inspector&) {
         player.reveal(words[0]);
         player.movePointer(words[0], player.number(words[1]), player.number(words[2]));
       }},
      {"drag", "WIDGET X Y X Y [BUTTON [KEY]]", 5, 7,
       "drags from one position in a widget to another, with the left (0) or right (1) button, "
       "optionally with Shift, Ctrl or Alt",
       &P::drag},
      {"wheel", "WIDGET TURNS", 2, 2, "turns the wheel over a widget",
       [](P& player, const Words& words, Inspector&) {
         player.reveal(words[0]);
         player.movePointer(words[0], 0.5F, 0.5F);
         player.push({.kind = InputEvent::Kind::wheel, .y = player.number(words[1])});
       }},
      {"panel", "NAME", 1, 1, "brings a panel to the front",
       [](P& player, const Words& words, Inspector& inspector) {
         if (!inspector.hasPanel(words[0]))
           player.fail(fmt::format("unknown panel '{}'", words[0]));
         inspector.session().notices.raisePanel(words[0]);
         player.waitPictures();
       }},
      {"open", "FILE", 1, 1, "drops a file onto the window",
       [](P& player, const Words& words, Inspector& inspector) {
         inspector.session().open(words[0]);
         player.waitPictures();
       }},
      {"wait", "PICTURES or idle", 1, 1,
       "waits until everything is computed, or for a number of pictures", &P::wait},
      {"expect", "VALUE RELATION TEXT", 3, 3,
       "waits until a value of the session compares to the text by =, !=, <, >, <= or >=, or "
       "contains it (~), and fails otherwise",
       &P::expect},
      {"patience", "SECONDS", 1, 1,
       "sets how long later expectations wait while nothing happens (default 2)",
       [](P& player, const Words& words, Inspector&) {
         player.idle_timeout_ = static_cast<double>(player.number(words[0]));
       }},
      {"places", "FILE", 1, 1,
       "writes the positions of all widgets: lines of left, top, right, bottom (pixels) and name",
       &P::places},
      {"write", "VALUE FILE", 2, 2, "writes a value of the session to a file",
       [](P& player, const Words& words, Inspector&) {
         const std::string name = currentScriptWord(words[0]);
         player.steps_.push_back(
             [&player, name, file = words[1]](Inspector& inspector, InputQueue&) {
               const std::optional<std::string> now = inspector.value(name);
               if (!now) player.fail(fmt::format("unknown value '{}'", name));
               writeTextFile(file, *now + "\n");
               return true;
             });
       }},
      {"resize", "WIDTHxHEIGHT", 1, 1, "changes the size of the picture", &P::resize},
      {"screenshot", "FILE", 1, 1, "saves the picture",
       [](P& player, const Words& words, Inspector&) {
         player.screenshot_ = words[0];
         player.waitPictures();
       }},
  };
  return verbs;
}

std::vector<ScriptLine> parseScript(std::string_view text, std::string_view name) {
  std::vector<std::string> names;
  for (const ScriptVerb& verb : scriptVerbs()) names.emplace_back(verb.name);
  std::vector<ScriptLine> lines;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::vector<std::string> words = splitWords(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (words.empty()) continue;
    const auto found = std::ranges::find(names, words[0]);
    if (found == names.end()) {
      throw InputError(
          fmt::format("{}: line {}: {}", name, number, unknownName("verb", words[0], names)));
    }
    const ScriptVerb& verb = scriptVerbs()[static_cast<std::size_t>(found - names.begin())];
    words.erase(words.begin());
    if (words.size() < verb.min_words || words.size() > verb.max_words) {
      throw InputError(
          fmt::format("{}: line {}: expected: {} {}", name, number, verb.name, verb.arguments));
    }
    lines.push_back({.number = number, .verb = &verb, .words = std::move(words)});
  }
  return lines;
}

ScriptPlayer::ScriptPlayer(std::vector<ScriptLine> lines, std::string name)
    : lines_(std::move(lines)), name_(std::move(name)) {}

void ScriptPlayer::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: line {}: {}", name_, number_, what));
}

const WidgetPlace& ScriptPlayer::place(Inspector& inspector, const std::string& widget) const {
  const WidgetPlace* found = inspector.ui().find(widget);
  if (found != nullptr) return *found;
  std::vector<std::string> names;
  for (const auto& [name, where] : inspector.ui().places()) names.push_back(name);
  fail(unknownName("widget", widget, names));
}

void ScriptPlayer::update(Inspector& inspector, InputQueue& input) {
  while (true) {
    if (!input.empty()) return;  // not fully processed by the last picture
    if (!steps_.empty()) {
      if (!steps_.front()(inspector, input)) return;
      steps_.erase(steps_.begin());
      return;
    }
    if (next_ == lines_.size()) return;
    const ScriptLine line = lines_[next_++];
    number_ = line.number;
    line.verb->enqueue(*this, line.words, inspector);
  }
}

void ScriptPlayer::push(InputEvent event) {
  steps_.push_back([event](Inspector&, InputQueue& input) {
    input.push(event);
    return true;
  });
}

/// Waits until the widget exists, scrolled into view.
void ScriptPlayer::reveal(const std::string& widget) {
  const auto start = std::chrono::steady_clock::now();
  int pictures = 0;
  steps_.push_back([this, widget, start, pictures](Inspector& inspector, InputQueue&) mutable {
    const WidgetPlace* found = inspector.ui().find(widget);
    ++pictures;
    if (found != nullptr && found->visible) {
      // Effects of the last step may appear only in the next picture.
      if (!found->enabled && pictures > 4) {
        fail(fmt::format("the widget '{}' is disabled", widget));
      }
      return found->enabled && pictures > 1;
    }
    if (found == nullptr) {
      // The widget may be in a panel behind another.
      const std::string panel = widget.substr(0, widget.find('/'));
      if (inspector.hasPanel(panel) && pictures < 3) inspector.session().notices.raisePanel(panel);
    } else {
      inspector.ui().reveal(widget);
    }
    if (pictures > 30 && secondsSince(start) > idle_timeout_) {
      if (found != nullptr) fail(fmt::format("the widget '{}' is not visible", widget));
      static_cast<void>(place(inspector, widget));  // fails, suggesting the nearest name
    }
    return false;
  });
}

void ScriptPlayer::movePointer(const std::string& widget, float x, float y) {
  steps_.push_back([this, widget, x, y](Inspector& inspector, InputQueue& input) {
    input.push(moveTo(pointIn(place(inspector, widget), x, y)));
    return true;
  });
}

void ScriptPlayer::waitPictures(int pictures) {
  for (; pictures > 0; --pictures) {
    steps_.emplace_back([](Inspector&, InputQueue&) { return true; });
  }
}

float ScriptPlayer::number(const std::string& text) const {
  const auto value = numberIn(text);
  if (!value) fail(fmt::format("'{}' is not a number", text));
  return static_cast<float>(*value);
}

void ScriptPlayer::clickWidget(const std::string& widget, int button, int times, float x) {
  reveal(widget);
  movePointer(widget, x, 0.5F);
  for (int time = 0; time < times; ++time) {
    push(buttonEvent(button, true));
    push(buttonEvent(button, false));
  }
}

void ScriptPlayer::enter(const Words& words, Inspector& inspector) {
  clickWidget(words[0], 0, 1, kBeforeLabel);
  key({"Ctrl+A"}, inspector);
  if (words[1].empty()) key({"Delete"}, inspector);
  type({words[1]}, inspector);
  key({"Enter"}, inspector);
}

void ScriptPlayer::type(const Words& words, Inspector&) {
  steps_.push_back([text = words[0]](Inspector&, InputQueue& input) {
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at < end;) {
      unsigned letter = 0;
      at += std::max(ImTextCharFromUtf8(&letter, at, end), 1);
      input.push({.kind = InputEvent::Kind::character, .code = static_cast<int>(letter)});
    }
    return true;
  });
}

void ScriptPlayer::key(const Words& words, Inspector&) {
  const std::string& combination = words[0];
  std::vector<Key> keys;
  for (std::size_t start = 0; start <= combination.size();) {
    const std::size_t end = std::min(combination.find('+', start), combination.size());
    const std::string name = combination.substr(start, end - start);
    keys.push_back(keyNamed(name));
    if (keys.back() == 0) fail(fmt::format("unknown key '{}'", name));
    start = end + 1;
  }
  for (const Key key : keys) push(keyEvent(key, true));
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) push(keyEvent(*key, false));
}

void ScriptPlayer::drag(const Words& words, Inspector&) {
  const std::string& widget = words[0];
  std::array<float, 4> at{};
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = number(words[i + 1]);
  const int button = words.size() > 5 ? static_cast<int>(number(words[5])) : 0;
  const Key held = words.size() > 6 ? keyNamed(words[6]) : 0;
  reveal(widget);
  // The widget may move during the drag: use its initial position.
  const auto initial = std::make_shared<WidgetPlace>();
  const auto move_to = [&](float x, float y) {
    steps_.push_back([initial, x, y](Inspector&, InputQueue& input) {
      input.push(moveTo(pointIn(*initial, x, y)));
      return true;
    });
  };
  steps_.push_back([this, widget, initial](Inspector& inspector, InputQueue&) {
    *initial = place(inspector, widget);
    return true;
  });
  move_to(at[0], at[1]);
  if (held != 0) push(keyEvent(held, true));
  push(buttonEvent(button, true));
  for (const float fraction : {0.25F, 0.5F, 0.75F, 1.0F}) {
    move_to(at[0] + fraction * (at[2] - at[0]), at[1] + fraction * (at[3] - at[1]));
  }
  push(buttonEvent(button, false));
  if (held != 0) push(keyEvent(held, false));
}

void ScriptPlayer::wait(const Words& words, Inspector&) {
  const std::string until = currentScriptWord(words[0]);
  if (until != "idle") return waitPictures(static_cast<int>(number(until)));
  const auto start = std::chrono::steady_clock::now();
  int pictures = 0;
  steps_.push_back([this, start, pictures](Inspector& inspector, InputQueue&) mutable {
    if (secondsSince(start) > 10 * kTimeout) fail("still computing");
    Session& session = inspector.session();
    return ++pictures > 2 && !session.isReading() && session.runs.isIdle();
  });
}

void ScriptPlayer::expect(const Words& words, Inspector&) {
  const std::string& relation = words[1];
  constexpr const char* kComparisons[] = {"=", "!=", "<", ">", "<=", ">=", "~"};
  if (std::ranges::find(kComparisons, relation) == std::end(kComparisons)) {
    fail(fmt::format("unknown relation '{}' (one of: = != < > <= >= ~)", relation));
  }
  const auto start = std::chrono::steady_clock::now();
  steps_.push_back([this, name = currentScriptWord(words[0]), relation, text = words[2], start,
                    busy_at = start](Inspector& inspector, InputQueue&) mutable {
    const std::optional<std::string> now = inspector.value(name);
    if (now && satisfies(*now, relation, text)) return true;
    // The value may change while the session is busy, and shortly after.
    if (inspector.session().busy()) busy_at = std::chrono::steady_clock::now();
    if (secondsSince(start) < kTimeout && secondsSince(busy_at) < idle_timeout_) return false;
    if (!now) fail(fmt::format("unknown value '{}'", name));
    fail(fmt::format("expected {} {} {}, but it is '{}'", name, relation, text, *now));
  });
}

void ScriptPlayer::places(const Words& words, Inspector& inspector) {
  std::string text;
  for (const auto& [name, place] : inspector.ui().places()) {
    if (!place.visible || !place.enabled) continue;
    text += fmt::format("{:.0f} {:.0f} {:.0f} {:.0f} {}\n", place.min.x, place.min.y, place.max.x,
                        place.max.y, name);
  }
  writeTextFile(words[0], text);
}

void ScriptPlayer::resize(const Words& words, Inspector&) {
  const std::size_t x = words[0].find('x');
  if (x == std::string::npos) {
    fail(fmt::format("'{}' is not of the form WIDTHxHEIGHT", words[0]));
  }
  const auto side = [&](const std::string& text) {
    return static_cast<int>(std::clamp(number(text), 1.0F, 16384.0F));
  };
  resize_ = {side(words[0].substr(0, x)), side(words[0].substr(x + 1))};
  waitPictures(2);
}

}  // namespace broadmark
