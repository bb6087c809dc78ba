#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ground/radiometric_calibration/housing_drift_fit.h"
#include "ground/radiometric_calibration/radiometric_session.h"

namespace isotherm {

/// Holds what a radiometric calibration has found.
struct RadiometricFindings {
  std::optional<RadiometricReport> readings;
  std::optional<DriftReport> drift;
};

/// Returns a page that needs nothing else: `text`, the report as on a terminal, and plots of the
/// correction over the reading and of what holes of several sizes read (thesis figures 5.6 to 5.9).
std::string RadiometricHtml(const RadiometricFindings& found, std::string_view text);

}  // namespace isotherm
