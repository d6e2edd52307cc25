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
#include "support/words.h"

namespace broadmark {
namespace {

/// Longest wait for an expected value while something goes on, in seconds.
constexpr double kPatience = 60;

std::vector<std::string> splitWords(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false;
  bool begun = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
      begun = true;
    } else if (!quoted && c == '#' && !begun) {
      break;
    } else if (!quoted && (c == ' ' || c == '\t' || c == '\r')) {
      if (begun) words.push_back(std::exchange(word, {}));
      begun = false;
    } else {
      word += c;
      begun = true;
    }
  }
  if (begun) words.push_back(word);
  return words;
}

bool holds(const std::string& value, const std::string& relation, const std::string& wanted) {
  if (relation == "=") return value == wanted;
  if (relation == "!=") return value != wanted;
  if (relation == "~") return value.find(wanted) != std::string::npos;
  const auto a = numberIn(value);
  const auto b = numberIn(wanted);
  if (!a || !b) return false;
  if (relation == "<") return *a < *b;
  if (relation == ">") return *a > *b;
  if (relation == "<=") return *a <= *b;
  return *a >= *b;
}

ImVec2 within(const WidgetPlace& place, float x, float y) {
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

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

const std::vector<ScriptVerb>& scriptVerbs() {
  using P = ScriptPlayer;
  using Words = ScriptVerb::Words;
  static const std::vector<ScriptVerb> verbs = {
      {"click", "WIDGET", 1, 1, "presses a widget, by name: \"Playback/Play\"",
       [](P& player, const Words& words, Inspector&) { player.pressAt(words[0], 0, 1); }},
      {"doubleclick", "WIDGET", 1, 1, "presses it twice",
       [](P& player, const Words& words, Inspector&) { player.pressAt(words[0], 0, 2); }},
      {"rightclick", "WIDGET", 1, 1, "presses it with the right button",
       [](P& player, const Words& words, Inspector&) { player.pressAt(words[0], 1, 1); }},
      {"enter", "WIDGET TEXT", 2, 2, "replaces what an input holds, and confirms it", &P::enter},
      {"choose", "WIDGET OPTION", 2, 2, "opens a list, and chooses from it",
       [](P& player, const Words& words, Inspector&) {
         player.pressAt(words[0], 0, 1);
         player.pressAt(fmt::format("{}/{}", words[0], words[1]), 0, 1);
       }},
      {"type", "TEXT", 1, 1, "types letters into whatever has the focus", &P::type},
      {"key", "KEYS", 1, 1, "presses keys together: Space, Ctrl+O", &P::key},
      {"move", "WIDGET X Y", 3, 3, "moves the mouse to a place in a widget, each from 0 to 1",
       [](P& player, const Words& words, Inspector&) {
         player.reveal(words[0]);
         player.moveInto(words[0], player.number(words[1]), player.number(words[2]));
       }},
      {"drag", "WIDGET X Y X Y [BUTTON [KEY]]", 5, 7,
       "drags from one place in a widget to another; with the left button (0) or the right one "
       "(1), perhaps while Shift, Ctrl or Alt is down",
       &P::drag},
      {"wheel", "WIDGET TURNS", 2, 2, "turns the wheel over a widget",
       [](P& player, const Words& words, Inspector&) {
         player.reveal(words[0]);
         player.moveInto(words[0], 0.5F, 0.5F);
         player.push({.kind = InputEvent::Kind::wheel, .y = player.number(words[1])});
       }},
      {"panel", "NAME", 1, 1, "brings a panel to the front",
       [](P& player, const Words& words, Inspector& inspector) {
         if (!inspector.hasPanel(words[0]))
           player.fail(fmt::format("unknown panel '{}'", words[0]));
         inspector.session().notices.bringUp(words[0]);
         player.pause();
       }},
      {"open", "FILE", 1, 1, "drops a file onto the window",
       [](P& player, const Words& words, Inspector& inspector) {
         inspector.session().open(words[0]);
         player.pause();
       }},
      {"wait", "PICTURES or idle", 1, 1, "until everything is computed, or for some pictures",
       &P::wait},
      {"expect", "VALUE RELATION TEXT", 3, 3,
       "waits until a value of the session is =, !=, <, >, <= or >= to the text, or contains it "
       "(~), and fails if that does not happen",
       &P::expect},
      {"patience", "SECONDS", 1, 1,
       "how long from here on an expectation may take while nothing goes on (at first 2)",
       [](P& player, const Words& words, Inspector&) {
         player.idle_patience_ = static_cast<double>(player.number(words[0]));
       }},
      {"places", "FILE", 1, 1,
       "writes where the widgets are: a line each of left, top, right, bottom (pixels) and name",
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
      {"screenshot", "FILE", 1, 1, "saves what is seen",
       [](P& player, const Words& words, Inspector&) {
         player.screenshot_ = words[0];
         player.pause();
       }},
  };
  return verbs;
}

std::vector<ScriptLine> parseScript(std::string_view text, std::string_view name) {
  std::vector<std::string> known;
  for (const ScriptVerb& verb : scriptVerbs()) known.emplace_back(verb.name);
  std::vector<ScriptLine> lines;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::vector<std::string> words = splitWords(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (words.empty()) continue;
    const auto place = std::ranges::find(known, words[0]);
    if (place == known.end()) {
      throw InputError(
          fmt::format("{}: line {}: {}", name, number, unknownName("verb", words[0], known)));
    }
    const ScriptVerb& verb = scriptVerbs()[static_cast<std::size_t>(place - known.begin())];
    words.erase(words.begin());
    if (words.size() < verb.fewest || words.size() > verb.most) {
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
    if (!input.empty()) return;  // the last picture has not taken everything in
    if (!steps_.empty()) {
      if (!steps_.front()(inspector, input)) return;
      steps_.erase(steps_.begin());
      return;
    }
    if (next_ == lines_.size()) return;
    const ScriptLine line = lines_[next_++];
    number_ = line.number;
    line.verb->begin(*this, line.words, inspector);
  }
}

void ScriptPlayer::push(InputEvent event) {
  steps_.push_back([event](Inspector&, InputQueue& input) {
    input.push(event);
    return true;
  });
}

/// Waits until the widget is there and in sight.
void ScriptPlayer::reveal(const std::string& widget) {
  const auto start = std::chrono::steady_clock::now();
  int pictures = 0;
  steps_.push_back([this, widget, start, pictures](Inspector& inspector, InputQueue&) mutable {
    const WidgetPlace* found = inspector.ui().find(widget);
    ++pictures;
    if (found != nullptr && found->visible) {
      // What has just been done may show in the next picture only.
      if (!found->enabled && pictures > 4) {
        fail(fmt::format("the widget '{}' is disabled", widget));
      }
      return found->enabled && pictures > 1;
    }
    if (found == nullptr) {
      // Perhaps in a panel that is behind another.
      const std::string panel = widget.substr(0, widget.find('/'));
      if (inspector.hasPanel(panel) && pictures < 3) inspector.session().notices.bringUp(panel);
    } else {
      inspector.ui().reveal(widget);
    }
    if (pictures > 30 && secondsSince(start) > idle_patience_) {
      if (found != nullptr) fail(fmt::format("the widget '{}' is out of sight", widget));
      static_cast<void>(place(inspector, widget));  // fails, with the nearest name
    }
    return false;
  });
}

void ScriptPlayer::moveInto(const std::string& widget, float x, float y) {
  steps_.push_back([this, widget, x, y](Inspector& inspector, InputQueue& input) {
    input.push(moveTo(within(place(inspector, widget), x, y)));
    return true;
  });
}

void ScriptPlayer::pause(int pictures) {
  for (; pictures > 0; --pictures) {
    steps_.emplace_back([](Inspector&, InputQueue&) { return true; });
  }
}

float ScriptPlayer::number(const std::string& text) const {
  const auto value = numberIn(text);
  if (!value) fail(fmt::format("'{}' is not a number", text));
  return static_cast<float>(*value);
}

void ScriptPlayer::pressAt(const std::string& widget, int button, int times) {
  reveal(widget);
  moveInto(widget, 0.5F, 0.5F);
  for (int time = 0; time < times; ++time) {
    push(buttonEvent(button, true));
    push(buttonEvent(button, false));
  }
}

void ScriptPlayer::enter(const Words& words, Inspector& inspector) {
  pressAt(words[0], 0, 1);
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
  // The widget may move along: what counts is where it was.
  const auto where = std::make_shared<WidgetPlace>();
  const auto move_to = [&](float x, float y) {
    steps_.push_back([where, x, y](Inspector&, InputQueue& input) {
      input.push(moveTo(within(*where, x, y)));
      return true;
    });
  };
  steps_.push_back([this, widget, where](Inspector& inspector, InputQueue&) {
    *where = place(inspector, widget);
    return true;
  });
  move_to(at[0], at[1]);
  if (held != 0) push(keyEvent(held, true));
  push(buttonEvent(button, true));
  for (const float share : {0.25F, 0.5F, 0.75F, 1.0F}) {
    move_to(at[0] + share * (at[2] - at[0]), at[1] + share * (at[3] - at[1]));
  }
  push(buttonEvent(button, false));
  if (held != 0) push(keyEvent(held, false));
}

void ScriptPlayer::wait(const Words& words, Inspector&) {
  const std::string until = currentScriptWord(words[0]);
  if (until != "idle") return pause(static_cast<int>(number(until)));
  const auto start = std::chrono::steady_clock::now();
  int pictures = 0;
  steps_.push_back([this, start, pictures](Inspector& inspector, InputQueue&) mutable {
    if (secondsSince(start) > 10 * kPatience) fail("still computing");
    return ++pictures > 2 && inspector.session().runs.isIdle();
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
    if (now && holds(*now, relation, text)) return true;
    // It may become so as long as something goes on, and for a while after that.
    if (inspector.session().busy()) busy_at = std::chrono::steady_clock::now();
    if (secondsSince(start) < kPatience && secondsSince(busy_at) < idle_patience_) return false;
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
  pause(2);
}

}  // namespace broadmark
