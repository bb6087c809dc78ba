#include "ground/feedback/view_smear.h"

#include <cmath>
#include <limits>
#include <optional>

#include "common/geometry/rectified_camera.h"

namespace isotherm {

Image<float> SmearInView(const SurfaceMaps& maps, const RigidTransform& T_map_thermal,
                         const CameraMotion& motion, const CameraModel& thermal,
                         const ThermalSensorModel& sensor) {
  Image<float> smear_px(maps.width(), maps.height(), std::numeric_limits<float>::quiet_NaN());
  const RigidTransform T_thermal_map = T_map_thermal.inverse();
  const double middle_row = 0.5 * (thermal.height - 1);
  for (int y = 0; y < maps.height(); ++y) {
    for (int x = 0; x < maps.width(); ++x) {
      const Eigen::Vector3d p_map(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      const Eigen::Vector3d p_thermal = T_thermal_map * p_map;
      if (!(p_thermal.z() > 0.0)) continue;  // Nor if it is NaN.
      const Eigen::Vector2d xy = p_thermal.head<2>() / p_thermal.z();
      const std::optional<Eigen::Vector2d> pixel = ProjectIntoImage(thermal, xy);
      if (!pixel) continue;
      const double smear_s =
          sensor.time_constant_s + sensor.row_readout_s * std::abs(pixel->y() - middle_row);
      const Eigen::Vector2d speed = ImageVelocity(motion, xy, p_thermal.z());
      smear_px.At(x, y) =
          static_cast<float>(smear_s * std::hypot(thermal.fx * speed.x(), thermal.fy * speed.y()));
    }
  }
  return smear_px;
}

}  // namespace isotherm
