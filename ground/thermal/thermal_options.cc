#include "ground/thermal/thermal_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "common/base/check.h"
#include "common/options/nearest_name.h"
#include "common/radiometry/materials.h"
#include "ground/limits/angle_limits.h"
#include "ground/limits/distance_limits.h"

namespace isotherm {
namespace {

/// Nothing if the lens is not known.
std::optional<DepthOfField> SharpDistances(const ThermalSensorModel& sensor) {
  if (!sensor.lens || !sensor.pixel_pitch_m) return std::nullopt;
  return ComputeDepthOfField(sensor.lens->focal_length_m, sensor.lens->f_number,
                             *sensor.pixel_pitch_m, sensor.lens->focus_m);
}

Status Validate(const ThermalDistanceOptions& o) {
  if (o.min_m() >= 0.0 && o.min_m() < o.good_m() && o.good_m() <= o.max_m()) return OkStatus();
  return InvalidArgument(
      fmt::format("thermal.distance: need 0 <= min_m < good_m <= max_m, got {} m, {} m, {} m",
                  o.min_m(), o.good_m(), o.max_m()));
}

Status CheckMaterial(const std::string& name) {
  if (FindOpticalMaterial(name) != nullptr) return OkStatus();
  std::vector<std::string> names;
  for (const OpticalMaterial& known : OpticalMaterials()) names.emplace_back(known.name);
  return InvalidArgument(
      fmt::format("thermal.material: there is no material '{}'.{} Known are {}; `isotherm limits "
                  "--n` finds the limits of others, for thermal.angle",
                  name, DidYouMean(name, names), JoinNames(names)));
}

/// The angles, of which the material has set what `options` does not.
Status ValidateAngles(const ThermalOptions& options) {
  const ThermalAngleOptions o = WithAnglesOfMaterial(options).angle();
  if (o.min_deg() >= 0.0 && o.min_deg() < o.good_deg() && o.good_deg() <= o.max_deg() &&
      o.max_deg() <= 90.0) {
    return OkStatus();
  }
  const auto value = [&](bool is_set, double degrees) {
    return fmt::format("{:g}{}", degrees, is_set ? "" : " (of " + options.material() + ")");
  };
  const ThermalAngleOptions& given = options.angle();
  return InvalidArgument(fmt::format(
      "thermal.angle: need 0 <= min_deg < good_deg <= max_deg <= 90, got {}, {}, {} degrees",
      value(given.has_min_deg(), o.min_deg()), value(given.has_good_deg(), o.good_deg()),
      value(given.has_max_deg(), o.max_deg())));
}

Status Validate(const ThermalOcclusionOptions& o) {
  constexpr const char* kGroup = "thermal.expert.occlusion";
  if (!(o.parallax_tolerance_m() > 0.0)) {
    return InvalidArgument(fmt::format("{}.parallax_tolerance_m must be positive, got {} m", kGroup,
                                       o.parallax_tolerance_m()));
  }
  if (o.edge_margin_px() < 0 || o.edge_margin_px() > 16) {
    return InvalidArgument(
        fmt::format("{}.edge_margin_px must be 0..16 pixels, got {}", kGroup, o.edge_margin_px()));
  }
  if (o.visibility_halvings() != 0 && o.visibility_halvings() != 1) {
    return InvalidArgument(fmt::format("{}.visibility_halvings must be 0 or 1, got {}", kGroup,
                                       o.visibility_halvings()));
  }
  if (o.hole_px() < 4 || o.hole_px() > 256) {
    return InvalidArgument(
        fmt::format("{}.hole_px must be 4..256 pixels, got {}", kGroup, o.hole_px()));
  }
  return OkStatus();
}

Status Validate(const ThermalMotionOptions& o) {
  if (!(o.smear_good_px() > 0.0 && o.smear_good_px() <= o.smear_max_px())) {
    return InvalidArgument(fmt::format(
        "thermal.expert.motion: need 0 < smear_good_px <= smear_max_px, got {} px and {} px",
        o.smear_good_px(), o.smear_max_px()));
  }
  const auto is_acceleration = [](double a) { return a >= 0.0 && a <= 1000.0; };
  if (!(is_acceleration(o.max_acceleration_m_s2()) &&
        is_acceleration(o.max_angular_acceleration_rad_s2()))) {
    return InvalidArgument(
        fmt::format("thermal.expert.motion: max_acceleration_m_s2 and "
                    "max_angular_acceleration_rad_s2 must be 0..1000, got {} m/s2 and {} rad/s2",
                    o.max_acceleration_m_s2(), o.max_angular_acceleration_rad_s2()));
  }
  return OkStatus();
}

Status Validate(const ThermalDisagreementOptions& o) {
  if (o.noise_k() >= 0.0 && o.good_k() > 0.0 && o.good_k() <= o.max_k()) return OkStatus();
  return InvalidArgument(
      fmt::format("thermal.expert.disagreement: need noise_k >= 0 and 0 < good_k <= max_k, got {}, "
                  "{} and {} K",
                  o.noise_k(), o.good_k(), o.max_k()));
}

Status Validate(const ThermalExpertOptions& o) {
  if (!(o.vertex_distance_vox() > 0.0 && o.max_depth_gap_s() >= 0.0 &&
        o.max_depth_gap_s() <= 10.0)) {
    return InvalidArgument(
        "thermal.expert: vertex_distance_vox must be positive, max_depth_gap_s 0..10 s");
  }
  if (!(o.max_time_sigma_s() > 0.0)) {
    return InvalidArgument(fmt::format("thermal.expert.max_time_sigma_s must be positive, got {} s",
                                       o.max_time_sigma_s()));
  }
  if (!(o.max_registration_px() > 0.0)) {
    return InvalidArgument(fmt::format(
        "thermal.expert.max_registration_px must be positive, got {} px", o.max_registration_px()));
  }
  if (!(o.max_gradient_error_k() >= 0.0 && o.max_footprint_m() >= 0.0)) {
    return InvalidArgument(
        fmt::format("thermal.expert: max_gradient_error_k and max_footprint_m must not be "
                    "negative, got {} K and {} m",
                    o.max_gradient_error_k(), o.max_footprint_m()));
  }
  ISOTHERM_RETURN_IF_ERROR(Validate(o.occlusion()));
  ISOTHERM_RETURN_IF_ERROR(Validate(o.motion()));
  return Validate(o.disagreement());
}

}  // namespace

Status Validate(const ThermalOptions& o) {
  ISOTHERM_RETURN_IF_ERROR(Validate(o.distance()));
  ISOTHERM_RETURN_IF_ERROR(CheckMaterial(o.material()));
  ISOTHERM_RETURN_IF_ERROR(ValidateAngles(o));
  return Validate(o.expert());
}

Status CheckSharpness(const ThermalOptions& o, const ThermalSensorModel& sensor) {
  const std::optional<DepthOfField> sharp = SharpDistances(sensor);
  // The two ranges of distances overlap.
  if (!sharp || (sharp->near_m < o.distance().max_m() && sharp->far_m > o.distance().min_m()))
    return OkStatus();
  return InvalidArgument(
      fmt::format("the lens of the rig file is sharp from {:.3f} to {:.3f} m only, outside "
                  "thermal.distance.min_m {} m to max_m {} m: nothing could be measured",
                  sharp->near_m, sharp->far_m, o.distance().min_m(), o.distance().max_m()));
}

ThermalOptions WithAnglesOfMaterial(const ThermalOptions& o) {
  ThermalOptions complete = o;
  // Computing a material's limits takes a while, and is not needed then.
  if (o.angle().has_min_deg() && o.angle().has_good_deg() && o.angle().has_max_deg())
    return complete;
  const OpticalMaterial* material = FindOpticalMaterial(o.material());
  CHECK(material != nullptr);
  const AngleLimitsInDegrees limits = AngleLimitsOf(*material);
  ThermalAngleOptions& angle = *complete.mutable_angle();
  if (!angle.has_min_deg()) angle.set_min_deg(limits.min_deg);
  if (!angle.has_good_deg()) angle.set_good_deg(limits.good_deg);
  if (!angle.has_max_deg()) angle.set_max_deg(limits.max_deg);
  return complete;
}

ThermalOptions CompleteLimits(const ThermalOptions& o, const ThermalSensorModel& sensor) {
  ThermalOptions complete = WithAnglesOfMaterial(o);
  const std::optional<DepthOfField> sharp = SharpDistances(sensor);
  if (!sharp) return complete;
  ThermalDistanceOptions& distance = *complete.mutable_distance();
  distance.set_min_m(std::max(distance.min_m(), sharp->near_m));
  distance.set_max_m(std::min(distance.max_m(), sharp->far_m));
  // A lens that ends before good_m leaves nothing but good distances.
  distance.set_good_m(std::min(distance.good_m(), distance.max_m()));
  return complete;
}

ReadingCorrections CorrectionsOf(const ThermalOptions& options, const ThermalSensorModel& sensor) {
  ReadingCorrections corrections{.radiometric_correction = sensor.radiometric_correction,
                                 .housing_drift = sensor.housing_drift};
  if (options.expert().correct_scene_influence())
    corrections.scene_influence = sensor.scene_influence;
  return corrections;
}

}  // namespace isotherm
