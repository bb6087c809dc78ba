#include "ground/experiment/model_check.h"

#include <algorithm>
#include <optional>

#include "common/base/quantile.h"
#include "common/base/sigma_coverage.h"
#include "ground/surface/surface_maps.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

std::optional<SurfacePoint> TruthAt(const Scene& scene, const CloudPoint& point) {
  // Three voxels of 2 mm: further away it is another surface, or none.
  constexpr double kReach_m = 0.006;
  const Eigen::Vector3d n_world = point.normal.cast<double>();
  const Eigen::Vector3d above = point.position_m.cast<double>() + kReach_m * n_world;
  const auto hit = scene.Intersect(above, -n_world);
  if (!hit || hit->distance > 2.0 * kReach_m) return std::nullopt;
  return hit->point;
}

}  // namespace

double Percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN()
                    : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

double MeasuredPercent(const std::vector<CheckedPoint>& points) {
  const auto measured = std::ranges::count_if(points, &CheckedPoint::measured);
  return Percent(static_cast<std::size_t>(measured), points.size());
}

std::vector<CheckedPoint> CheckModel(const Scene& scene, const BandRadiance& band,
                                     const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                     ThreadPool& pool) {
  SurfaceOptions options;
  // Also what was seen once: experiments count what is wrong in the model, not what an export
  // leaves out.
  options.min_weight = 1.0F;
  options.triangles = false;
  std::vector<CheckedPoint> checked;
  for (const CloudPoint& point : ExtractSurface(tsdf, thermal, options, pool).points) {
    const auto truth = TruthAt(scene, point);
    if (!truth) continue;
    const Material& material = scene.MaterialOf(truth->primitive);
    const SmoothSurface paint = {.normal_emissivity = material.normal_emissivity,
                                 .refractive_index = material.n,
                                 .reflected_celsius = scene.surround_celsius(),
                                 .extinction_coefficient = material.kappa};
    checked.push_back(
        {point, *truth,
         ApparentCelsius(band, truth->celsius, material.normal_emissivity,
                         scene.surround_celsius()),
         ExpectTemperature(band, paint, truth->celsius,
                           static_cast<double>(point.measured_angle_deg),
                           AngleSigmaDeg(point.normal, truth->n_world.cast<float>()))});
  }
  return checked;
}

double AssignmentCheck::WrongPercent() const { return Percent(wrong(), assigned); }

AssignmentCheck CheckAssignment(const std::vector<CheckedPoint>& points) {
  AssignmentCheck check;
  check.points = points.size();
  for (const CheckedPoint& point : points) {
    if (!point.measured()) continue;
    ++check.assigned;
    if (point.ErrorKelvin() > AssignmentCheck::kWrong_k) ++check.too_warm;
    if (point.ErrorKelvin() < -AssignmentCheck::kWrong_k) ++check.too_cold;
  }
  return check;
}

ErrorSummary SummarizeErrors(const std::vector<CheckedPoint>& points) {
  std::vector<double> errors_k;
  for (const CheckedPoint& point : points) {
    if (point.measured()) errors_k.push_back(std::abs(point.ErrorKelvin()));
  }
  ErrorSummary summary;
  summary.measured = errors_k.size();
  if (errors_k.empty()) return summary;
  const auto within_1k = std::ranges::count_if(errors_k, [](double e) { return e <= 1.0; });
  summary.within_1k_percent = Percent(static_cast<std::size_t>(within_1k), errors_k.size());
  summary.median_k = TakeQuantile(errors_k, 0.5);
  summary.p95_k = TakeQuantile(errors_k, 0.95);
  summary.p999_k = TakeQuantile(errors_k, 0.999);
  summary.largest_k = TakeQuantile(errors_k, 1.0);
  SigmaCoverage coverage;
  for (const CheckedPoint& point : points) {
    if (point.measured() && !std::isnan(point.point.sigma_k)) coverage.Add(point.NormalizedError());
  }
  summary.within_sigma_percent = 100.0 * coverage.within_68();
  summary.within_1_96_sigma_percent = 100.0 * coverage.within_95();
  return summary;
}

ViewMaps LookAtModel(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                     const CameraModel& camera, const RigidTransform& T_map_camera,
                     ThreadPool& pool) {
  constexpr float kMinWeight = 1.0F;
  SurfaceMaps maps;
  Raycaster().Cast(tsdf, camera, T_map_camera, kMinWeight, pool, maps);
  ViewMaps view;
  SampleView(maps, T_map_camera.translation(), tsdf, thermal, pool, view);
  return view;
}

ViewMaps LookAtModel(const ScanModel& model, const SimulatedScan& scan, CaptureTime time,
                     ThreadPool& pool) {
  return LookAtModel(model.tsdf(), model.thermal(), *scan.rig().depth,
                     InFirstMap(scan.PoseAt(time)), pool);
}

RendererOptions FixedScale(double low_celsius, double high_celsius) {
  RendererOptions options;
  options.set_scale(FIXED);
  options.set_scale_min_celsius(low_celsius);
  options.set_scale_max_celsius(high_celsius);
  return options;
}

}  // namespace isotherm
