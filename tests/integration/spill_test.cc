// A model that outgrows its memory is the same as one that does not have to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "common/testing/temporary_directory.h"
#include "ground/option_validation/validate_options.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/surface/testing/analytic_views.h"

namespace isotherm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Property;

constexpr double kPeriod = 0.24;  // Metres along x after which the wall repeats itself.
constexpr double kStep = 0.009;   // Metres per frame.
constexpr int kFramesOneWay = 100;

double Wall(const Eigen::Vector3d& p) {
  const double x = p.x() - kPeriod * std::round(p.x() / kPeriod);
  const double ball = Eigen::Vector3d(x - 0.03, p.y() - 0.05, p.z() - 0.64).norm() - 0.06;
  const double post = std::hypot(x + 0.08, p.z() - 0.63) - 0.025;
  const double ledge = std::hypot(p.y() + 0.12, p.z() - 0.64) - 0.03;
  return std::min({0.65 - p.z(), ball, post, ledge});
}

/// Returns what the camera sees after this many steps along the wall.
const DepthFrame& View(const CameraModel& camera, int step) {
  static std::map<int, DepthFrame> views;
  const auto [view, is_new] = views.try_emplace(step);
  if (is_new) {
    view->second = testing::RenderDepth(
        Wall, camera, MakeTransform({kStep * step, 0.0, 0.0}, Eigen::Quaterniond::Identity()));
  }
  return view->second;
}

/// Along the wall and back, with thermal frames.
std::unique_ptr<GroundPipeline> Scan(const GroundOptions& options) {
  Rig rig;
  rig.depth = testing::SmallDepthCamera();
  rig.thermal = rig.depth;
  rig.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  auto pipeline = GroundPipeline::Create(options, rig, RigidTransform::Identity());
  EXPECT_TRUE(pipeline.has_value());
  for (int i = 0; i < 2 * kFramesOneWay; ++i) {
    DepthFrame frame = View(*rig.depth, i < kFramesOneWay ? i : 2 * kFramesOneWay - i);
    frame.header.capture_time = CaptureTime(FromSeconds(100.0 + i / 30.0));
    auto thermal = std::make_shared<ThermalFrame>();
    thermal->header.capture_time = CaptureTime(FromSeconds(100.0 + (i - 0.5) / 30.0));
    thermal->temperature_raw =
        Image<std::uint16_t>(rig.thermal->width, rig.thermal->height, 32'315);  // 50 °C.
    thermal->valid = true;
    if (i > 0) (*pipeline)->ProcessThermal(thermal);
    (*pipeline)->ProcessDepth(frame);
  }
  return std::move(*pipeline);
}

TEST(SpillTest, AModelUnderALimitEqualsTheOneWithout) {
  GroundOptions options;
  VolumeOptions& volume = *options.mutable_volume();
  volume.set_size_x_m(2.4);
  volume.mutable_expert()->set_min_x_m(-0.6);
  volume.mutable_expert()->set_min_y_m(-0.48);
  volume.set_voxel_size_m(0.004);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
  options.set_threads(2);
  const auto kept_in_memory = Scan(options);
  const ScanModel whole = kept_in_memory->model();

  const testing::TemporaryDirectory folder;
  volume.set_spill_dir(folder.path().string());
  volume.mutable_expert()->set_max_memory_bytes(6'000'000);  // A good half of what the model takes.
  const auto limited = Scan(options);
  const ScanModel spilled = limited->model();

  EXPECT_GT(spilled.spiller.spilled(), 1000U);
  EXPECT_LT(spilled.spiller.resident_blocks(), whole.tsdf().block_count());
  EXPECT_EQ(spilled.tsdf().refused_blocks(), 0U);
  ASSERT_EQ(spilled.counts.depth_tracked, whole.counts.depth_tracked);
  ASSERT_EQ(spilled.tsdf().block_count(), whole.tsdf().block_count());
  for (std::int32_t block = 0; block < whole.tsdf().block_count(); ++block) {
    ASSERT_EQ(spilled.tsdf().block_coordinates(block), whole.tsdf().block_coordinates(block));
    for (std::size_t i = 0; i < kBlockVoxels; ++i) {
      ASSERT_EQ(spilled.tsdf().voxels(block)[i].bits, whole.tsdf().voxels(block)[i].bits);
      ASSERT_EQ(spilled.thermal().voxels(block)[i].bits, whole.thermal().voxels(block)[i].bits);
    }
  }
}

TEST(SpillTest, AFolderThatCannotTakeFilesIsNamed) {
  GroundOptions options;
  options.mutable_volume()->set_spill_dir("/does/not/exist");
  EXPECT_THAT(ValidateAll(options),
              ElementsAre(Property(&Status::message, HasSubstr("/does/not/exist"))));
  Rig rig;
  rig.depth = testing::SmallDepthCamera();
  const auto pipeline = GroundPipeline::Create(options, rig, std::nullopt);
  ASSERT_FALSE(pipeline.has_value());
  EXPECT_THAT(pipeline.error().message(), HasSubstr("/does/not/exist"));
}

}  // namespace
}  // namespace isotherm
