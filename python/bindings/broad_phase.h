// The class BroadPhase of the compiled module.
#pragma once

#include <pybind11/pybind11.h>

namespace broadmark {

void defineBroadPhase(pybind11::module_& module);

}  // namespace broadmark
