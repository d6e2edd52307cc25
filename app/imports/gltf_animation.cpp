#include "imports/gltf_animation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace broadmark::imports::gltf {
namespace {

constexpr const char* kPointer = "KHR_animation_pointer";

std::optional<Property> propertyOf(const std::string& path) {
  if (path == "translation") return Property::translation;
  if (path == "rotation") return Property::rotation;
  if (path == "scale") return Property::scale;
  if (path == "weights") return Property::weights;
  return {};
}

/// How messages and --animation call an animation: by its name, or by its index.
std::string titleOf(const Document& document, std::uint32_t index) {
  const std::string name = textOr(document.item("animations", index), "name");
  return name.empty() ? fmt::format("{}", index) : fmt::format("'{}'", onOneLine(name));
}

std::string titlesOf(const Document& document) {
  std::vector<std::string> titles;
  for (std::uint32_t index = 0; index < document.count("animations"); ++index) {
    titles.push_back(titleOf(document, index));
  }
  return titles.empty() ? "none" : fmt::format("{}", fmt::join(titles, ", "));
}

/// Indices of the animations to play.
std::vector<std::uint32_t> chosenAnimations(const Document& document, const std::string& chosen) {
  std::vector<std::uint32_t> all;
  std::vector<std::uint32_t> named;
  for (std::uint32_t index = 0; index < document.count("animations"); ++index) {
    all.push_back(index);
    if (textOr(document.item("animations", index), "name") == chosen) named.push_back(index);
  }
  if (chosen.empty()) return all;
  if (named.size() > 1) {
    throw InputError(fmt::format("{}: {} animations are called '{}': choose --animation {}",
                                 document.name(), named.size(), chosen, fmt::join(named, " or ")));
  }
  if (!named.empty()) return named;
  for (const std::uint32_t index : all) {
    if (chosen == std::to_string(index)) return {index};
  }
  throw InputError(fmt::format("{}: no --animation '{}': the file has {}", document.name(),
                               onOneLine(chosen), titlesOf(document)));
}

/// Whether a channel drives no property of a node, but something that moves no body.
bool isOfNoNode(const JsonFields& target, ImportSummary& summary) {
  if (const auto pointer = extension(target, kPointer)) {
    const std::string driven = pointer->text("pointer");
    const bool moves_bodies = driven.starts_with("/nodes/") || driven.starts_with("/meshes/") ||
                              driven.starts_with("/skins/");
    if (moves_bodies) {
      fail(target, fmt::format("'{}' is animated by the extension {}, which is not supported",
                               onOneLine(driven), kPointer));
    }
    addOnce(summary.left_out, fmt::format("animation of {}", onOneLine(driven)));
    return true;
  }
  if (target.has("node")) return false;
  addOnce(summary.left_out, "an animation channel without a node");
  return true;
}

}  // namespace

void normalizeRotation(std::span<double> rotation, const std::string& what) {
  constexpr double kTolerance = 0.05;  // of bytes: 0.01
  Eigen::Map<Eigen::Vector4d> quaternion(rotation.data());
  const double length = quaternion.norm();
  if (!(std::abs(length - 1) <= kTolerance)) {
    throw InputError(fmt::format(
        "{}: a rotation of length {:g}: a quaternion of length 1 is expected", what, length));
  }
  if (length != 1) quaternion /= length;
}

Sampler::Sampler(Document& document, const JsonFields& object, Property property)
    : name_(object.name()), property_(property) {
  const std::string interpolation = textOr(object, "interpolation");
  if (interpolation == "STEP") {
    interpolation_ = Interpolation::step;
  } else if (interpolation == "CUBICSPLINE") {
    interpolation_ = Interpolation::cubic;
  } else if (!interpolation.empty() && interpolation != "LINEAR") {
    fail(object, fmt::format("interpolation '{}': STEP, LINEAR or CUBICSPLINE is expected",
                             onOneLine(interpolation)));
  }
  readTimes(document, object);
  readValues(document, object);
}

void Sampler::readTimes(Document& document, const JsonFields& object) {
  const Accessor& input = document.accessor(object, "input", "SCALAR");
  if (input.count == 0) fail(object, "has no keys");
  document.charge(input.count, sizeof(double));
  for (std::uint32_t i = 0; i < input.count; ++i) {
    const double time = input.number(i);
    if (!(time >= 0 && std::isfinite(time)) || (i > 0 && time <= times_.back())) {
      fail(object,
           fmt::format("key {} is at {:g} s: ascending times from 0 on are expected", i, time));
    }
    times_.push_back(time);
  }
}

void Sampler::readValues(Document& document, const JsonFields& object) {
  const bool is_scalar = property_ == Property::weights;
  const char* type = is_scalar ? "SCALAR" : property_ == Property::rotation ? "VEC4" : "VEC3";
  const std::size_t components = is_scalar ? 1 : property_ == Property::rotation ? 4 : 3;
  const Accessor& output = document.accessor(object, "output", type);
  const std::size_t per_key = interpolation_ == Interpolation::cubic ? 3 : 1;
  const std::size_t elements = times_.size() * per_key;
  const bool fits =
      is_scalar ? output.count > 0 && output.count % elements == 0 : output.count == elements;
  if (!fits) {
    fail(object,
         fmt::format("{} keys need {}{} elements of output, but there are {}", times_.size(),
                     is_scalar ? "a multiple of " : "", elements, output.count));
  }
  width_ = is_scalar ? output.count / elements : components;
  document.charge(output.count, components * sizeof(double));
  values_.resize(output.count * components);
  for (std::uint32_t i = 0; i < output.count; ++i) {
    output.read(i, std::span(values_).subspan(i * components, components));
  }
  if (property_ != Property::rotation) return;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const std::size_t at = (i * per_key + per_key / 2) * width_;
    normalizeRotation(std::span(values_).subspan(at, width_), name_);
  }
}

std::span<const double> Sampler::key(std::size_t index) const {
  const std::size_t at = interpolation_ == Interpolation::cubic ? 3 * index + 1 : index;
  return std::span(values_).subspan(at * width_, width_);
}

void Sampler::valueAt(double seconds, std::span<double> value) const {
  // The times of keys are rounded to 32-bit floats, and perhaps computed in these.
  constexpr double kTolerance = 0x1p-22;
  const auto next = static_cast<std::size_t>(
      std::ranges::upper_bound(times_, seconds * (1 + kTolerance)) - times_.begin());
  const std::size_t last = std::max<std::size_t>(next, 1) - 1;
  if (next == 0 || next == times_.size() || interpolation_ == Interpolation::step) {
    std::ranges::copy(key(last), value.begin());
    return;
  }
  const double factor = (seconds - times_[last]) / (times_[next] - times_[last]);
  interpolate(last, std::clamp(factor, 0.0, 1.0), value);
}

void Sampler::interpolate(std::size_t first, double factor, std::span<double> value) const {
  const std::span<const double> a = key(first);
  const std::span<const double> b = key(first + 1);
  if (interpolation_ == Interpolation::linear) {
    if (property_ == Property::rotation) {
      const Eigen::Quaterniond from(a.data());
      Eigen::Map<Eigen::Quaterniond>(value.data()) =
          from.slerp(factor, Eigen::Quaterniond(b.data()));
      return;
    }
    for (std::size_t i = 0; i < width_; ++i) value[i] = a[i] + (b[i] - a[i]) * factor;
    return;
  }
  const double duration = times_[first + 1] - times_[first];
  const double squared = factor * factor;
  const double cubed = squared * factor;
  const double* tangent_out = a.data() + width_;
  const double* tangent_in = b.data() - width_;
  for (std::size_t i = 0; i < width_; ++i) {
    value[i] = (2 * cubed - 3 * squared + 1) * a[i] +
               duration * (cubed - 2 * squared + factor) * tangent_out[i] +
               (3 * squared - 2 * cubed) * b[i] + duration * (cubed - squared) * tangent_in[i];
  }
  if (property_ != Property::rotation) return;
  Eigen::Map<Eigen::Vector4d> rotation(value.data());
  const double length = rotation.norm();
  if (!(length > 0)) throw InputError(name_ + ": a rotation between two keys has length 0");
  rotation /= length;
}

std::map<AnimatedProperty, std::shared_ptr<const Sampler>> readAnimations(Document& document,
                                                                          const std::string& chosen,
                                                                          ImportSummary& summary) {
  std::map<AnimatedProperty, std::shared_ptr<const Sampler>> animated;
  std::map<AnimatedProperty, std::uint32_t> driven_by;
  const std::vector<std::uint32_t> played = chosenAnimations(document, chosen);
  for (const std::uint32_t index : played) {
    const JsonFields animation = document.item("animations", index);
    const Json& samplers = animation.array("samplers");
    // Channels may share a sampler.
    std::map<std::pair<std::uint64_t, Property>, std::shared_ptr<const Sampler>> known;
    animation.eachObject("channels", [&](const JsonFields& channel) {
      const JsonFields target = channel.object("target");
      if (isOfNoNode(target, summary)) return;
      const std::string path = target.text("path");
      const auto property = propertyOf(path);
      if (!property) {
        fail(target, fmt::format("path '{}': translation, rotation, scale or weights is expected",
                                 onOneLine(path)));
      }
      const AnimatedProperty driven{document.index(target, "node", "nodes"), *property};
      if (const auto [other, added] = driven_by.emplace(driven, index); !added) {
        const std::string what = fmt::format("nodes[{}].{}", driven.node, path);
        if (other->second == index) fail(animation, fmt::format("drives {} twice", what));
        fail(document.root(),
             fmt::format("animations {} and {} both drive {}: choose one by --animation: {}",
                         titleOf(document, other->second), titleOf(document, index), what,
                         titlesOf(document)));
      }
      const std::uint64_t number = integer(channel, "sampler", samplers.size());
      if (number >= samplers.size()) {
        fail(channel,
             fmt::format("sampler {} does not exist: there are {}", number, samplers.size()));
      }
      auto& sampler = known[{number, *property}];
      if (sampler == nullptr) {
        sampler = std::make_shared<Sampler>(
            document,
            JsonFields(samplers[number], fmt::format("{}: samplers[{}]", animation.name(), number)),
            *property);
      }
      animated.emplace(driven, sampler);
    });
    const std::string of_all =
        chosen.empty() ? "" : fmt::format(" of {}", document.count("animations"));
    addOnce(summary.used, fmt::format("animation {}{}", titleOf(document, index), of_all));
  }
  return animated;
}

}  // namespace broadmark::imports::gltf
