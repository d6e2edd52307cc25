// Parameters that a C plug-in or an external program describes.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/parameters.h"

namespace broadmark {

struct ParameterDescription {
  std::string name;
  std::string doc;
  double value = 0;  ///< the default
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
  bool is_integer = false;
};

/// The values of an instance.
class DescribedParameters {
 public:
  explicit DescribedParameters(std::vector<ParameterDescription> descriptions)
      : descriptions_(std::move(descriptions)) {
    for (const ParameterDescription& description : descriptions_) {
      integers_.push_back(static_cast<std::int64_t>(description.value));
      reals_.push_back(description.value);
    }
  }

  void visit(const ParameterVisitor& visit) {
    for (std::size_t i = 0; i < descriptions_.size(); ++i) {
      const ParameterDescription& description = descriptions_[i];
      Parameter view{.name = description.name, .doc = description.doc, .value = &reals_[i]};
      if (description.is_integer) view.value = &integers_[i];
      view.min = description.min;
      view.max = description.max;
      visit(view);
    }
  }

  /// Calls take(name, value) for each, in their order; the value is an integer or a double.
  template <class Take>
  void eachValue(Take&& take) const {
    for (std::size_t i = 0; i < descriptions_.size(); ++i) {
      const std::string& name = descriptions_[i].name;
      descriptions_[i].is_integer ? take(name, integers_[i]) : take(name, reals_[i]);
    }
  }

 private:
  std::vector<ParameterDescription> descriptions_;
  std::vector<std::int64_t> integers_;  ///< used by index if integers
  std::vector<double> reals_;           ///< else
};

}  // namespace broadmark
