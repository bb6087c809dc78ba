#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "ground/renderer/palette.h"
#include "ground/renderer/temperature_scale.h"
#include "ground/renderer/view_maps.h"

namespace isotherm {

class RendererOptions;
class ThermalOptions;

/// Fixed limits must be finite and in order; applies whatever the scale rule, so that switching
/// rules is safe.
Status Validate(const RendererOptions& options);

/// Draws what a view of the model shows (algorithms 7-9):
///   thermal    palette colour x cos_view; never measured surface dim grey with diagonal lines
///   distance   green, yellow, red = good, acceptable, bad measurement distance; black = never
///   measured angle      the same for the emission angle geometry   light grey x cos_view
/// Pixels without a surface have kBackground. With the legend option a panel is added to the right;
/// the view itself always starts at column 0. Thread-compatible; drawing is const.
class Renderer {
 public:
  /// `thermal` supplies the limits that the class layers' legends state.
  Renderer(const RendererOptions& options, const ThermalOptions& thermal);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// The scale for `view` alone; pass a scale of your own to keep several pictures comparable.
  std::optional<TemperatureScale> ScaleFor(const ViewMaps& view) const;

  RgbImage Thermal(const ViewMaps& view) const { return Thermal(view, ScaleFor(view)); }
  RgbImage Thermal(const ViewMaps& view, const std::optional<TemperatureScale>& scale) const;
  RgbImage Distance(const ViewMaps& view) const;
  RgbImage Angle(const ViewMaps& view) const;
  RgbImage Geometry(const ViewMaps& view) const;

 private:
  struct Layer;
  RgbImage Classes(const ViewMaps& view, const Image<std::uint8_t>& classes,
                   const Layer& layer) const;

  std::unique_ptr<const RendererOptions> options_;
  ColourTable colours_;
  std::unique_ptr<const Layer> distance_;
  std::unique_ptr<const Layer> angle_;
};

/// One thermal frame as the camera delivers it (`centikelvin` as in ThermalFrame, 0 = no value), in
/// the same palette, scale rule and legend; no shading.
RgbImage RenderThermalFrame(const Image<std::uint16_t>& centikelvin,
                            const RendererOptions& options);

}  // namespace isotherm
