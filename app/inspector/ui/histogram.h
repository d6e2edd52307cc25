// A histogram, drawn.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "inspector/ui/ui.h"

namespace broadmark {

/// Fills what is left of the window with the histogram of the values, without their tails, and
/// writes a few of them below, as `text` has them. `line`: a value that is marked. Without values,
/// or where all are the same, it draws nothing.
void drawHistogram(Ui& ui, std::span<const double> values,
                   const std::function<std::string(double)>& text, std::optional<double> line = {});

}  // namespace broadmark
