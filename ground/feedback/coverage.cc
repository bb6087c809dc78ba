#include "ground/feedback/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ground/ground_options.pb.h"

namespace isotherm {
namespace {

// Shares of the surface in view. Below the first, a hindrance is noise at edges; above the second
// there is nothing left worth a detour; below the third the view shows too little to judge.
constexpr double kWorthSaying = 0.15;
constexpr double kDone = 0.90;
constexpr double kSurfaceNeeded = 0.02;

}  // namespace

CoverageSummary SummarizeCoverage(const ViewMaps& view, const ThermalOptions& limits) {
  const double cos_max = std::cos(limits.angle_max_deg() * std::numbers::pi / 180.0);
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
      if (quality == MeasurementQuality::kGood || quality == MeasurementQuality::kAcceptable) continue;
      const double distance_m = view.distance_m.At(x, y);
      counts.too_near += distance_m < limits.distance_min_m() ? 1.0 : 0.0;
      counts.too_far += distance_m > limits.distance_max_m() ? 1.0 : 0.0;
      counts.too_oblique += static_cast<double>(view.cos_view.At(x, y)) < cos_max ? 1.0 : 0.0;
    }
  }
  if (counts.surface == 0.0) return {};
  const double pixels = static_cast<double>(view.celsius.size());
  for (double* share : {&counts.good, &counts.acceptable, &counts.bad, &counts.never_measured,
                        &counts.too_near, &counts.too_far, &counts.too_oblique}) {
    *share /= counts.surface;
  }
  counts.surface /= pixels;
  return counts;
}

std::string_view ToString(AdviceKind advice) {
  switch (advice) {
    case AdviceKind::kNone:
      return "carry on";
    case AdviceKind::kDone:
      return "done here";
    case AdviceKind::kCloser:
      return "closer";
    case AdviceKind::kFarther:
      return "farther";
    case AdviceKind::kLessOblique:
      return "less oblique";
    case AdviceKind::kSlower:
      return "slower";
    case AdviceKind::kHoldForNuc:
      return "hold for NUC";
    case AdviceKind::kGoBack:
      return "go back";
  }
  return "";
}

OperatorAdvice AdviseOperator(const CoverageSummary& coverage, const ScanSituation& situation,
                              const ThermalOptions& limits) {
  const auto percent = [](double share) { return 100.0 * share; };
  const auto beyond = [](double value, double limit) { return limit > 0.0 && value > limit; };
  if (situation.tracking_lost) {
    return {AdviceKind::kGoBack, "tracking is lost: return to the last view that was tracked"};
  }
  if (situation.nuc_running) {
    return {AdviceKind::kHoldForNuc, "the thermal camera is correcting itself: hold still"};
  }
  if (beyond(situation.speed_m_s, situation.max_speed_m_s)) {
    return {AdviceKind::kSlower, fmt::format("{:.2f} m/s, the model follows up to {:.2f} m/s",
                                             situation.speed_m_s, situation.max_speed_m_s)};
  }
  if (beyond(situation.turn_rate_deg_s, situation.max_turn_rate_deg_s)) {
    return {AdviceKind::kSlower,
            fmt::format("turning at {:.0f} deg/s, the model follows up to {:.0f} deg/s",
                        situation.turn_rate_deg_s, situation.max_turn_rate_deg_s)};
  }
  if (coverage.surface < kSurfaceNeeded) {
    return {AdviceKind::kGoBack, "no surface of the model in view: point at the object"};
  }
  if (coverage.good + coverage.acceptable >= kDone) {
    return {AdviceKind::kDone, fmt::format("{:.0f} % of the surface in view is measured well",
                                           percent(coverage.good + coverage.acceptable))};
  }
  const double most = std::max({coverage.too_near, coverage.too_far, coverage.too_oblique});
  if (most < kWorthSaying) return {};
  if (coverage.too_far == most) {
    return {AdviceKind::kCloser, fmt::format("{:.0f} % of the surface is farther than {:.2f} m",
                                             percent(most), limits.distance_max_m())};
  }
  if (coverage.too_near == most) {
    return {AdviceKind::kFarther, fmt::format("{:.0f} % of the surface is nearer than {:.2f} m",
                                              percent(most), limits.distance_min_m())};
  }
  return {AdviceKind::kLessOblique,
          fmt::format("{:.0f} % of the surface is seen at more than {:.0f} deg", percent(most),
                      limits.angle_max_deg())};
}

}  // namespace isotherm
