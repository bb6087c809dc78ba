#pragma once

#include <cmath>
#include <functional>

#include "common/testing/volume_shapes.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm::testing {

inline constexpr double kPlateVoxel_m = 0.004;
/// The plane that the plates of PlateModel lie in is at this z, its front towards -z.
inline constexpr double kPlate_m = 0.0981;

/// A volume of 0.192 m with a wall across it, seen from -z, and what was measured on it.
class PlateModel {
 public:
  PlateModel() : tsdf(Grid(), 4.0 * kPlateVoxel_m, 216), thermal(216) {}

  /// `normal` is unit and points to the viewer.
  void AddPlane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    FillPlane(tsdf, point, normal);
  }
  /// Measures everything under good conditions; NaN = not measured.
  void Measure(const std::function<float(const Eigen::Vector3d&)>& celsius) {
    FillThermal(tsdf, thermal, [&](const Eigen::Vector3d& p) {
      const float value = celsius(p);
      return std::isnan(value) ? ThermalVoxel{}
                               : ThermalVoxel::Make(value, ConditionClass::kGood,
                                                    ConditionClass::kGood, ConditionClass::kGood);
    });
  }

  TsdfVolume tsdf;
  ThermalVolume thermal;

 private:
  static VoxelGrid Grid() {
    VoxelGrid grid;
    grid.voxel_size_m = kPlateVoxel_m;
    grid.blocks = GridIndex::Constant(6);
    return grid;
  }
};

}  // namespace isotherm::testing
