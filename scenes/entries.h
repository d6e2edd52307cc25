// Helpers for the lists of CMakeLists.txt: making entries, and finding an entry by its id. Every
// entry has a `listing` with an `id`.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/parameters.h"

namespace broadmark::scenes {

/// Creates an Implementation, returned as its Interface: the `create` of an entry.
template <class Interface, class Implementation, class... Arguments>
std::unique_ptr<Interface> makeEntry(Arguments... arguments) {
  return std::make_unique<Implementation>(std::forward<Arguments>(arguments)...);
}

template <class Entry>
std::vector<std::string> idsOf(const std::vector<Entry>& entries) {
  std::vector<std::string> ids;
  for (const Entry& entry : entries) ids.push_back(entry.listing.id);
  return ids;
}

/// A choice of all entries; the first is the default.
template <class Entry>
Choice choiceOf(const std::vector<Entry>& entries) {
  return {.value = entries.front().listing.id, .options = idsOf(entries)};
}

/// The entry with this id. `kind` names the list in messages. Throws InputError if there is none.
template <class Entry>
Entry entryOf(std::vector<Entry> entries, const std::string& id, std::string_view kind) {
  const auto found =
      std::ranges::find(entries, id, [](const Entry& entry) { return entry.listing.id; });
  if (found == entries.end()) throw InputError(unknownName(kind, id, idsOf(entries)));
  return std::move(*found);
}

}  // namespace broadmark::scenes
