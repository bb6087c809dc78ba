#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "common/base/units.h"
#include "common/testing/volume_shapes.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/thermal/testing/ball_and_wall.h"
#include "ground/thermal/thermal_fuser.h"

namespace isotherm {
namespace {

/// A plane in voxels of 1 mm, 0.45 m before both cameras, of which a thermal pixel covers 2.4 mm
/// across and more along the tilt.
class ObliqueSurfaceTest : public ::testing::TestWithParam<double> {
 protected:
  static constexpr double kVoxel_m = 0.001;

  ObliqueSurfaceTest() {
    VolumeOptions volume;
    volume.set_size_x_m(0.16);
    volume.set_size_y_m(0.08);
    volume.set_size_z_m(0.24);
    volume.set_voxel_size_m(kVoxel_m);
    const VoxelGrid grid = MakeVoxelGrid(volume).value();
    const std::int32_t max_blocks = MaxBlocks(volume, grid);
    tsdf_ = std::make_unique<TsdfVolume>(grid, 0.004, max_blocks);
    thermal_ = std::make_unique<ThermalVolume>(max_blocks);
    testing::FillVolume(*tsdf_, [this](const Eigen::Vector3d& p) { return Distance(p); });
  }

  double Distance(const Eigen::Vector3d& p) const { return normal_.dot(p - kMiddle); }

  double tilt_rad_ = GetParam() * kRadPerDeg;
  Eigen::Vector3d normal_{std::sin(tilt_rad_), 0.0, -std::cos(tilt_rad_)};
  inline static const Eigen::Vector3d kMiddle{0.08, 0.04, 0.12};
  RigidTransform T_map_camera_ =
      MakeTransform(kMiddle - Eigen::Vector3d(0.0, 0.0, 0.45), Eigen::Quaterniond::Identity());
  std::unique_ptr<TsdfVolume> tsdf_;
  std::unique_ptr<ThermalVolume> thermal_;
};

TEST_P(ObliqueSurfaceTest, EverySurfaceVoxelInViewGetsATemperature) {
  const CameraModel camera = testing::ThermalCameraModel();
  ThermalFrame frame;
  frame.valid = true;
  frame.temperature_raw = Image<std::uint16_t>(camera.width, camera.height, 32'315);
  ThreadPool pool(2);
  ThermalOptions options;
  options.mutable_angle()->set_max_deg(60.0);  // The largest tilt, and what the view adds to it.
  ThermalFuser(options, camera, ThermalSensorModel(), 0.0F)
      .Fuse({frame, T_map_camera_, testing::SmallDepthCamera(), T_map_camera_}, {}, *tsdf_, pool,
            *thermal_);
  int on_surface = 0, measured = 0, away = 0;
  for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
    testing::ForEachVoxel(std::as_const(*thermal_).voxels(block), tsdf_->grid(),
                          tsdf_->block_coordinates(block),
                          [&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
                            const double off_m = std::abs(Distance(p));
                            // Where no pixel is at the volume's border, and no angle beyond
                            // thermal.angle.max_deg.
                            const Eigen::Vector3d beside = p - kMiddle;
                            if (std::abs(beside.x()) > 0.06 || std::abs(beside.y()) > 0.03 ||
                                std::abs(beside.z()) > 0.1) {
                              return;
                            }
                            away += voxel.measured() && off_m > 1.6 * kVoxel_m ? 1 : 0;
                            if (off_m > 0.5 * kVoxel_m) return;
                            ++on_surface;
                            measured += voxel.measured() ? 1 : 0;
                          });
  }
  const double fraction = static_cast<double>(measured) / on_surface;
  std::printf("tilted by %.0f degrees: %.1f %% of %d surface voxels\n", GetParam(),
              100.0 * fraction, on_surface);
  EXPECT_GT(on_surface, 5000);
  EXPECT_GT(fraction, 0.99);
  EXPECT_EQ(away, 0) << "beyond vertex_distance_vox";
}

INSTANTIATE_TEST_SUITE_P(Tilts, ObliqueSurfaceTest, ::testing::Values(0.0, 30.0, 50.0));

}  // namespace
}  // namespace isotherm
