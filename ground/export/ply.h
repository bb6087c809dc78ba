#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "ground/mesh/surface.h"
#include "ground/renderer/palette.h"
#include "ground/renderer/temperature_scale.h"

namespace isotherm {

/// Tells how points are coloured and what the header says about the scan.
struct PlyStyle {
  const ColourTable& colours;
  std::optional<TemperatureScale> scale;  ///< nullopt: nothing was measured.
  std::string palette_name;               ///< As PaletteName gives it.
  std::string software;                   ///< Name and version.
  bool interpreted = false;               ///< Points hold object temperatures (Interpretation).
};

/// Colour of points that were never measured.
inline constexpr Rgb8 kNeverMeasuredPoint{96, 96, 96};

/// `quality` of points that were never measured, degC: absolute zero, which nothing has. MeshLab
/// aborts when it colours by a quality that is NaN.
inline constexpr float kNeverMeasuredQuality = -273.15F;

/// Writes `surface.points` as binary little-endian PLY with the properties x y z nx ny nz (float,
/// `world`, metres) red green blue (uchar) scalar_temperature (float, degC, NaN = never measured)
/// scalar_distance_class scalar_angle_class (uchar) quality (float, the temperature again, under
/// the name that MeshLab shows) scalar_motion_class scalar_disagreement_class scalar_nuc_epoch
/// (uchar) scalar_nuc_age_s scalar_measured_distance scalar_measured_angle (float)
/// scalar_temperature_sigma (float, kelvin, NaN = never measured or not known) and, if
/// `style.interpreted`, scalar_apparent_temperature (float, degC, as measured). CloudCompare makes
/// scalar fields of all properties with that prefix. The order matters: it gives each column to the
/// first property whose name fits.
Status WriteCloudPly(const Surface& surface, const PlyStyle& style,
                     const std::filesystem::path& path);

/// The same with `list uchar int vertex_indices` faces, and only the points that they use.
Status WriteMeshPly(const Surface& surface, const PlyStyle& style,
                    const std::filesystem::path& path);

}  // namespace isotherm
