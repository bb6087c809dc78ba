#include "ground/offline/held_out_views.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/check.h"
#include "common/geometry/map_pose.h"
#include "ground/thermal/condition_record.h"
#include "ground/thermal/uncertainty_budget.h"

namespace isotherm {
HeldOutViews::HeldOutViews(const ScanModel& scan, const HeldOutOptions& options)
    : scan_(scan), options_(options), rectifier_(*scan.rig.thermal, options.corrections) {}

std::optional<RigidTransform> HeldOutViews::PoseAt(CaptureTime time) const {
  const std::vector<StampedPose>& poses = scan_.trajectory.poses();
  const auto after = std::ranges::lower_bound(poses, time, {}, &StampedPose::time);
  if (after == poses.end()) return std::nullopt;
  // Also where the gap before it is too long.
  if (after->time == time) return after->T_world_depth;
  if (after == poses.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  const double interval_s = ToSeconds(after->time - before.time);
  if (interval_s > options_.max_gap_s) return std::nullopt;
  return Interpolate(before.T_world_depth, after->T_world_depth,
                     ToSeconds(time - before.time) / interval_s);
}

void HeldOutViews::Compare(const ThermalFrame& frame, const NucAge& nuc) {
  CHECK(frame.valid);
  const CameraModel& camera = *scan_.rig.thermal;
  if (frame.temperature_raw.width() != camera.width ||
      frame.temperature_raw.height() != camera.height) {
    ++report_.wrong_size;
    return;
  }
  const auto T_world_depth = PoseAt(frame.header.capture_time);
  if (!T_world_depth) {
    ++report_.without_pose;
    return;
  }
  ++report_.frames;
  const RigidTransform T_world_thermal = *T_world_depth * scan_.rig.T_thermal_depth->inverse();
  rectifier_.Rectify(frame.temperature_raw,
                     WithoutDrift(frame.scale, options_.corrections.housing_drift, nuc),
                     /*apron=*/0, scan_.pool, celsius_);
  raycaster_.Cast(scan_.tsdf(), rectifier_.ideal_camera(), InFirstMap(T_world_thermal),
                  options_.min_weight, scan_.pool, maps_);
  SampleView(maps_, T_world_thermal.translation(), scan_.tsdf(), scan_.thermal(), scan_.pool,
             view_);
  for (int y = 0; y < celsius_.height(); ++y) {
    for (int x = 0; x < celsius_.width(); ++x) {
      const float shown = celsius_.At(x, y);
      if (!std::isnan(shown)) ComparePixel(x, y, static_cast<double>(shown));
    }
  }
}

double HeldOutViews::Predict(int x, int y, const PointMeasurement& measurement) const {
  const auto celsius = static_cast<double>(measurement.voxel.celsius());
  if (!options_.surface || measurement.conditions.empty()) return celsius;
  const Eigen::Vector3f n_world(maps_.nx.At(x, y), maps_.ny.At(x, y), maps_.nz.At(x, y));
  const float measured =
      // Either side: the recorded direction is coded to a degree and may just miss the surface's
      // front.
      std::abs(n_world.normalized().dot(DecodeDirection(measurement.conditions.direction)));
  const auto angle_rad = [](float cosine) {
    return std::acos(std::min(static_cast<double>(cosine), 1.0));
  };
  return ApparentAtAngle(band_, *options_.surface, celsius, angle_rad(measured),
                         angle_rad(view_.cos_view.At(x, y)));
}

void HeldOutViews::ComparePixel(int x, int y, double shown_celsius) {
  ++report_.pixels;
  if (!view_.HasSurface(x, y)) return;
  ++report_.on_surface;
  if (std::isnan(view_.celsius.At(x, y))) return;
  const Eigen::Vector3d p_world(maps_.vx.At(x, y), maps_.vy.At(x, y), maps_.vz.At(x, y));
  const PointMeasurement measurement = MeasurementAt(scan_.tsdf(), scan_.thermal(), p_world);
  const double predicted_celsius = Predict(x, y, measurement);
  if (std::isnan(predicted_celsius)) return;
  ++report_.assigned;
  const double error_k = shown_celsius - predicted_celsius;
  report_.sum_k += error_k;
  report_.sum_of_magnitudes_k += std::abs(error_k);
  const auto model_k = static_cast<double>(measurement.sigma_k);
  if (std::isnan(model_k)) return;
  // The frame that is predicted has noise of its own.
  const double noise_k =
      CameraUncertainty().netd_k * std::sqrt(static_cast<double>(rectifier_.noise_gain().At(x, y)));
  report_.coverage.Add(error_k / std::hypot(model_k, noise_k));
}

}  // namespace isotherm
