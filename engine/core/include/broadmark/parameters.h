// Typed parameters: name, default, range and documentation are declared once, where the value is
// stored. Command line, JSON, help and user interface are derived from them.
//
// Example:
//
//   class Grid final : public Parametrised {
//    public:
//     void visitParameters(const ParameterVisitor& visit) override {
//       visit({"cell_size", "edge length of a cell, in world units", &cell_size_, 0.1, 1e6});
//     }
//
//    private:
//     double cell_size_ = 1;  // the default
//   };
//   Grid grid;
//   setParameters(grid, {{"cell_size", "2.5"}});
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace broadmark {

/// One value of a fixed set.
struct Choice {
  std::string value;                 ///< one of `options`
  std::vector<std::string> options;  ///< all values, in the order of lists and menus
};

/// A view of one parameter of an object: its name and a reference to its value. A new object holds
/// the default.
struct Parameter {
  std::string_view name;  ///< snake_case; its key on the command line and in JSON
  std::string_view doc;   ///< documentation: one sentence, with the unit
  /// Borrowed: valid as long as the object.
  std::variant<bool*, std::int64_t*, double*, Choice*, std::string*> value;
  double min = 0;  ///< inclusive range; numbers only
  double max = 0;  ///< inclusive
  /// Heading for the user interface, which folds groups; "": often set, always shown.
  std::string_view group = {};
};

/// Called with one parameter after another. It may read and write their values.
using ParameterVisitor = std::function<void(const Parameter&)>;

/// An object with parameters, visited in a fixed order.
class Parametrised {
 public:
  virtual ~Parametrised() = default;
  /// Calls the visitor once for each parameter; by default there are none.
  virtual void visitParameters(const ParameterVisitor&) {}
};

/// Values as text by name, as in --param KEY=VALUE.
using ParameterValues = std::map<std::string, std::string>;

/// The current name of an algorithm's parameter, for a current or former name; an unknown name is
/// returned as it is. Commands, case names and results may hold former names, which the functions
/// below do not know.
std::string_view currentParameterName(std::string_view name);

/// A parameter's value as text, which setParameter() turns back into the same value.
std::string parameterText(const Parameter&);
/// A parameter's range or choices as text: "1…1000", "on|off", "cubes|spheres", "TEXT".
std::string parameterRange(const Parameter&);

/// The unit at the end of a parameter's documentation, "…, in seconds", abbreviated: "s"; or "".
std::string_view parameterUnit(const Parameter&);

/// Sets a parameter from text: a decimal number, on/true/1 or off/false/0, one of the choices, or
/// any text. Throws InputError with its name, the text and the valid range; then the value is
/// unchanged.
void setParameter(const Parameter&, std::string_view text);

/// Sets all given values. Throws InputError for an unknown name (suggesting the nearest) or a value
/// out of range, possibly after setting some values.
void setParameters(Parametrised&, const ParameterValues&);

/// The present values of all parameters.
ParameterValues parameterValues(Parametrised&);
/// The entries of `values` that differ from the values of `fresh`, an object with the defaults, and
/// those that name none of its parameters.
ParameterValues changedValues(ParameterValues values, Parametrised& fresh);
/// The entries of `values` that name a parameter of the object.
ParameterValues applicableValues(Parametrised&, const ParameterValues& values);
/// The names of all parameters, in the order of visitParameters().
std::vector<std::string> parameterNames(Parametrised&);

}  // namespace broadmark
