#include "inspector/session/notices.h"

#include <utility>

#include "broadmark/error.h"

namespace broadmark {

void Notices::say(std::string text, Message::Kind kind) { status = {kind, std::move(text)}; }

void Notices::complain(std::string text) {
  say(text, Message::Kind::error);
  errors.push_back(std::move(text));
}

bool Notices::attempt(const std::function<void()>& act) {
  try {
    act();
    return true;
  } catch (...) {
    complain(currentErrorText());
  }
  return false;
}

}  // namespace broadmark
