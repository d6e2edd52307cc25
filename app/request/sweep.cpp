#include "request/sweep.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/words.h"

namespace broadmark {
namespace {

/// Sorts by value and removes equal numbers, even if written differently.
void sortNumbers(std::vector<std::string>& texts) {
  std::ranges::stable_sort(texts, {}, numberIn);
  const auto duplicates = std::ranges::unique(texts, {}, numberIn);
  texts.erase(duplicates.begin(), duplicates.end());
}

void removeDuplicates(std::vector<std::string>& texts) {
  std::vector<std::string> seen;
  std::erase_if(texts, [&](const std::string& text) {
    if (std::ranges::find(seen, text) != seen.end()) return true;
    seen.push_back(text);
    return false;
  });
}

}  // namespace

std::vector<std::string> splitList(const std::vector<std::string>& texts) {
  std::vector<std::string> parts;
  for (const std::string& text : texts) {
    std::ranges::move(splitAt(',', text), std::back_inserter(parts));
  }
  std::erase(parts, "");
  return parts;
}

std::vector<std::string> valuesIn(const std::string& text) {
  std::vector<std::string> values = splitList({text});
  if (values.empty()) return {text};
  if (std::ranges::all_of(values, [](const auto& value) { return numberIn(value).has_value(); })) {
    sortNumbers(values);
  } else {
    removeDuplicates(values);
  }
  return values;
}

std::vector<ParameterValues> combinations(Parametrised& object, const ParameterValues& texts) {
  std::map<std::string, std::vector<std::string>> values_by_name;
  object.visitParameters([&](const Parameter& parameter) {
    const auto text = texts.find(std::string(parameter.name));
    if (text == texts.end() || std::holds_alternative<std::string*>(parameter.value)) return;
    values_by_name[text->first] = valuesIn(text->second);
  });
  std::vector<ParameterValues> all = {texts};
  for (const auto& [name, values] : values_by_name) {
    std::vector<ParameterValues> extended;
    for (const ParameterValues& combination : all) {
      for (const std::string& value : values) extended.emplace_back(combination)[name] = value;
    }
    all = std::move(extended);
  }
  return all;
}

std::string sweptText(const ParameterValues& swept) {
  std::string text;
  for (const auto& [name, value] : swept) text += fmt::format(" {}={}", name, value);
  return text;
}

}  // namespace broadmark
