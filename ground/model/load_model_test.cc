#include "ground/model/load_model.h"

#include <gtest/gtest.h>

#include "common/testing/temporary_directory.h"
#include "common/testing/volume_shapes.h"
#include "ground/model/model_file.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {
namespace {

class LoadModelTest : public ::testing::Test {
 protected:
  LoadModelTest() {
    VolumeOptions volume;
    volume.set_size_x_m(0.24);
    volume.set_size_y_m(0.24);
    volume.set_size_z_m(0.24);
    volume.mutable_expert()->set_min_x_m(-0.1);
    volume.set_voxel_size_m(0.005);
    const VoxelGrid grid = MakeVoxelGrid(volume).value();
    const std::int32_t max_blocks = MaxBlocks(volume, grid);
    tsdf_ = std::make_unique<TsdfVolume>(grid, 0.02, max_blocks);
    thermal_ = std::make_unique<ThermalVolume>(max_blocks);
    testing::FillPlane(*tsdf_, {0, 0, 0.12}, -Eigen::Vector3d::UnitZ());
    testing::FillThermal(*tsdf_, *thermal_, [](const Eigen::Vector3d& p) {
      return ThermalVoxel::Make(static_cast<float>(40.0 + 100.0 * p.x()), ConditionClass::kGood,
                                ConditionClass::kAcceptable);
    });
    rig_.depth = CameraModel{640, 480, 575.0, 576.0, 320.0, 240.0, 0.1, 0.2, 0.3, 0.4, 0.5};
    rig_.thermal = CameraModel{382, 288, 550.0, 551.0, 190.0, 144.0, -0.2};
    rig_.thermal->lens = LensKind::kFisheye;
    rig_.thermal->k4 = 0.004;
    rig_.T_thermal_depth = MakeTransform({0.07, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  }
  void Save() const {
    ASSERT_TRUE(
        SaveModel(Path(), *tsdf_, *thermal_, rig_, std::vector{*rig_.T_thermal_depth}).ok());
  }
  std::filesystem::path Path() const { return folder_.path() / "model.iso"; }

  const testing::TemporaryDirectory folder_;
  std::unique_ptr<TsdfVolume> tsdf_;
  std::unique_ptr<ThermalVolume> thermal_;
  Rig rig_;
};

TEST_F(LoadModelTest, BringsBackVolumesCamerasAndPoses) {
  Save();
  GroundOptions options;
  const Result<LoadedModel> model = LoadModel(Path(), options);
  ASSERT_TRUE(model) << model.error().message();
  EXPECT_EQ(options.volume().voxel_size_m(), 0.005);
  EXPECT_EQ(model->tsdf->block_count(), tsdf_->block_count());
  const Eigen::Vector3d p_world(0.03, 0.1, 0.12);
  EXPECT_EQ(ThermalVoxelAt(*model->tsdf, *model->thermal, p_world).bits,
            ThermalVoxelAt(*tsdf_, *thermal_, p_world).bits);
  EXPECT_EQ(model->rig.depth->k3, rig_.depth->k3);
  EXPECT_EQ(model->rig.depth->lens, LensKind::kBrownConrady);
  EXPECT_EQ(model->rig.thermal->fy, rig_.thermal->fy);
  EXPECT_EQ(model->rig.thermal->lens, LensKind::kFisheye);
  EXPECT_EQ(model->rig.thermal->k4, rig_.thermal->k4);
  EXPECT_TRUE(model->rig.T_thermal_depth->isApprox(*rig_.T_thermal_depth, 1e-12));
  ASSERT_EQ(model->known_poses.size(), 1U);
}

TEST_F(LoadModelTest, ARationalLensComesBack) {
  rig_.depth->lens = LensKind::kRational;
  rig_.depth->k4 = 0.6, rig_.depth->k5 = 0.7, rig_.depth->k6 = 0.8;
  Save();
  GroundOptions options;
  const Result<LoadedModel> model = LoadModel(Path(), options);
  ASSERT_TRUE(model) << model.error().message();
  const CameraModel& depth = *model->rig.depth;
  EXPECT_EQ(depth.lens, LensKind::kRational);
  EXPECT_EQ(std::vector({depth.k3, depth.k4, depth.k5, depth.k6}),
            std::vector({0.5, 0.6, 0.7, 0.8}));
}

TEST_F(LoadModelTest, AModelWithoutThermalCameraHasNone) {
  rig_.thermal.reset();
  const RigidTransform pose = *rig_.T_thermal_depth;
  rig_.T_thermal_depth.reset();
  ASSERT_TRUE(SaveModel(Path(), *tsdf_, *thermal_, rig_, std::vector{pose}).ok());
  GroundOptions options;
  const Result<LoadedModel> model = LoadModel(Path(), options);
  ASSERT_TRUE(model);
  EXPECT_FALSE(model->rig.thermal || model->rig.T_thermal_depth);
}

TEST_F(LoadModelTest, TooLittleMemoryIsSaidWithTheOption) {
  Save();
  GroundOptions options;
  options.mutable_volume()->mutable_expert()->set_max_memory_bytes(100'000);
  const Result<LoadedModel> model = LoadModel(Path(), options);
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().message().find("volume.expert.max_memory_bytes"), std::string::npos)
      << model.error().message();
}

TEST_F(LoadModelTest, NoFileIsNotFound) {
  GroundOptions options;
  EXPECT_EQ(LoadModel(Path(), options).error().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace isotherm
