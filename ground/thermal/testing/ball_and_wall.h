#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "common/testing/volume_shapes.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/thermal/thermal_fuser.h"

namespace isotherm::testing {

inline CameraModel ThermalCameraModel() {
  CameraModel camera;
  camera.width = 191;
  camera.height = 144;
  camera.fx = camera.fy = 186.0;
  camera.cx = 95.0;
  camera.cy = 71.5;
  return camera;
}

/// A hot ball before a cold wall, seen by a depth camera and by a thermal camera beside it.
class BallAndWallTest : public ::testing::Test {
 protected:
  static constexpr float kHot = 100.0F;
  static constexpr float kCold = 20.0F;

  BallAndWallTest() {
    VolumeOptions volume;
    for (auto set : {&VolumeOptions::set_size_x_m, &VolumeOptions::set_size_y_m,
                     &VolumeOptions::set_size_z_m}) {
      (volume.*set)(0.64);
    }
    volume.set_voxel_size_m(0.004);
    const VoxelGrid grid = MakeVoxelGrid(volume).value();
    const std::int32_t max_blocks = MaxBlocks(volume, grid);
    tsdf_ = std::make_unique<TsdfVolume>(grid, 0.016, max_blocks);
    thermal_ = std::make_unique<ThermalVolume>(max_blocks);
    FillVolume(*tsdf_, Scene);
  }

  static double Ball(const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(0.32, 0.32, 0.40)).norm() - 0.06;
  }
  static double Scene(const Eigen::Vector3d& p) { return std::min(Ball(p), 0.60 - p.z()); }

  ThermalFrame TakeFrame(const RigidTransform& T_map_thermal) const {
    ThermalFrame frame;
    frame.valid = true;
    frame.temperature_raw = Image<std::uint16_t>(thermal_camera_.width, thermal_camera_.height);
    for (int v = 0; v < thermal_camera_.height; ++v) {
      for (int u = 0; u < thermal_camera_.width; ++u) {
        const double z = TraceDepth(Scene, thermal_camera_, T_map_thermal, u, v);
        const Eigen::Vector2d xy = Unproject(thermal_camera_, {u, v});
        const Eigen::Vector3d p = T_map_thermal * Eigen::Vector3d(xy.x() * z, xy.y() * z, z);
        const float celsius = Ball(p) < 1e-4 ? kHot : kCold;
        frame.temperature_raw.At(u, v) =
            static_cast<std::uint16_t>(std::lround((celsius + 273.15) * 100.0));
      }
    }
    return frame;
  }

  /// Calls `visit(voxel, place)` for voxels with a temperature, or at least classes.
  template <typename Visit>
  void ForEachAssessed(const Visit& visit) const {
    for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
      ForEachVoxel(std::as_const(*thermal_).voxels(block), tsdf_->grid(),
                   tsdf_->block_coordinates(block),
                   [&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
                     if (voxel.assessed()) visit(voxel, p);
                   });
    }
  }

  /// Counts the voxels that took a temperature, and those that took the other surface's.
  struct Outcome {
    int assigned = 0;
    int hot_on_wall = 0;
    int cold_on_ball = 0;
  };
  FusionReport FuseFrame(const ThermalOptions& options, const ThermalFrame& frame,
                         const CaptureConditions& capture = {}) {
    ThermalFuser fuser(options, thermal_camera_, sensor_, 0.0F);
    return fuser.Fuse({frame, T_map_thermal_, depth_camera_, T_map_depth_}, capture, *tsdf_, pool_,
                      *thermal_);
  }
  Outcome Fuse(const ThermalOptions& options) {
    FuseFrame(options, TakeFrame(T_map_thermal_));
    Outcome outcome;
    for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
      ForEachVoxel(thermal_->voxels(block), tsdf_->grid(), tsdf_->block_coordinates(block),
                   [&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
                     if (!voxel.measured()) return;
                     ++outcome.assigned;
                     const bool on_wall = p.z() > 0.58;
                     if (on_wall && voxel.celsius() > 25.0F) ++outcome.hot_on_wall;
                     if (!on_wall && voxel.celsius() < 25.0F) ++outcome.cold_on_ball;
                   });
    }
    return outcome;
  }

  CameraModel depth_camera_ = SmallDepthCamera();
  CameraModel thermal_camera_ = ThermalCameraModel();
  ThermalSensorModel sensor_;
  RigidTransform T_map_depth_ = MakeTransform({0.32, 0.32, 0.0}, Eigen::Quaterniond::Identity());
  RigidTransform T_map_thermal_ = MakeTransform({0.40, 0.36, 0.0}, Eigen::Quaterniond::Identity());
  ThreadPool pool_{2};
  std::unique_ptr<TsdfVolume> tsdf_;
  std::unique_ptr<ThermalVolume> thermal_;
};

}  // namespace isotherm::testing
