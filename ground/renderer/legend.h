#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ground/renderer/palette.h"
#include "ground/renderer/temperature_scale.h"

namespace isotherm {

/// Colour of the panel and of pixels without a surface.
inline constexpr Rgb8 kBackground{38, 42, 50};

/// What the panel beside a thermal picture says.
struct ScaleLegend {
  std::string title;                      ///< E.g. "apparent temperature"; spaces break lines.
  std::optional<TemperatureScale> scale;  ///< nullopt: nothing was measured, no bar is drawn.
  std::string rule;                       ///< How the scale was chosen.
  bool never_measured = true;    ///< Explain the pattern of surfaces without a temperature.
  std::string unit = "\u00B0C";  ///< Of the scale.
};

/// One row of the panel beside a class layer.
struct LegendRow {
  Rgb8 colour;
  std::string name;    ///< E.g. "good".
  std::string detail;  ///< E.g. "0.30-0.60 m"; may be empty.
  std::string share;   ///< E.g. "62 %"; may be empty.
};

struct ClassLegend {
  std::string title;
  std::vector<LegendRow> rows;
};

/// `picture` with a panel to its right; higher than `picture` if the panel needs it.
RgbImage WithLegend(const RgbImage& picture, const ScaleLegend& legend, const ColourTable& colours);
RgbImage WithLegend(const RgbImage& picture, const ClassLegend& legend);

/// Surface without a temperature in thermal pictures: dim grey, brightness by `cos_view`, with
/// diagonal lines, so that it looks neither like background nor like a temperature.
Rgb8 NeverMeasuredColour(int x, int y, double cos_view);

}  // namespace isotherm
