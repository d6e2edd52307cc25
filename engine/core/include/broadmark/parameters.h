// Typed parameters: name, default, range and explanation stated once, where the value lives.
// Command line, JSON, help and user interface are all derived from them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace broadmark {

/// One of a fixed set of words.
struct Choice {
  std::string value;
  std::vector<std::string> options;
};

/// A view of one parameter of an object: what it is called and where its value lives. A freshly
/// made object holds the default.
struct Parameter {
  std::string_view name;  ///< snake_case; its key on the command line and in JSON
  std::string_view doc;   ///< one sentence, with the unit
  std::variant<bool*, std::int64_t*, double*, Choice*, std::string*> value;
  double min = 0;  ///< inclusive range; numbers only
  double max = 0;
};

using ParameterVisitor = std::function<void(const Parameter&)>;

/// Anything whose parameters can be visited. Shows each of them to `visit`, in a fixed order.
class Parametrised {
 public:
  virtual ~Parametrised() = default;
  virtual void visitParameters(const ParameterVisitor&) {}
};

/// Values as text by name, as --param KEY=VALUE gives them.
using ParameterValues = std::map<std::string, std::string>;

/// The present name of an algorithm's parameter, which `name` is or was once. Commands, case names
/// and results may hold former names.
std::string_view currentParameterName(std::string_view name);

/// A parameter's value as text; reading it back gives the same value.
std::string parameterText(const Parameter&);
/// Its range or choices as text: "1…1000", "on|off", "cubes|spheres", "TEXT".
std::string parameterRange(const Parameter&);

/// The unit that its explanation ends with, "…, in seconds", as people abbreviate it: "s"; "" where
/// it has none.
std::string_view parameterUnit(const Parameter&);

/// Sets `parameter` from text. Throws InputError that names it, the text and what would be right.
void setParameter(const Parameter&, std::string_view text);

/// Sets all given values. Throws InputError on an unknown name (suggesting the nearest) or a value
/// out of range; then some values may already have been set.
void setParameters(Parametrised&, const ParameterValues&);

/// All parameters with their present values.
ParameterValues parameterValues(Parametrised&);
/// Those of `values` that differ from the values of `fresh`, which has its defaults.
ParameterValues changedValues(ParameterValues values, Parametrised& fresh);
/// Those of `values` that the object has.
ParameterValues applicableValues(Parametrised&, const ParameterValues& values);
/// The names of all parameters.
std::vector<std::string> parameterNames(Parametrised&);

}  // namespace broadmark
