// Animations of a glTF file: which properties of nodes they drive, and their values at any time.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "imports/gltf_document.h"

namespace broadmark::imports::gltf {

enum class Property { translation, rotation, scale, weights };

/// A rotation x, y, z, w of length 1, up to rounding; throws InputError, calling it `what`, if it
/// is no rotation.
void normalizeRotation(std::span<double> rotation, const std::string& what);

/// A property as a function of time, between keys.
class Sampler {
 public:
  Sampler(Document& document, const JsonFields& object, Property property);

  /// Number of components: 4 of a rotation, one per morph target of weights.
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Time of the last key, in seconds.
  [[nodiscard]] double end() const { return times_.back(); }
  /// The components at a time; before the first key and after the last one, as there.
  void valueAt(double seconds, std::span<double> value) const;

 private:
  enum class Interpolation { step, linear, cubic };

  void readTimes(Document& document, const JsonFields& object);
  void readValues(Document& document, const JsonFields& object);
  [[nodiscard]] std::span<const double> key(std::size_t index) const;
  void interpolate(std::size_t first, double factor, std::span<double> value) const;

  std::string name_;
  Property property_;
  Interpolation interpolation_ = Interpolation::linear;
  std::size_t width_ = 0;
  std::vector<double> times_;
  std::vector<double> values_;  ///< by key; of a cubic spline: tangent in, value, tangent out
};

struct AnimatedProperty {
  std::uint32_t node = 0;
  Property property = Property::translation;

  friend auto operator<=>(const AnimatedProperty&, const AnimatedProperty&) = default;
};

/// The animated properties of the animation with the name or index `chosen`; "": of all of them.
/// Throws InputError if there is no such animation, or if two drive the same property.
std::map<AnimatedProperty, std::shared_ptr<const Sampler>> readAnimations(Document& document,
                                                                          const std::string& chosen,
                                                                          ImportSummary& summary);

}  // namespace broadmark::imports::gltf
