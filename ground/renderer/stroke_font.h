#pragma once

#include <string_view>
#include <vector>

namespace isotherm {

/// A straight piece of a letter's stroke. The unit is the height of a capital letter; x goes right
/// from where the text begins, y down from the baseline.
struct StrokeLine {
  double x0 = 0.0, y0 = 0.0;
  double x1 = 0.0, y1 = 0.0;
};

/// The strokes of `text`, which is UTF-8; ASCII and the degree sign are drawn, anything else is a
/// question mark.
std::vector<StrokeLine> TextStrokes(std::string_view text);

/// The width of `text`, in heights of a capital letter.
double TextAdvance(std::string_view text);

}  // namespace isotherm
