#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "common/base/sigma_coverage.h"

namespace isotherm {

/// A temperature beside the truth, with what was said of its uncertainty.
struct AssessedError {
  double error_k = 0.0;                                       ///< Measured minus expected.
  double sigma_k = std::numeric_limits<double>::quiet_NaN();  ///< As stated; NaN = not known.
  double expected_sigma_k = 0.0;  ///< How uncertain what is expected is.
  // Of the measurement; NaN = not known.
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  double angle_deg = std::numeric_limits<double>::quiet_NaN();
};

/// Counts values in bins of equal width around 0, and what lies beyond on either side.
struct Histogram {
  /// In standard uncertainties: beyond five there is no error whose uncertainty is right.
  static constexpr double kEnd = 5.0;
  static constexpr double kWidth = 0.5;
  static constexpr std::size_t kBins = 20;
  static_assert(kBins * kWidth == 2.0 * kEnd);

  std::array<std::size_t, kBins> counts{};  ///< From -kEnd on; a value on a border is above it.
  std::size_t below = 0, above = 0;

  void Add(double value);
};

/// Holds the errors of one range of distances and angles; NaN if there are none.
struct ErrorCell {
  std::size_t count = 0;
  double median_k = std::numeric_limits<double>::quiet_NaN();
  double p95_k = std::numeric_limits<double>::quiet_NaN();
  double median_sigma_k = std::numeric_limits<double>::quiet_NaN();
};

/// |error| by distance (rows) and angle (columns). Each limit begins a row or a column; what lies
/// below the first or has no distance or angle is left out.
struct ErrorTable {
  /// Finer steps leave most cells with too few points for quantiles. Not tuned.
  static constexpr std::array kFrom_m = {0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  static constexpr std::array kFrom_deg = {0.0, 15.0, 30.0, 40.0, 50.0, 60.0};
  std::array<std::array<ErrorCell, kFrom_deg.size()>, kFrom_m.size()> cells{};
};

/// Tells whether the stated uncertainties are right: errors over them are then distributed with a
/// standard deviation of 1.
struct UncertaintyReport {
  std::size_t unknown = 0;  ///< Points without an uncertainty.
  // Of the points with one. Ratios are of errors over both uncertainties, that of the temperature
  // and that of what is expected.
  SigmaCoverage coverage;
  // NaN if there are none.
  double median_sigma_k = std::numeric_limits<double>::quiet_NaN();
  double p95_sigma_k = std::numeric_limits<double>::quiet_NaN();
  Histogram ratios;
  ErrorTable table;  ///< All points, by distance and angle.
};

UncertaintyReport EvaluateUncertainty(std::span<const AssessedError> errors);

}  // namespace isotherm
