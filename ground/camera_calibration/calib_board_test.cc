// Calibrations from images that a program rendered which shares no code with this project, and from
// real ones.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "common/base/units.h"
#include "ground/camera_calibration/calibration_images.h"
#include "ground/camera_calibration/calibration_report.h"
#include "ground/camera_calibration/projection_map.h"
#include "ground/camera_calibration/target_calibration.h"
#include "ground/camera_calibration/transfer.h"

namespace isotherm {
namespace {

const auto kNoProgress = [](double) {};

class CalibBoardTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("ISOTHERM_DATA_DIR");
    if (data == nullptr || !std::filesystem::exists(std::filesystem::path(data) / Folder()))
      GTEST_SKIP() << "no " << Folder() << " in ISOTHERM_DATA_DIR";
    folder_ = std::filesystem::path(data) / Folder();
  }
  virtual const char* Folder() const { return "calib_board"; }

  Result<TargetCalibration> Calibrate(std::vector<CalibrationView> views,
                                      std::vector<std::string> names, const std::string& target) {
    CalibrationInput input;
    input.target = *ParseTarget(target);
    input.lenses.assign(names.size(), LensKind::kBrownConrady);
    input.camera_names = std::move(names);
    input.views = std::move(views);
    ThreadPool pool(2);
    Result<TargetCalibration> result = CalibrateWithTarget(input, pool, kNoProgress);
    if (!result) return result;
    for (const RefusedImage& refused : result->refused)
      std::printf("%s %s: %s\n", refused.camera.c_str(), refused.name.c_str(),
                  refused.reason.c_str());
    return result;
  }
  Result<TargetCalibration> CalibrateOne(CalibratedStream stream) {
    Result<ImageSeries> series = ReadImageFolder(folder_, {stream, {}}, kNoProgress);
    if (!series) return Err(series.error());
    return Calibrate(ViewsOf(std::move(*series)), {std::string(ToString(stream))}, "thesis-board");
  }

  /// As calibration.txt says.
  static BundleCamera TrueThermal() {
    return {LensKind::kBrownConrady,
            {371.4, 372.1, 205.5, 150.5, -0.439, 0.29, 0.000454, -0.000257, -0.114},
            RigidTransform::Identity()};
  }
  static BundleCamera TrueDepth() {
    return {LensKind::kBrownConrady, {567.7, 567.7, 321.3, 242.4}, RigidTransform::Identity()};
  }
  static RigidTransform TrueThermalFromDepth() {
    Eigen::Matrix3d rotation;
    rotation << 0.9999741077, 0.001684339786, 0.00699621451, -0.001745285833, 0.9999605064,
        0.008714338079, -0.006981260298, -0.008726322839, 0.9999375547;
    return MakeTransform({0.0485, 0.0533, 0.0115}, Eigen::Quaterniond(rotation));
  }

  static void Print(const char* what, const TargetCalibration& calibration, int camera,
                    const BundleCamera& truth) {
    const auto index = static_cast<std::size_t>(camera);
    const Eigen::Vector2i& size = calibration.sizes_px[index];
    const auto opencv = CalibrateWithOpenCv(calibration.target, calibration.detections[index], size,
                                            LensKind::kBrownConrady);
    const ProjectionMap ours = CompareProjections(truth, calibration.state.cameras[index], size);
    const ProjectionMap theirs = CompareProjections(
        truth, {LensKind::kBrownConrady, opencv->lens, RigidTransform::Identity()}, size);
    std::printf(
        "%s: %zu views, off the truth %.4f px rms, %.4f px at most in the inner 80 %% "
        "(OpenCV %.3f, %.3f)\n",
        what, calibration.view_names.size(), ours.Rms(true), ours.Max(true), theirs.Rms(true),
        theirs.Max(true));
  }

  std::filesystem::path folder_;
};

TEST_F(CalibBoardTest, ThermalProjectionIsThatOfTheRenderer) {
  const auto result = CalibrateOne(CalibratedStream::kThermal);
  ASSERT_TRUE(result.has_value()) << result.error().message();
  EXPECT_EQ(result->view_names.size(), 30U);
  Print("thermal", *result, 0, TrueThermal());
  const ProjectionMap off = CompareProjections(TrueThermal(), result->state.cameras[0], {382, 288});
  EXPECT_LE(off.Rms(true), 0.12);
  EXPECT_LE(off.Max(true), 0.5);
  const CalibrationReport report = MakeReport(*result, {"thermal"}, {.bootstrap_samples = 500});
  const double within = FractionWithin(off, report.cameras[0].sigmas, 2.0);
  std::printf(
      "  within two sigma: %.3f; uncertainty %.4f px, at most %.3f; halves differ by %.2f of what "
      "is expected\n",
      within, report.cameras[0].sigmas.Rms(true), report.cameras[0].sigmas.Max(false),
      report.cameras[0].cross_validation->Ratio());
  EXPECT_GE(within, 0.9);
}

TEST_F(CalibBoardTest, InfraredProjectionIsThatOfTheRenderer) {
  const auto result = CalibrateOne(CalibratedStream::kInfrared);
  ASSERT_TRUE(result.has_value()) << result.error().message();
  EXPECT_EQ(result->view_names.size(), 30U);
  Print("infrared", *result, 0, TrueDepth());
  const ProjectionMap off = CompareProjections(TrueDepth(), result->state.cameras[0], {640, 480});
  EXPECT_LE(off.Rms(true), 0.3);
  const CalibrationReport report = MakeReport(*result, {"depth"}, {.bootstrap_samples = 500});
  const double within = FractionWithin(off, report.cameras[0].sigmas, 2.0);
  std::printf("  within two sigma: %.3f\n", within);
  EXPECT_GE(within, 0.9);
}

TEST_F(CalibBoardTest, PoseBetweenTheCamerasIsThatOfTheRenderer) {
  Result<ImageSeries> infrared =
      ReadImageFolder(folder_, {CalibratedStream::kInfrared, {}}, kNoProgress);
  Result<ImageSeries> thermal =
      ReadImageFolder(folder_, {CalibratedStream::kThermal, {}}, kNoProgress);
  ASSERT_TRUE(infrared.has_value() && thermal.has_value());
  const auto result = Calibrate(PairViews(std::move(*infrared), std::move(*thermal)),
                                {"depth", "thermal"}, "thesis-board");
  ASSERT_TRUE(result.has_value()) << result.error().message();
  const RigidTransform pose = result->state.cameras[1].T_camera_rig;
  const double degrees = RotationAngle(pose, TrueThermalFromDepth()) / kRadPerDeg;
  const double mm = 1e3 * TranslationDistance(pose, TrueThermalFromDepth());
  BundleState truth = result->state;
  truth.cameras = {TrueDepth(), TrueThermal()};
  truth.cameras[1].T_camera_rig = TrueThermalFromDepth();
  for (const double depth_m : {0.4, 0.65, 0.9}) {
    ProjectionMap off = TransferPoints(truth, {640, 480}, {382, 288}, depth_m);
    const ProjectionMap ours = TransferPoints(result->state, {640, 480}, {382, 288}, depth_m);
    for (std::size_t i = 0; i < off.values_px.size(); ++i) off.values_px[i] -= ours.values_px[i];
    std::printf("  %.2f m away: lands %.4f px off\n", depth_m, off.Rms(true));
    EXPECT_LE(off.Rms(true), 0.15);
  }
  const PoseReport report = ReportPose(*result);
  std::printf("pose: %.4f degrees, %.3f mm off; uncertain by %.3f mm; lands within %.3f px\n",
              degrees, mm, 1e3 * std::sqrt(report.covariance.bottomRightCorner<3, 3>().trace()),
              report.transfer_sigma_px);
  EXPECT_LE(degrees, 0.05);
  EXPECT_LE(mm, 0.7);
}

/// Real images of a mask with square holes, by a camera whose owners calibrated it themselves.
class CalibMaskTest : public CalibBoardTest {
 protected:
  const char* Folder() const override { return "thermal_calib_mask"; }
};

TEST_F(CalibMaskTest, NearlyAllImagesCountAndFocalLengthsAreThoseOfTheOwners) {
  Result<ImageSeries> series =
      ReadImageFolder(folder_ / "images", {CalibratedStream::kThermal, {}}, kNoProgress);
  ASSERT_TRUE(series.has_value()) << series.error().message();
  const auto result =
      Calibrate(ViewsOf(std::move(*series)), {"thermal"}, "square-holes 6x4 0.02 hole=0.01");
  ASSERT_TRUE(result.has_value()) << result.error().message();
  const double rms = ReprojectionErrorOf(*result, 0).rms_px;
  const LensParameters& lens = result->state.cameras[0].lens;
  std::printf("mask: %zu views, %.3f px rms, fx %.2f fy %.2f cx %.2f cy %.2f k1 %.4f k2 %.4f\n",
              result->view_names.size(), rms, lens[0], lens[1], lens[2], lens[3], lens[4], lens[5]);
  // One shows a mask that is bent otherwise.
  EXPECT_GE(result->view_names.size(), 19U);
  EXPECT_LE(rms, 0.45);
  // All views are from one distance, and their tilts to one side: half a per cent is one sigma, and
  // the second focal length is not met to one per cent.
  EXPECT_NEAR(lens[0] / 608.531, 1.0, 0.01);
  EXPECT_NEAR(lens[1] / 609.756, 1.0, 0.015);
}

}  // namespace
}  // namespace isotherm
