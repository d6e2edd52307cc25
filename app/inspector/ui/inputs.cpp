// Inputs for numbers, texts and parameters.
#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "inspector/ui/ui.h"

namespace broadmark {
namespace {

constexpr float kVectorShare = 0.7F;  // of the width, for three numbers in a row

}  // namespace

bool Ui::text(const char* label, std::string& value, const char* hint, ImGuiInputTextFlags flags) {
  setInputWidth(label);
  glyphs.request(value);
  ImGui::InputTextWithHint(label, hint, &value, flags);
  note(label);
  return ImGui::IsItemDeactivatedAfterEdit();
}

template <class Number>
bool Ui::inputNumber(const char* label, std::string_view name, Number& value, Number min,
                     Number max, const char* tip) {
  constexpr bool kWhole = std::is_integral_v<Number>;
  Number entered = value;
  ImGui::InputScalar(label, kWhole ? ImGuiDataType_S64 : ImGuiDataType_Double, &entered, nullptr,
                     nullptr, kWhole ? "%lld" : "%.6g");
  note(name);
  tooltip(tip);
  // A number may be out of range while it is typed.
  if (ImGui::IsItemActive()) {
    value = entered;
    return false;
  }
  const bool in_range = value >= min && value <= max;  // false for NaN
  const bool changed = ImGui::IsItemDeactivatedAfterEdit() || !in_range;
  if (!changed) return false;
  value = entered >= min ? std::min(entered, max) : min;
  if (value != entered && on_correction) {
    on_correction(
        fmt::format("{}: {} is out of range {} to {}; using {}", name, entered, min, max, value));
  }
  return true;
}

bool Ui::integer(const char* label, std::int64_t& value, std::int64_t min, std::int64_t max,
                 const char* tip) {
  setInputWidth(label);
  return inputNumber(label, label, value, min, max, tip);
}

bool Ui::number(const char* label, double& value, double min, double max, const char* tip) {
  setInputWidth(label);
  return inputNumber(label, label, value, min, max, tip);
}

bool Ui::entry(const char* name, double& value, double min, double max, const char* tip) {
  return inputNumber(fmt::format("##{}", name).c_str(), name, value, min, max, tip);
}

bool Ui::vector(const char* label, std::array<double, 3>& value, double min, double max,
                const char* tip) {
  constexpr const char* kComponents[] = {"x", "y", "z"};
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x / 2;
  // Three numbers are wider than other inputs.
  const float width = std::floor((ImGui::GetContentRegionAvail().x * kVectorShare - 2 * gap) / 3);
  bool changed = false;
  ImGui::PushID(label);
  for (std::size_t axis = 0; axis < value.size(); ++axis) {
    if (axis > 0) ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(std::max(width, 1.0F));
    changed |=
        inputNumber(fmt::format("##{}", kComponents[axis]).c_str(),
                    fmt::format("{} {}", label, kComponents[axis]), value[axis], min, max, tip);
  }
  ImGui::PopID();
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::TextUnformatted(label);
  return changed;
}

bool Ui::slider(const char* label, int& value, int min, int max) {
  // SliderInt's grab is as wide as a step: with few steps it would fill half the slider.
  auto real = static_cast<float>(value);
  const bool changed =
      ImGui::SliderFloat(label, &real, static_cast<float>(min), static_cast<float>(max), "",
                         ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat);
  value = static_cast<int>(std::lround(real));
  note(label);
  return changed;
}

bool Ui::parameter(const Parameter& parameter) {
  const std::string name(parameter.name);
  const std::string tip = fmt::format("{}\n{}", parameter.doc, parameterRange(parameter));
  if (bool* const* flag = std::get_if<bool*>(&parameter.value)) {
    return checkbox(name.c_str(), **flag, tip.c_str());
  }
  const auto with_unit = [&](bool changed) {
    const std::string_view unit = parameterUnit(parameter);
    if (unit.empty()) return changed;
    ImGui::SameLine();
    // Without room for the unit, only the tooltip shows it.
    const ImVec2 extent = ImGui::CalcTextSize(unit.data(), unit.data() + unit.size());
    if (ImGui::GetContentRegionAvail().x >= extent.x) {
      faint(unit);
    } else {
      ImGui::NewLine();
    }
    return changed;
  };
  if (std::int64_t* const* whole = std::get_if<std::int64_t*>(&parameter.value)) {
    return with_unit(integer(name.c_str(), **whole, static_cast<std::int64_t>(parameter.min),
                             static_cast<std::int64_t>(std::min(parameter.max, 9.2e18)),
                             tip.c_str()));
  }
  if (double* const* real = std::get_if<double*>(&parameter.value)) {
    return with_unit(number(name.c_str(), **real, parameter.min, parameter.max, tip.c_str()));
  }
  if (Choice* const* choice = std::get_if<Choice*>(&parameter.value)) {
    const auto& options = (*choice)->options;
    auto chosen =
        static_cast<std::size_t>(std::ranges::find(options, (*choice)->value) - options.begin());
    if (!combo(name.c_str(), chosen, options, tip.c_str())) return false;
    (*choice)->value = options[chosen];
    return true;
  }
  const bool changed = text(name.c_str(), *std::get<std::string*>(parameter.value));
  tooltip(tip.c_str());
  return changed;
}

bool Ui::parameters(Parametrised& object) {
  bool changed = false;
  std::vector<std::string_view> groups;
  object.visitParameters([&](const Parameter& p) {
    if (p.group.empty()) {
      changed |= parameter(p);
    } else if (std::ranges::find(groups, p.group) == groups.end()) {
      groups.push_back(p.group);
    }
  });
  for (const std::string_view group : groups) {
    const std::string name(group);
    const bool open = ImGui::CollapsingHeader(name.c_str());
    note(name);
    if (!open) continue;
    object.visitParameters([&](const Parameter& p) {
      if (p.group == group) changed |= parameter(p);
    });
  }
  return changed;
}

}  // namespace broadmark
