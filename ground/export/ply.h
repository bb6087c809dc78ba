#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "ground/export/surface.h"
#include "ground/renderer/palette.h"
#include "ground/renderer/temperature_scale.h"

namespace isotherm {

/// How points are coloured and what the header says about the scan.
struct PlyStyle {
  const ColourTable& colours;
  std::optional<TemperatureScale> scale;  ///< nullopt: nothing was measured.
  std::string palette_name;               ///< As PaletteName gives it.
  std::string software;                   ///< Name and version.
  bool interpreted = false;               ///< Points hold object temperatures (Interpretation).
};

/// Colour of points that were never measured.
inline constexpr Rgb8 kNeverMeasuredPoint{96, 96, 96};

/// Writes `surface.points` as binary little-endian PLY with the properties x y z nx ny nz (float,
/// `world`, metres) red green blue (uchar) scalar_temperature (float, degC, NaN = never measured)
/// distance_class angle_class (uchar) quality (float, the temperature again, under the name that
/// MeshLab shows) motion_class disagreement_class nuc_epoch (uchar) nuc_age_s measured_distance
/// measured_angle (float) and, if `style.interpreted`, apparent_temperature (float, degC, as
/// measured). The order matters: CloudCompare gives each column to the first property whose name
/// fits.
Status WriteCloudPly(const Surface& surface, const PlyStyle& style,
                     const std::filesystem::path& path);

/// The same with `list uchar int vertex_indices` faces, and only the points that they use.
Status WriteMeshPly(const Surface& surface, const PlyStyle& style,
                    const std::filesystem::path& path);

}  // namespace isotherm
