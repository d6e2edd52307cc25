// Typed parameters as text and back.

#include "broadmark/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // clang before 17 needs the guide spelled out

template <class Number>
void setNumber(const Parameter& parameter, std::string_view text, Number& value) {
  Number parsed{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  const auto as_double = static_cast<double>(parsed);
  const bool in_range = as_double >= parameter.min && as_double <= parameter.max;
  if (error != std::errc{} || end != text.data() + text.size() || !in_range) {
    throw InputError(fmt::format("parameter {}: '{}' is not {} in {}", parameter.name, text,
                                 std::is_integral_v<Number> ? "an integer" : "a number",
                                 parameterRange(parameter)));
  }
  value = parsed;
}

void setSwitch(const Parameter& parameter, std::string_view text, bool& value) {
  const bool on = text == "on" || text == "true" || text == "1";
  if (!on && text != "off" && text != "false" && text != "0") {
    throw InputError(fmt::format("parameter {}: '{}' is neither on nor off", parameter.name, text));
  }
  value = on;
}

void setChoice(const Parameter& parameter, std::string_view text, Choice& choice) {
  for (const std::string& option : choice.options) {
    if (option == text) {
      choice.value = option;
      return;
    }
  }
  throw InputError(unknownName(parameter.name, text, choice.options));
}

}  // namespace

std::string_view currentParameterName(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> kFormerNames[] = {
      {"crowded", "split_threshold"}, {"from_scratch_cost", "full_search_cost_scale"},
      {"most_bodies", "max_bodies"},  {"most_contacts", "max_contacts"},
      {"way", "work_division"},
  };
  for (const auto& [former, current] : kFormerNames) {
    if (name == former) return current;
  }
  return name;
}

std::string_view parameterUnit(const Parameter& parameter) {
  constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"seconds", "s"},
      {"milliseconds", "ms"},
      {"microseconds", "µs"},
      {"world units", "units"},
      {"world units per second", "units/s"},
      {"world units per second squared", "units/s²"},
      {"sides of the world per second", "sides/s"},
      {"sides of the world per second squared", "sides/s²"},
      {"radians per second", "rad/s"},
  };
  constexpr std::string_view kLeadIn = ", in ";
  const std::size_t position = parameter.doc.rfind(kLeadIn);
  if (position == parameter.doc.npos) return "";
  const std::string_view stated = parameter.doc.substr(position + kLeadIn.size());
  for (const auto& [unit, short_form] : kUnits) {
    if (stated == unit) return short_form;
  }
  return "";
}

std::string parameterText(const Parameter& parameter) {
  return std::visit(
      Overloaded{[](const bool* v) -> std::string { return *v ? "on" : "off"; },
                 [](const Choice* v) { return v->value; }, [](const std::string* v) { return *v; },
                 [](const auto* v) { return fmt::format("{}", *v); }},
      parameter.value);
}

std::string parameterRange(const Parameter& parameter) {
  const auto range = [&](const auto*) {
    return fmt::format("{:.15g}…{:.15g}", parameter.min, parameter.max);
  };
  return std::visit(
      Overloaded{[](const bool*) -> std::string { return "on|off"; },
                 [](const Choice* v) { return fmt::format("{}", fmt::join(v->options, "|")); },
                 [](const std::string*) -> std::string { return "TEXT"; }, range},
      parameter.value);
}

void setParameter(const Parameter& parameter, std::string_view text) {
  std::visit(Overloaded{[&](bool* v) { setSwitch(parameter, text, *v); },
                        [&](Choice* v) { setChoice(parameter, text, *v); },
                        [&](std::string* v) { *v = text; },
                        [&](auto* v) { setNumber(parameter, text, *v); }},
             parameter.value);
}

void setParameters(Parametrised& object, const ParameterValues& values) {
  std::vector<std::string> known;
  object.visitParameters([&](const Parameter& parameter) {
    known.emplace_back(parameter.name);
    const auto value = values.find(known.back());
    if (value != values.end()) setParameter(parameter, value->second);
  });
  for (const auto& [name, value] : values) {
    if (std::ranges::find(known, name) != known.end()) continue;
    if (known.empty()) {
      throw InputError(fmt::format("unknown parameter '{}': this object has no parameters", name));
    }
    throw InputError(unknownName("parameter", name, known));
  }
}

ParameterValues parameterValues(Parametrised& object) {
  ParameterValues values;
  object.visitParameters([&](const Parameter& parameter) {
    values.emplace(parameter.name, parameterText(parameter));
  });
  return values;
}

ParameterValues changedValues(ParameterValues values, Parametrised& fresh) {
  const ParameterValues defaults = parameterValues(fresh);
  std::erase_if(values, [&](const auto& value) {
    const auto by_default = defaults.find(value.first);
    return by_default != defaults.end() && by_default->second == value.second;
  });
  return values;
}

ParameterValues applicableValues(Parametrised& object, const ParameterValues& values) {
  ParameterValues own;
  for (const std::string& name : parameterNames(object)) {
    if (const auto value = values.find(name); value != values.end()) own.insert(*value);
  }
  return own;
}

std::vector<std::string> parameterNames(Parametrised& object) {
  std::vector<std::string> names;
  object.visitParameters([&](const Parameter& parameter) { names.emplace_back(parameter.name); });
  return names;
}

}  // namespace broadmark
