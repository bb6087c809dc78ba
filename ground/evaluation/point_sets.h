#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// The points of a result (`cloud.ply`), in `world`.
struct MeasuredCloud {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;  ///< Or empty.
  std::vector<float> celsius;  ///< NaN = never measured. Empty: the file has no temperatures.
  std::vector<std::uint8_t>
      distance_class;  ///< 0 bad, 1 good, 2 acceptable, 255 never measured; or empty.
  std::vector<std::uint8_t> angle_class;   ///< The same.
  std::vector<std::uint8_t> motion_class;  ///< The same, 255 also = not checked.
  std::vector<float> measured_angle_deg;   ///< Emission angle of the measurement; NaN = not known,
                                           ///< or empty.
  std::vector<float> measured_distance_m;  ///< The same of its distance.
  std::vector<float> sigma_k;              ///< The same of the temperature's standard uncertainty.
};

/// Samples of the true surface, in the truth's world.
struct TruePoints {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;  ///< Unit length.
  std::vector<float> celsius;            ///< True temperature; empty: not in the file.
  std::vector<std::uint32_t>
      seen;  ///< How many sampled poses see the point; empty: not in the file.
  std::vector<std::uint32_t>
      primitive;  ///< Shape the point belongs to; all 0 if the file does not say.
};

/// Properties are found by their names: x y z, nx ny nz, scalar_temperature, scalar_distance_class,
/// scalar_angle_class, scalar_motion_class, scalar_measured_angle, scalar_measured_distance,
/// scalar_temperature_sigma.
Result<MeasuredCloud> ReadMeasuredCloud(const std::filesystem::path& path);
/// x y z nx ny nz, scalar_temperature, seen, primitive. Normals must have unit length.
Result<TruePoints> ReadTruePoints(const std::filesystem::path& path);

/// T_truth_world applied to each point.
std::vector<Eigen::Vector3f> Transformed(const RigidTransform& transform,
                                         const std::vector<Eigen::Vector3f>& points);

}  // namespace isotherm
