#include "request/sweep.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/words.h"

namespace broadmark {
namespace {

/// By size, each once, however it is written.
void sortNumbers(std::vector<std::string>& texts) {
  std::ranges::stable_sort(texts, {}, numberIn);
  const auto same = std::ranges::unique(texts, {}, numberIn);
  texts.erase(same.begin(), same.end());
}

void dropRepeated(std::vector<std::string>& texts) {
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
    dropRepeated(values);
  }
  return values;
}

std::vector<ParameterValues> combinations(Parametrised& object, const ParameterValues& texts) {
  std::map<std::string, std::vector<std::string>> several;
  object.visitParameters([&](const Parameter& parameter) {
    const auto text = texts.find(std::string(parameter.name));
    if (text == texts.end() || std::holds_alternative<std::string*>(parameter.value)) return;
    several[text->first] = valuesIn(text->second);
  });
  std::vector<ParameterValues> all = {texts};
  for (const auto& [name, values] : several) {
    std::vector<ParameterValues> longer;
    for (const ParameterValues& shorter : all) {
      for (const std::string& value : values) longer.emplace_back(shorter)[name] = value;
    }
    all = std::move(longer);
  }
  return all;
}

std::string sweptText(const ParameterValues& swept) {
  std::string text;
  for (const auto& [name, value] : swept) text += fmt::format(" {}={}", name, value);
  return text;
}

}  // namespace broadmark
