#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "ground/renderer/contours.h"
#include "ground/renderer/isotherms.h"
#include "ground/renderer/layers.h"
#include "ground/renderer/legend.h"
#include "ground/renderer/palette.h"
#include "ground/renderer/temperature_scale.h"
#include "ground/renderer/view_maps.h"

namespace isotherm {

/// Fixed limits and percentiles must be finite and in order, whatever the scale rule, so that
/// switching rules is safe; isotherms and bands must be readable.
Status Validate(const RendererOptions& options);
Status Validate(const RendererExpertOptions& options);

/// Draws what a view of the model shows (algorithms 7-9), each layer x cos_view:
///   thermal    palette colour; never measured surface dim grey with diagonal lines; isotherms
///   distance   green, yellow, red = good, acceptable, bad; black = never measured
///   angle, motion, disagreement  the same; dim violet = measured, but not checked
///   age        light = soon after the NUC, dark = longest after it; dim violet = not known
///   uncertainty  light = certain, dark = least certain; dim violet = not known
///   coverage   grey where measured well, orange where only badly, magenta where never
///   geometry   light grey
/// Pixels without a surface have kBackground. With the legend option a panel is added to the right;
/// the view itself always starts at column 0. Thread-compatible; drawing is const.
class Renderer {
 public:
  /// `options` are valid; `thermal` supplies the limits that the class layers' legends
  /// state (CompleteLimits).
  Renderer(const RendererOptions& options, const ThermalOptions& thermal);

  /// The scale for `view` alone; pass a scale of your own to keep several renderings comparable.
  std::optional<TemperatureScale> ScaleFor(const ViewMaps& view) const;

  /// Returns whether the thermal layer needs a ContourField, for isotherm lines.
  bool draws_lines() const { return !lines_.empty(); }

  RgbImage Draw(RenderLayer layer, const ViewMaps& view,
                const std::optional<TemperatureScale>& scale,
                const ContourField* contours = nullptr) const;

  RgbImage Thermal(const ViewMaps& view) const { return Thermal(view, ScaleFor(view)); }
  /// Without `contours`, isotherm lines are left out.
  RgbImage Thermal(const ViewMaps& view, const std::optional<TemperatureScale>& scale,
                   const ContourField* contours = nullptr) const;
  RgbImage Distance(const ViewMaps& view) const;
  RgbImage Angle(const ViewMaps& view) const;
  RgbImage Motion(const ViewMaps& view) const;
  RgbImage Disagreement(const ViewMaps& view) const;
  // Of a view that was made with SampleRecords.
  RgbImage NucAge(const ViewMaps& view) const;
  RgbImage Uncertainty(const ViewMaps& view) const;
  RgbImage Coverage(const ViewMaps& view) const;
  RgbImage Geometry(const ViewMaps& view) const;

 private:
  /// Before shading.
  Rgb8 ColourOf(double celsius, const TemperatureScale& scale) const;
  ScaleLegend ThermalLegend(const std::optional<TemperatureScale>& scale, bool with_lines) const;
  RgbImage Classes(const ViewMaps& view, const Image<std::uint8_t>& classes,
                   const ClassLegend& legend) const;
  /// Draws `values` of measured surface: light = 0, dark = the end of legend.scale.
  RgbImage Values(const ViewMaps& view, const Image<float>& values, double largest,
                  ScaleLegend legend) const;

  const RendererOptions options_;
  const ThermalOptions thermal_;
  const ColourTable colours_;
  std::vector<IsothermLine> lines_;
  std::vector<TemperatureBand> bands_;
};

}  // namespace isotherm
