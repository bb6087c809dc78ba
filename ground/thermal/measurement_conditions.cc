#include "ground/thermal/measurement_conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/radiometry/optics.h"

namespace isotherm {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

float CosineOfDegrees(double degrees) { return static_cast<float>(std::cos(degrees * kRadPerDeg)); }

/// Smaller is better: good before acceptable before unchecked.
int Rank(ConditionClass c) { return static_cast<int>(c); }

DepthOfField SharpDistances(const ThermalLens& lens) {
  return ComputeDepthOfField(1e-3 * lens.focal_length_mm(), lens.f_number(),
                             1e-6 * lens.pixel_pitch_um(), lens.focus_m());
}

/// Options that were written out have all numbers, 0 where none was given.
bool IsKnown(const ThermalLens& lens) {
  return lens.focal_length_mm() != 0.0 || lens.f_number() != 0.0 || lens.focus_m() != 0.0 ||
         lens.pixel_pitch_um() != 0.0;
}

Status ValidateLens(const ThermalOptions& o) {
  const ThermalLens& lens = o.lens();
  if (!(lens.focal_length_mm() > 0.0 && lens.f_number() > 0.0 && lens.pixel_pitch_um() > 0.0 &&
        lens.focus_m() > 1e-3 * lens.focal_length_mm())) {
    return InvalidArgument(
        "thermal.lens: focal_length_mm, f_number and pixel_pitch_um must be positive, and focus_m "
        "beyond the focal length");
  }
  const DepthOfField sharp = SharpDistances(lens);
  if (sharp.near_m >= o.distance_max_m() || sharp.far_m <= o.distance_min_m()) {
    return InvalidArgument(
        fmt::format("thermal.lens: sharp from {:.3f} to {:.3f} m only, outside distance_min_m {} m "
                    "to distance_max_m {} m: nothing could be measured",
                    sharp.near_m, sharp.far_m, o.distance_min_m(), o.distance_max_m()));
  }
  return OkStatus();
}

}  // namespace

Status Validate(const ThermalOptions& o) {
  if (!(o.distance_min_m() >= 0.0 && o.distance_min_m() < o.distance_good_m() &&
        o.distance_good_m() <= o.distance_max_m())) {
    return InvalidArgument(
        fmt::format("thermal: need 0 <= distance_min_m < distance_good_m <= distance_max_m, got {} "
                    "m, {} m, {} m",
                    o.distance_min_m(), o.distance_good_m(), o.distance_max_m()));
  }
  if (!(o.angle_min_deg() >= 0.0 && o.angle_min_deg() < o.angle_good_deg() &&
        o.angle_good_deg() <= o.angle_max_deg() && o.angle_max_deg() <= 90.0)) {
    return InvalidArgument(
        fmt::format("thermal: need 0 <= angle_min_deg < angle_good_deg <= angle_max_deg <= 90, got "
                    "{}, {}, {} degrees",
                    o.angle_min_deg(), o.angle_good_deg(), o.angle_max_deg()));
  }
  if (!(o.parallax_tolerance_m() > 0.0 && o.vertex_distance_vox() > 0.0 && o.max_wait_s() >= 0.0 &&
        o.max_wait_s() <= 10.0)) {
    return InvalidArgument(
        "thermal: parallax_tolerance_m and vertex_distance_vox must be positive, max_wait_s 0..10 "
        "s");
  }
  if (o.edge_margin_px() < 0 || o.edge_margin_px() > 16) {
    return InvalidArgument(
        fmt::format("thermal.edge_margin_px must be 0..16 pixels, got {}", o.edge_margin_px()));
  }
  if (!(o.max_time_sigma_s() > 0.0)) {
    return InvalidArgument(
        fmt::format("thermal.max_time_sigma_s must be positive, got {} s", o.max_time_sigma_s()));
  }
  if (!(o.max_registration_px() > 0.0)) {
    return InvalidArgument(fmt::format("thermal.max_registration_px must be positive, got {} px",
                                       o.max_registration_px()));
  }
  if (o.visibility_halvings() != 0 && o.visibility_halvings() != 1) {
    return InvalidArgument(
        fmt::format("thermal.visibility_halvings must be 0 or 1, got {}", o.visibility_halvings()));
  }
  if (!(o.time_constant_s() >= 0.0 && o.time_constant_s() <= 1.0 && o.row_readout_s() >= 0.0 &&
        o.row_readout_s() <= 0.01)) {
    return InvalidArgument(fmt::format(
        "thermal: time_constant_s must be 0..1 s and row_readout_s 0..0.01 s, got {} and {}",
        o.time_constant_s(), o.row_readout_s()));
  }
  if (!(o.smear_good_px() > 0.0 && o.smear_good_px() <= o.smear_max_px())) {
    return InvalidArgument(
        fmt::format("thermal: need 0 < smear_good_px <= smear_max_px, got {} px and {} px",
                    o.smear_good_px(), o.smear_max_px()));
  }
  if (!(o.disagreement_noise_k() >= 0.0 && o.disagreement_good_k() > 0.0 &&
        o.disagreement_good_k() <= o.disagreement_max_k())) {
    return InvalidArgument(
        fmt::format("thermal: need disagreement_noise_k >= 0 and 0 < disagreement_good_k <= "
                    "disagreement_max_k, got {}, {} and {} K",
                    o.disagreement_noise_k(), o.disagreement_good_k(), o.disagreement_max_k()));
  }
  if (!(o.max_gradient_error_k() >= 0.0 && o.max_footprint_m() >= 0.0)) {
    return InvalidArgument(
        fmt::format("thermal: max_gradient_error_k and max_footprint_m must not be negative, got "
                    "{} K and {} m",
                    o.max_gradient_error_k(), o.max_footprint_m()));
  }
  if (!(o.near_range_m() >= 0.0 && o.near_range_m() <= 10.0) || o.hole_px() < 4 ||
      o.hole_px() > 256) {
    return InvalidArgument(
        fmt::format("thermal: near_range_m must be 0..10 m and hole_px 4..256 pixels, got {} and "
                    "{}",
                    o.near_range_m(), o.hole_px()));
  }
  return IsKnown(o.lens()) ? ValidateLens(o) : OkStatus();
}

ConditionLimits::ConditionLimits(const ThermalOptions& o)
    : distance_min_m(static_cast<float>(o.distance_min_m())),
      distance_good_m(static_cast<float>(o.distance_good_m())),
      distance_max_m(static_cast<float>(o.distance_max_m())),
      cosine_min_angle(CosineOfDegrees(o.angle_min_deg())),
      cosine_good_angle(CosineOfDegrees(o.angle_good_deg())),
      cosine_max_angle(CosineOfDegrees(o.angle_max_deg())) {
  if (!IsKnown(o.lens())) return;
  const DepthOfField sharp = SharpDistances(o.lens());
  distance_min_m = std::max(distance_min_m, static_cast<float>(sharp.near_m));
  distance_max_m = std::min(distance_max_m, static_cast<float>(sharp.far_m));
  distance_good_m = std::min(distance_good_m, distance_max_m);
}

ConditionClass ConditionLimits::ClassifyDistance(float d) const {
  if (!(d >= distance_min_m && d <= distance_max_m)) return ConditionClass::kBad;
  return d <= distance_good_m ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

ConditionClass ConditionLimits::ClassifyAngle(float cosine) const {
  if (!(cosine <= cosine_min_angle && cosine >= cosine_max_angle)) return ConditionClass::kBad;
  return cosine >= cosine_good_angle ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle,
                         ConditionClass new_motion, ThermalVoxel old) {
  const auto valid = [](ConditionClass distance, ConditionClass angle) {
    return distance != ConditionClass::kBad && angle != ConditionClass::kBad;
  };
  if (new_motion == ConditionClass::kBad) return false;
  if (!old.measured() || !valid(old.distance_class(), old.angle_class())) return true;
  if (!valid(new_distance, new_angle)) return false;
  if (new_distance != old.distance_class()) return Rank(new_distance) < Rank(old.distance_class());
  if (new_angle != old.angle_class()) return Rank(new_angle) < Rank(old.angle_class());
  return Rank(new_motion) <= Rank(old.motion_class());
}

}  // namespace isotherm
