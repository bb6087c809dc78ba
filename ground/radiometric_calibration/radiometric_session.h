#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "ground/radiometric_calibration/correction_curve.h"
#include "ground/radiometric_calibration/influence_fit.h"
#include "ground/radiometric_calibration/set_point_table.h"

namespace isotherm {

/// Says what black bodies are like, and what is known before.
struct RadiometricConditions {
  double emissivity = 1.0;          ///< The black body's.
  double reflected_celsius = 23.0;  ///< The black body reflects this.
  double common_sigma_k = 0.5;      ///< All its temperatures may be off by this together.
  double emissivity_sigma = 0.0, reflected_sigma_k = 0.0;  ///< Standard uncertainties.
};

/// Says what a row of the table became.
struct RowReport {
  SetPointRow row;
  int frames = 0;                 ///< Number of its images.
  double hole_radius_px = 0.0;    ///< 0: no images, or they show nothing but the black body.
  double apparent_celsius = 0.0;  ///< A right camera reads this.
  double measured_celsius = 0.0;  ///< The camera reads this.
  double own_celsius = 0.0;       ///< Without the scene's influence.
  double common_sigma_k = 0.0;    ///< All should read otherwise by this together.
  double left_k = 0.0;            ///< Wrong after the correction.
};

struct RadiometricReport {
  std::vector<RowReport> rows;
  /// nullopt: images did not tell it; `why_no_influence` says why, if there were images.
  std::optional<InfluenceReport> influence;
  std::string why_no_influence;
  SceneInfluence taken_out;  ///< It was taken out of images before the curve was found.
  CurveReport curve;
  int temperatures = 0;  ///< Different ones of the black body.

  /// All that is corrected is within twice its uncertainty, that of the black body included.
  bool IsRightAsItIs() const;
};

/// Reads the images that the table names, finds the scene influence by those of them that show the
/// black body through holes, and then by what readings are wrong. `rig` replaces the recordings'
/// own calibration, and is set to the one that was used, if there is any: of it come the units of
/// PNG files, and the scene influence that is taken out if the images cannot tell it. `progress`
/// gets the fraction done, 0..1.
Result<RadiometricReport> CalibrateReadings(const std::filesystem::path& table,
                                            const RadiometricConditions& conditions,
                                            std::optional<Rig>& rig,
                                            const std::function<void(double)>& progress);

}  // namespace isotherm
