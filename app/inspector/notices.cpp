#include "inspector/notices.h"

#include <exception>
#include <new>
#include <utility>

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
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return false;
}

}  // namespace broadmark
