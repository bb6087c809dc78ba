#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace isotherm {

/// Says what a rendering shows on the surface of the model.
enum class RenderLayer : std::uint8_t {
  kThermal,       ///< Palette colour of the apparent temperature (algorithm 7).
  kDistance,      ///< Class of the measurement distance (algorithm 8).
  kAngle,         ///< Class of the emission angle (algorithm 9).
  kMotion,        ///< Class of the smear while the temperature was measured.
  kDisagreement,  ///< Class of how far measurements under good conditions contradict each other.
  kAge,           ///< Seconds between the last NUC and the measurement.
  kUncertainty,   ///< Standard uncertainty of the temperature.
  kCoverage,      ///< Seen by depth, but never measured well.
  kGeometry,      ///< The surface only.
};

/// In the order in which they are explained and written.
std::span<const RenderLayer> AllLayers();

/// As in options and file names: "thermal".
std::string_view LayerName(RenderLayer layer);

std::optional<RenderLayer> LayerFromName(std::string_view name);

}  // namespace isotherm
