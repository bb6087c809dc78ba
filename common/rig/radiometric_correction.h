#pragma once

#include <span>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Tells by what a thermal camera's readings have to be raised to be right, as found before black
/// bodies of known temperature (thesis 5.1.1), and how well that is known. Linear between readings,
/// beyond them as at the nearest. Without readings nothing is known, and nothing corrected.
struct RadiometricCorrection {
  std::vector<float>
      readings_celsius;              ///< Apparent temperatures as the camera tells them, ascending.
  std::vector<float> corrections_k;  ///< To be added to them.
  /// Standard uncertainties of what results. They are the same for all measurements of one camera
  /// at one temperature: not noise.
  std::vector<float> sigmas_k;

  static constexpr int kMaxReadings = 32;
  /// A camera that is wrong by more has the wrong range or is broken.
  static constexpr float kMaxCorrection_k = 100.0F;

  bool empty() const { return readings_celsius.empty(); }

  /// Returns what to add to a reading, kelvin; 0 without readings.
  double At(double reading_celsius) const;
  /// Standard uncertainty of the corrected reading, kelvin; 0 without readings.
  double SigmaAt(double reading_celsius) const;

  /// Corrects readings, °C; NaN stays NaN.
  void Correct(std::span<float> celsius) const;
};

/// The message names the field of the rig file.
Status Validate(const RadiometricCorrection& correction);

}  // namespace isotherm
