#include "ground/feedback/coverage.h"

#include <cmath>
#include <vector>

#include "common/base/check.h"
#include "common/base/quantile.h"
#include "common/base/units.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

CoverageSummary SummarizeCoverage(const ViewMaps& view, const Image<float>& smear_px,
                                  const ThermalOptions& limits) {
  CHECK(smear_px.size() == 0 || smear_px.size() == view.celsius.size());
  const double cos_min = std::cos(limits.angle().min_deg() * kRadPerDeg);
  const double cos_good = std::cos(limits.angle().good_deg() * kRadPerDeg);
  const double smear_good_px = limits.expert().motion().smear_good_px();
  std::vector<double> smears_px;  // Of what only motion hinders.
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
      // Hindrances are only those of surface that is not measured well: the rest needs no better
      // view.
      if (quality == MeasurementQuality::kGood) continue;
      const double distance_m = view.distance_m.At(x, y);
      const double cosine = view.cos_view.At(x, y);
      const bool too_near = distance_m < limits.distance().min_m();
      const bool too_far = distance_m > limits.distance().good_m();
      const bool too_oblique = cosine < cos_good;
      const bool too_frontal = cosine > cos_min;
      counts.too_near += too_near ? 1.0 : 0.0;
      counts.too_far += too_far ? 1.0 : 0.0;
      counts.too_oblique += too_oblique ? 1.0 : 0.0;
      counts.too_frontal += too_frontal ? 1.0 : 0.0;
      if (too_near || too_far || too_oblique || too_frontal || smear_px.size() == 0) continue;
      if (smear_px.At(x, y) > smear_good_px) smears_px.push_back(smear_px.At(x, y));
    }
  }
  if (counts.surface == 0.0) return {};
  counts.too_fast = static_cast<double>(smears_px.size());
  if (!smears_px.empty()) counts.smear_px = TakeMedian(smears_px);
  const double pixels = static_cast<double>(view.celsius.size());
  for (double* fraction :
       {&counts.good, &counts.acceptable, &counts.bad, &counts.never_measured, &counts.too_near,
        &counts.too_far, &counts.too_oblique, &counts.too_frontal, &counts.too_fast}) {
    *fraction /= counts.surface;
  }
  counts.surface /= pixels;
  return counts;
}

}  // namespace isotherm
