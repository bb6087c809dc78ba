// Golden metrics: import, reconstruct and evaluate on real and rendered data, with the tool's own
// functions.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/base/quantile.h"
#include "common/concurrency/thread_pool.h"
#include "common/dataset/import.h"
#include "common/options/override.h"
#include "common/options/text_proto.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/true_surface.h"
#include "ground/cli/model_export.h"
#include "ground/cli/simulation_files.h"
#include "ground/evaluation/ply_reader.h"
#include "ground/evaluation/result_evaluation.h"
#include "ground/evaluation/true_poses.h"
#include "ground/offline/reconstruct.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

class AccuracyTest : public testing::Test {
 protected:
  AccuracyTest() {
    std::string pattern = (fs::temp_directory_path() / "isotherm-accuracy-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    recording_ = folder_ / "scan.mcap";
    result_ = folder_ / "result";
  }
  ~AccuracyTest() override {
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  // False if the data are not there.
  bool Import(const std::string& name) {
    const char* set = std::getenv("ISOTHERM_DATA_DIR");
    return ImportFolder(fs::path(set != nullptr ? set : ISOTHERM_SOURCE_DIR "/../shared/data") /
                        name);
  }
  bool ImportFolder(const fs::path& folder) {
    data_ = folder;
    if (!fs::exists(data_)) return false;
    ImportRequest request;
    request.dataset.folder = data_;
    request.recording = recording_;
    const auto summary = ImportDataset(request);
    EXPECT_TRUE(summary) << summary.error().message();
    return summary.has_value();
  }

  ReconstructSummary Run(const GroundOptions& options, const fs::path& initial_pose_from) {
    ReconstructRequest request;
    request.recording = recording_;
    request.output_dir = result_;
    request.options = options;
    if (!initial_pose_from.empty()) {
      const auto pose =
          PoseAt(ReadTruePoses(initial_pose_from).value(), FirstDepthTime(recording_).value());
      EXPECT_TRUE(pose);
      request.initial_pose = *pose;
    }
    const auto summary = Reconstruct(request);
    EXPECT_TRUE(summary) << summary.error().message();
    return summary ? *summary : ReconstructSummary();
  }

  EvaluationReport Compare(EvaluationRequest request) {
    request.result_dir = result_;
    const auto report = Evaluate(request);
    EXPECT_TRUE(report) << report.error().message();
    if (!report) return {};
    std::puts(ToText(*report).c_str());
    return *report;
  }

  /// The rendered furnace door stands around the origin.
  static GroundOptions FurnaceDoorOptions() {
    GroundOptions options;
    VolumeExpertOptions& volume = *options.mutable_volume()->mutable_expert();
    volume.set_min_x_m(-0.48);
    volume.set_min_y_m(-0.48);
    volume.set_min_z_m(-0.48);
    return options;
  }
  EvaluationReport CompareWithFurnaceDoor() {
    EvaluationRequest request;
    request.groundtruth = data_ / "groundtruth.txt";
    request.surface = data_ / "surface.ply";
    request.emissivity = 0.96;
    return Compare(request);
  }

  fs::path folder_, recording_, result_, data_;
};

TEST_F(AccuracyTest, RenderedFurnaceDoorWithTruth) {
  if (!Import("furnace_dev")) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
  GroundOptions options = FurnaceDoorOptions();
  const ReconstructSummary summary = Run(options, data_ / "groundtruth.txt");
  EXPECT_EQ(summary.tracked_frames, 300U);
  const EvaluationReport report = CompareWithFurnaceDoor();
  EXPECT_LE(report.trajectory.aligned_m.rms, 0.0010);
  ASSERT_TRUE(report.surface && report.temperature);
  EXPECT_LE(report.surface->distance_m.rms, 0.0008);
  EXPECT_GE(report.surface->completeness, 0.95);
  EXPECT_GT(report.temperature->good.all.magnitude.count, 20000U);
  EXPECT_LE(report.temperature->good.all.magnitude.median, 0.6);
}

// This excerpt comes with the tests: 3.2 s of the same scan, every second frame and pixel.
TEST_F(AccuracyTest, ExcerptOfTheRenderedFurnaceDoorWithTruth) {
  ASSERT_TRUE(ImportFolder(ISOTHERM_SOURCE_DIR "/tests/data/furnace_excerpt"));
  GroundOptions options = FurnaceDoorOptions();
  options.mutable_volume()->set_voxel_size_m(0.003);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.012);
  const ReconstructSummary summary = Run(options, data_ / "groundtruth.txt");
  EXPECT_EQ(summary.tracked_frames, 49U);
  const EvaluationReport report = CompareWithFurnaceDoor();
  EXPECT_LE(report.trajectory.aligned_m.rms, 0.0010);
  ASSERT_TRUE(report.surface && report.temperature);
  EXPECT_LE(report.surface->distance_m.rms, 0.0010);
  EXPECT_GE(report.surface->completeness, 0.55) << "in 3.2 s few frames are integrated";
  EXPECT_GT(report.temperature->good.all.magnitude.count, 10000U);
  EXPECT_LE(report.temperature->good.all.magnitude.median, 0.6);
}

TEST_F(AccuracyTest, RealKinectRoom) {
  if (!Import("kinect_kitchen")) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
  GroundOptions options;
  for (const char* set : {"volume.size_x_m=4", "volume.size_y_m=3", "volume.size_z_m=4",
                          "volume.voxel_size_m=0.006", "tsdf.expert.truncation_distance_m=0.03"}) {
    ASSERT_TRUE(ApplyOverride(set, options).ok());
  }
  const ReconstructSummary summary = Run(options, {});
  EXPECT_EQ(summary.repeated_frames, 43U) << "images that come twice with the same content";
  EXPECT_GE(summary.tracked_frames + summary.repeated_frames, 475U);
  EvaluationRequest request;
  request.groundtruth = data_ / "groundtruth.txt";
  request.skip_repeats = recording_;
  EXPECT_LE(Compare(request).trajectory.aligned_m.rms, 0.05);
  request.first = 200;
  EXPECT_LE(Compare(request).trajectory.aligned_m.rms, 0.03);
}

// A patch of known emissivity and temperature: the calibrator's target (thesis table C.1), 0.95 and
// 100 °C, in surroundings of 23 °C and other parts of 0.96.
TEST_F(AccuracyTest, TemperatureInterpretedAfterwardsIsThatOfTheObject) {
  SimulationOptions simulation;
  const Status parsed = ParseTextProto(R"(
duration_s: 1.0
scene { scene: CALIBRATOR }
thermal { rate_hz: 20 }
shutter { interval_s: 0 first_s: 100 })",
                                       "simulation", simulation);
  ASSERT_TRUE(parsed.ok()) << parsed.message();
  ThreadPool pool(2);
  ASSERT_TRUE(RenderToFile(simulation, recording_, false, pool, [](double) {}).ok());
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(0.004);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
  Run(options, recording_);
  InterpretationOptions* interpretation = options.mutable_interpretation();
  interpretation->set_emissivity(0.96);
  InterpretedRegion* target = interpretation->add_region();
  *target->mutable_box() = ToOptions(
      Eigen::AlignedBox3d(Eigen::Vector3d(0.41, 0.48, 0.505), Eigen::Vector3d(0.57, 0.65, 0.523)));
  target->set_emissivity(0.95);
  const auto summary =
      ExportModel(result_ / "model.iso", options, Interpretation::Create(*interpretation).value(),
                  folder_ / "objects");
  ASSERT_TRUE(summary) << summary.error().message();
  EXPECT_EQ(summary->interpretation[1].unsolved(), 0U);

  const auto cloud = ReadPly(folder_ / "objects" / "cloud.ply");
  ASSERT_TRUE(cloud) << cloud.error().message();
  const auto column = [&](const char* name) -> const std::vector<float>& {
    return *cloud->Find(name);
  };
  constexpr float kInnerRadius_m = 0.06F;  // Of 0.076: away from the rim.
  std::vector<double> object, apparent;
  for (std::size_t i = 0; i < cloud->count; ++i) {
    const float radius = std::hypot(column("x")[i] - 0.49F, column("y")[i] - 0.565F);
    const bool on_target = radius < kInnerRadius_m && std::abs(column("z")[i] - 0.514F) < 0.006F;
    if (!on_target || std::isnan(column("scalar_temperature")[i])) continue;
    object.push_back(column("scalar_temperature")[i]);
    apparent.push_back(column("apparent_temperature")[i]);
  }
  ASSERT_GT(object.size(), 300U);
  constexpr double kTrue_celsius = 99.95;  // Falls from 100 to 99.85 towards the rim.
  constexpr double kTolerance_k = 0.5;
  EXPECT_NEAR(TakeMedian(object), kTrue_celsius, kTolerance_k);
  EXPECT_LT(TakeMedian(apparent), kTrue_celsius - 2.0);  // Not interpreted it would be wrong.
}

// A phone's LiDAR: 256 x 192 pixels at 60 Hz, another depth unit. Nothing may depend on the usual
// camera.
TEST_F(AccuracyTest, SmallFastDepthCamera) {
  std::ofstream(folder_ / "rig.textproto") << R"(
depth { width: 256 height: 192 fx: 212 fy: 212 cx: 128.1 cy: 95.3 }
thermal { width: 160 height: 120 fx: 150 fy: 150 cx: 79 cy: 60 }
T_thermal_depth { tx: 0.02 ty: -0.01 tz: 0 qx: 0 qy: 0 qz: 0 qw: 1 })";
  SimulationOptions simulation;
  const Status parsed = ParseTextProto(R"(
duration_s: 1.5
scene { scene: CORNER_SPHERE }
depth {
  rate_hz: 60
  expert { depth_scale: 4000 disparity_noise_px: 0.03 disparity_step_px: 0.03125 }
}
thermal { rate_hz: 25 }
shutter { first_s: 0.6 duration_s: 0.2 })",
                                       "simulation", simulation);
  ASSERT_TRUE(parsed.ok()) << parsed.message();
  simulation.set_rig_file(folder_ / "rig.textproto");
  ThreadPool pool(2);
  ASSERT_TRUE(RenderToFile(simulation, recording_, false, pool, [](double) {}).ok());
  const fs::path surface = folder_ / "surface.ply";
  ASSERT_TRUE(WriteTrueSurface(simulation, surface).ok());
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(0.004);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
  const ReconstructSummary summary = Run(options, recording_);
  EXPECT_EQ(summary.tracked_frames, summary.depth_frames);
  EXPECT_NEAR(static_cast<double>(summary.depth_frames), 90.0, 2.0);
  EXPECT_GT(summary.fused_thermal_frames, 20U);
  EvaluationRequest request;
  request.groundtruth = recording_;
  request.surface = surface;
  request.emissivity = 0.96;
  const EvaluationReport report = Compare(request);
  EXPECT_LE(report.trajectory.aligned_m.rms, 0.0005);
  ASSERT_TRUE(report.surface && report.temperature);
  EXPECT_LE(report.surface->distance_m.median, 0.0003);
  EXPECT_GE(report.surface->completeness, 0.85);
  EXPECT_LE(report.temperature->any.all.magnitude.median, 0.3);
}

}  // namespace
}  // namespace isotherm
