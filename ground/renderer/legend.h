#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ground/renderer/rgb.h"
#include "ground/renderer/temperature_scale.h"
#include "ground/renderer/temperature_unit.h"

namespace isotherm {

/// Colour of the panel and of pixels without a surface.
inline constexpr Rgb8 kBackground{38, 42, 50};

/// One row of the panel beside a class layer.
struct LegendRow {
  Rgb8 colour;
  std::string name;      ///< E.g. "good".
  std::string detail;    ///< E.g. "0.30-0.60 m"; may be empty.
  std::string fraction;  ///< E.g. "62 %"; may be empty.
};

/// A line across the bar of a scale.
struct ScaleMark {
  double value = 0.0;
  Rgb8 colour;
};

/// Holds what the panel beside a rendering of values says.
struct ScaleLegend {
  std::string title;                      ///< E.g. "apparent temperature"; spaces break lines.
  std::optional<TemperatureScale> scale;  ///< nullopt: nothing was measured, no bar is drawn.
  std::string rule;                       ///< How the scale was chosen.
  bool never_measured = true;             ///< Explain the pattern of surfaces without a value.
  DisplayUnit unit;                       ///< In which values are written.
  std::vector<ScaleMark> marks;           ///< E.g. isotherms; outside the scale they are left out.
  std::vector<LegendRow> rows;            ///< Below the bar; colour and name only.
  std::vector<std::string> notes;         ///< Lines at the very bottom.
};

/// The colour that a value has in the rendering.
using ValueColour = std::function<Rgb8(double value)>;

/// Explains colours that stand for classes.
struct ClassLegend {
  std::string title;
  std::vector<LegendRow> rows;
};

/// `rendering` with a panel to its right; higher than `rendering` if the panel needs it.
RgbImage WithLegend(const RgbImage& rendering, const ScaleLegend& legend,
                    const ValueColour& colour);
RgbImage WithLegend(const RgbImage& rendering, const ClassLegend& legend);

/// Surface without a temperature in thermal renderings: dim grey, brightness by `cos_view`, with
/// diagonal lines, so that it looks neither like background nor like a temperature.
Rgb8 NeverMeasuredColour(int x, int y, double cos_view);

}  // namespace isotherm
