#include "ground/feedback/coverage.h"

#include <cmath>
#include <numbers>

#include "ground/options/ground_options.pb.h"

namespace isotherm {

CoverageSummary SummarizeCoverage(const ViewMaps& view, const ThermalOptions& limits) {
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  const double cos_min = std::cos(limits.angle().min_deg() * kRadPerDeg);
  const double cos_good = std::cos(limits.angle().good_deg() * kRadPerDeg);
  CoverageSummary counts;
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      if (!view.HasSurface(x, y)) continue;
      counts.surface += 1.0;
      const MeasurementQuality quality = QualityAt(view, x, y);
      counts.good += quality == MeasurementQuality::kGood ? 1.0 : 0.0;
      counts.acceptable += quality == MeasurementQuality::kAcceptable ? 1.0 : 0.0;
      counts.bad += quality == MeasurementQuality::kBad ? 1.0 : 0.0;
      counts.never_measured += quality == MeasurementQuality::kNever ? 1.0 : 0.0;
      if (quality == MeasurementQuality::kGood) continue;
      const double distance_m = view.distance_m.At(x, y);
      const double cosine = view.cos_view.At(x, y);
      counts.too_near += distance_m < limits.distance().min_m() ? 1.0 : 0.0;
      counts.too_far += distance_m > limits.distance().good_m() ? 1.0 : 0.0;
      counts.too_oblique += cosine < cos_good ? 1.0 : 0.0;
      counts.too_frontal += cosine > cos_min ? 1.0 : 0.0;
    }
  }
  if (counts.surface == 0.0) return {};
  const double pixels = static_cast<double>(view.celsius.size());
  for (double* fraction :
       {&counts.good, &counts.acceptable, &counts.bad, &counts.never_measured, &counts.too_near,
        &counts.too_far, &counts.too_oblique, &counts.too_frontal}) {
    *fraction /= counts.surface;
  }
  counts.surface /= pixels;
  return counts;
}

}  // namespace isotherm
