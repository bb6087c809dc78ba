#include "ground/renderer/view_maps.h"

#include <algorithm>
#include <cmath>

#include "common/concurrency/thread_pool.h"
#include "ground/thermal/condition_record.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {
namespace {

void SamplePixel(const SurfaceMaps& maps, const Eigen::Vector3d& p_map_viewer,
                 const TsdfVolume& tsdf, const ThermalVolume& thermal, int x, int y,
                 ViewMaps& view) {
  const Eigen::Vector3d p_map(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
  const Eigen::Vector3d n_map(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
  const Eigen::Vector3d ray = p_map - p_map_viewer;
  const double distance_m = ray.norm();
  const double cosine = std::abs(ray.dot(n_map)) / (distance_m * n_map.norm());
  view.celsius.At(x, y) = NAN;
  view.distance_class.At(x, y) = kNeverMeasured;
  view.angle_class.At(x, y) = kNeverMeasured;
  view.motion_class.At(x, y) = kNeverMeasured;
  view.disagreement_class.At(x, y) = kNeverMeasured;
  view.cos_view.At(x, y) = NAN;
  view.distance_m.At(x, y) = NAN;
  // Pixels without a surface have NaN vertices.
  if (!std::isfinite(cosine)) return;
  view.cos_view.At(x, y) = static_cast<float>(std::min(cosine, 1.0));
  view.distance_m.At(x, y) = static_cast<float>(distance_m);
  const ThermalVoxel voxel = ThermalVoxelAt(tsdf, thermal, p_map);
  if (!voxel.assessed()) return;
  view.celsius.At(x, y) = voxel.celsius();
  view.distance_class.At(x, y) = static_cast<std::uint8_t>(voxel.distance_class());
  view.angle_class.At(x, y) = static_cast<std::uint8_t>(voxel.angle_class());
  view.motion_class.At(x, y) = static_cast<std::uint8_t>(voxel.motion_class());
  view.disagreement_class.At(x, y) = static_cast<std::uint8_t>(voxel.disagreement_class());
}

}  // namespace

void ViewMaps::Resize(int width, int height) {
  celsius.Resize(width, height);
  distance_class.Resize(width, height);
  angle_class.Resize(width, height);
  motion_class.Resize(width, height);
  disagreement_class.Resize(width, height);
  cos_view.Resize(width, height);
  distance_m.Resize(width, height);
}

MeasurementQuality QualityAt(const ViewMaps& view, int x, int y) {
  return QualityOf(view.distance_class.At(x, y), view.angle_class.At(x, y),
                   view.motion_class.At(x, y));
}

void SampleView(const SurfaceMaps& maps, const Eigen::Vector3d& p_map_viewer,
                const TsdfVolume& tsdf, const ThermalVolume& thermal, ThreadPool& threads,
                ViewMaps& view) {
  view.Resize(maps.width(), maps.height());
  threads.ParallelFor(maps.height(), [&](int y) {
    for (int x = 0; x < maps.width(); ++x) {
      SamplePixel(maps, p_map_viewer, tsdf, thermal, x, y, view);
    }
  });
}

void SampleRecords(const SurfaceMaps& maps, const TsdfVolume& tsdf, const ThermalVolume& thermal,
                   ThreadPool& threads, ViewMaps& view) {
  view.nuc_age_s.Resize(maps.width(), maps.height());
  view.sigma_k.Resize(maps.width(), maps.height());
  view.measured_angle_deg.Resize(maps.width(), maps.height());
  threads.ParallelFor(maps.height(), [&](int y) {
    for (int x = 0; x < maps.width(); ++x) {
      view.nuc_age_s.At(x, y) = view.sigma_k.At(x, y) = view.measured_angle_deg.At(x, y) = NAN;
      if (std::isnan(view.celsius.At(x, y))) continue;
      const Eigen::Vector3d p_map(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      const PointMeasurement measurement = MeasurementAt(tsdf, thermal, p_map);
      if (measurement.conditions.empty()) continue;
      view.nuc_age_s.At(x, y) = measurement.conditions.age_s();
      view.sigma_k.At(x, y) = measurement.sigma_k;
      const Eigen::Vector3f normal(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
      view.measured_angle_deg.At(x, y) = AngleToNormalDeg(measurement.conditions.direction, normal);
    }
  });
}

}  // namespace isotherm
