#include "ground/camera_calibration/target_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/rig/rig_calibration.h"
#include "common/testing/temporary_directory.h"
#include "ground/camera_calibration/calibration_report.h"
#include "ground/camera_calibration/projection_map.h"
#include "ground/camera_calibration/resampling.h"
#include "ground/camera_calibration/rig_file.h"
#include "ground/camera_calibration/sensitivity.h"
#include "ground/camera_calibration/simulated_session.h"
#include "ground/camera_calibration/transfer.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

const CalibrationProgress kSilent = [](double) {};

Result<TargetCalibration> Calibrate(const CalibrationInput& input) {
  ThreadPool pool(2);
  return CalibrateWithTarget(input, pool, kSilent);
}

/// Fourteen thermal views of a warped board, calibrated once for all tests.
class ThermalCalibrationTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    TargetSession session;
    session.board = WarpedBoard(0.0015, 3);
    session.count = 14;
    session.seed = 3;
    ThreadPool pool(2);
    input_ = new CalibrationInput(TakeViews(session, pool));
    result_ = new Result<TargetCalibration>(Calibrate(*input_));
  }
  static void TearDownTestSuite() {
    delete input_;
    delete result_;
  }
  void SetUp() override { ASSERT_TRUE(result_->has_value()) << result_->error().message(); }

  static const TargetCalibration& calibration() { return **result_; }
  static BundleCamera camera() { return calibration().state.cameras.front(); }
  static Eigen::Vector2i size() { return calibration().sizes_px.front(); }

  static CalibrationInput* input_;
  static Result<TargetCalibration>* result_;
};
CalibrationInput* ThermalCalibrationTest::input_ = nullptr;
Result<TargetCalibration>* ThermalCalibrationTest::result_ = nullptr;

TEST_F(ThermalCalibrationTest, ProjectionIsWithinTheRequirementOfTheTrueOne) {
  const ProjectionMap off = CompareProjections(ToBundle(ThesisThermal()), camera(), size());
  EXPECT_LE(off.Rms(true), 0.12);
  EXPECT_LE(off.Max(true), 0.5);
}

TEST_F(ThermalCalibrationTest, OpenCvOnTheSameImagesIsFarOffAtASmallResidual) {
  std::vector<std::vector<Eigen::Vector2d>> views = calibration().detections.front();
  const auto opencv =
      CalibrateWithOpenCv(calibration().target, views, size(), LensKind::kBrownConrady);
  ASSERT_TRUE(opencv.has_value());
  const BundleCamera other{LensKind::kBrownConrady, opencv->lens, RigidTransform::Identity()};
  EXPECT_LE(opencv->rms_px, 0.2);
  EXPECT_GE(CompareProjections(ToBundle(ThesisThermal()), other, size()).Rms(true), 0.4);
}

TEST_F(ThermalCalibrationTest, WarpOfTheBoardIsFound) {
  const PerforatedBoard board = WarpedBoard(0.0015, 3);
  // Up to a plane: the board's pose takes up the rest.
  Eigen::MatrixX3d plane(36, 3);
  Eigen::VectorXd off(36);
  const CalibrationTarget& target = calibration().target;
  for (int i = 0; i < 36; ++i) {
    const Eigen::Vector2d xy = target.FeaturePosition(i);
    const Eigen::Vector2d place = (xy - target.Middle()).cwiseQuotient(target.HalfSize());
    plane.row(i) << 1.0, place.x(), place.y();
    off(i) = calibration().state.board.Z(place.x(), place.y()) - board.FaceZ(xy);
  }
  const Eigen::VectorXd rest = off - plane * plane.colPivHouseholderQr().solve(off);
  constexpr double kAccuracy_m = 1e-4;
  EXPECT_LE(std::sqrt(rest.squaredNorm() / 36.0), kAccuracy_m);
}

TEST_F(ThermalCalibrationTest, TruthIsWithinTwoSigmaOfMostPixels) {
  const CalibrationReport report =
      MakeReport(calibration(), {"thermal"}, {.bootstrap_samples = 300});
  const ProjectionMap off = CompareProjections(ToBundle(ThesisThermal()), camera(), size());
  EXPECT_GE(FractionWithin(off, report.cameras.front().sigmas, 2.0), 0.9);
  // A corner that no feature reached is less certain than the middle.
  EXPECT_GE(report.cameras.front().sigmas.Max(false),
            5.0 * report.cameras.front().sigmas.Rms(true));
}

TEST_F(ThermalCalibrationTest, OneStepFromTheSolutionIsTheCalibrationFromFewerViews) {
  std::vector<FeatureObservation> fewer;
  for (const FeatureObservation& o : calibration().observations) {
    if (o.view != 2 && o.view != 7) fewer.push_back(o);
  }
  const auto solved = Recalibrate(calibration(), fewer);
  ASSERT_TRUE(solved.has_value());
  std::vector<double> weights(calibration().view_names.size(), 1.0);
  weights[2] = weights[7] = 0.0;
  const Eigen::VectorXd step = calibration().system.Step(weights);
  BundleCamera stepped = camera();
  for (int i = 0; i < 9; ++i) stepped.lens[static_cast<std::size_t>(i)] += step(i);
  const double moved =
      CompareProjections(camera(), solved->state.cameras.front(), size()).Rms(true);
  const double off = CompareProjections(stepped, solved->state.cameras.front(), size()).Rms(true);
  EXPECT_LT(off, 0.1 * moved);
}

TEST_F(ThermalCalibrationTest, ResampledViewsScatterAsTheCovarianceSays) {
  const LensSamples samples = BootstrapLens(calibration(), 0, 1000, 5);
  const double from_views = ProjectionSigmas(camera(), samples.Covariance(), size()).Rms(true);
  const double from_scatter =
      ProjectionSigmas(camera(), calibration().LensCovariance(0), size()).Rms(true);
  EXPECT_LT(from_views, 3.0 * from_scatter);
  EXPECT_GT(from_views, 0.1 * from_scatter);
  // The thesis's way spreads less: here by sqrt(14 / 10 - 1).
  const double subset =
      ProjectionSigmas(camera(), SubsetLens(calibration(), 0, 10, 1000, 5).Covariance(), size())
          .Rms(true);
  EXPECT_NEAR(subset / from_views, std::sqrt(0.4), 0.25);
}

TEST_F(ThermalCalibrationTest, ErrorGrowsAsTheSensitivitySays) {
  constexpr double kIncrease_px = 0.1;
  const auto changes = ParameterSensitivity(calibration(), 0, kIncrease_px);
  ASSERT_TRUE(changes.has_value());
  const double before = ReprojectionErrorOf(calibration(), 0).rms_px;
  for (const int parameter : {0, 2, 4}) {
    TargetCalibration moved = calibration();
    moved.state.cameras[0].lens[static_cast<std::size_t>(parameter)] +=
        (*changes)[static_cast<std::size_t>(parameter)];
    BundleOptions poses_only;
    poses_only.fix_lenses = true;
    poses_only.estimate_board = false;
    const auto fit = SolveBundle(moved.target, moved.observations, poses_only, moved.state);
    ASSERT_TRUE(fit.has_value());
    moved.fit = *fit;
    EXPECT_NEAR(ReprojectionErrorOf(moved, 0).rms_px - before, kIncrease_px, 0.03) << parameter;
  }
}

TEST_F(ThermalCalibrationTest, HalvesAgree) {
  const auto validations = CrossValidate(calibration());
  ASSERT_TRUE(validations.has_value());
  EXPECT_LT(validations->front().Ratio(), 2.0);
}

TEST_F(ThermalCalibrationTest, AnImageThatDisagreesIsRefusedWithAReason) {
  CalibrationInput input = *input_;
  Image<float>& image = input.views[4].images[0];
  // The upper half of the image comes late, as if the target had moved meanwhile.
  for (int y = 0; y < image.height() / 2; ++y)
    for (int x = image.width() - 1; x >= 3; --x) image.At(x, y) = image.At(x - 3, y);
  const auto result = Calibrate(input);
  ASSERT_TRUE(result.has_value()) << result.error().message();
  ASSERT_EQ(result->refused.size(), 1U);
  EXPECT_EQ(result->refused[0].name, "view 4");
  EXPECT_THAT(result->refused[0].reason, HasSubstr("did the target move"));
}

TEST_F(ThermalCalibrationTest, WhatCannotBeCalibratedFromIsRefusedInASentence) {
  CalibrationInput few = *input_;
  few.views.resize(4);
  EXPECT_THAT(Calibrate(few).error().message(), HasSubstr("at least 6 are needed"));
  CalibrationInput mixed = *input_;
  mixed.views[3].images[0] = Image<float>(160, 120, 1.0F);
  EXPECT_THAT(Calibrate(mixed).error().message(), HasSubstr("160 x 120 pixels"));
  CalibrationInput parallel = *input_;
  for (CalibrationView& view : parallel.views) view.images[0] = input_->views[0].images[0];
  EXPECT_THAT(Calibrate(parallel).error().message(), HasSubstr("parallel"));
}

TEST_F(ThermalCalibrationTest, TheRigFileHasThePrincipalPointOfDepthImages) {
  CalibrationReport report = MakeReport(calibration(), {"depth"}, {.bootstrap_samples = 100});
  report.cameras.front().infrared_shift_px = {5.0, 4.0};
  const testing::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "rig.textproto";
  ASSERT_TRUE(UpdateRigFile(file, report, {""}).ok());
  const Result<Rig> rig = LoadRigCalibration(file);
  ASSERT_TRUE(rig.has_value()) << rig.error().message();
  EXPECT_DOUBLE_EQ(rig->depth->cx, camera().lens[2] - 5.0);
  EXPECT_DOUBLE_EQ(rig->depth->cy, camera().lens[3] - 4.0);
  EXPECT_DOUBLE_EQ(rig->depth->fx, camera().lens[0]);
  EXPECT_DOUBLE_EQ(rig->depth->k3, camera().lens[8]);
  EXPECT_THAT(ReportText(report), HasSubstr("5.00 and 4.00 px less"));
}

/// A camera of 120 degrees across.
CameraModel WideCamera(LensKind lens) {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = 182.0;
  camera.fy = 182.6;
  camera.cx = 194.5;
  camera.cy = 140.5;
  camera.lens = lens;
  if (lens == LensKind::kFisheye) {
    camera.k1 = -0.03, camera.k2 = 0.01, camera.k3 = -0.004, camera.k4 = 0.001;
  } else {
    camera.k1 = 0.778, camera.k2 = 0.068, camera.k3 = 0.002;
    camera.p1 = 0.0004, camera.p2 = -0.0003;
    camera.k4 = 1.11, camera.k5 = 0.238, camera.k6 = 0.004;
  }
  return camera;
}

class WideLensTest : public ::testing::TestWithParam<LensKind> {};

TEST_P(WideLensTest, IsCalibratedByItsModelAndNotByAnother) {
  TargetSession session;
  session.board = WarpedBoard(0.0012, 5);
  session.count = 20;
  session.seed = 5;
  session.thermal_camera = WideCamera(GetParam());
  session.views.min_distance_m = 0.35;  // Nearer: the target has to reach the corners.
  session.views.max_distance_m = 0.7;
  ThreadPool pool(2);
  CalibrationInput input = TakeViews(session, pool);
  const auto result = Calibrate(input);
  ASSERT_TRUE(result.has_value()) << result.error().message();
  const BundleCamera truth = ToBundle(session.thermal_camera);
  const Eigen::Vector2i size = result->sizes_px.front();
  const ProjectionMap off = CompareProjections(truth, result->state.cameras.front(), size);
  EXPECT_LE(off.Rms(true), 0.12);
  EXPECT_LE(off.Max(true), 0.5);
  EXPECT_LE(ReprojectionErrorOf(*result, 0).rms_px, 0.12);
  const auto opencv =
      CalibrateWithOpenCv(result->target, result->detections.front(), size, GetParam());
  ASSERT_TRUE(opencv.has_value()) << opencv.error().message();
  const BundleCamera theirs{GetParam(), opencv->lens, RigidTransform::Identity()};
  EXPECT_LE(CompareProjections(theirs, truth, size).Rms(true), 0.8) << "the same coefficients";

  input.lenses.front() = LensKind::kBrownConrady;
  const auto other = Calibrate(input);
  ASSERT_TRUE(other.has_value()) << other.error().message();
  EXPECT_GE(CompareProjections(truth, other->state.cameras.front(), size).Rms(true), 1.0);
  const double own_px = ReprojectionErrorOf(*result, 0).rms_px;
  const double other_px = ReprojectionErrorOf(*other, 0).rms_px;
  EXPECT_LE(other_px, 0.1) << "a small error proves nothing";
  EXPECT_GE(other_px, 2.0 * own_px) << "but that of the right model is smaller";
}

INSTANTIATE_TEST_SUITE_P(Lenses, WideLensTest,
                         ::testing::Values(LensKind::kRational, LensKind::kFisheye));

TEST(DepthCalibrationTest, HolesInDepthAloneTellTheLens) {
  TargetSession session;
  session.board = WarpedBoard(0.0012, 8);
  session.count = 18;
  session.seed = 8;
  session.thermal = false;
  session.depth = true;
  session.depth_images = TargetSession::DepthImages::kDepth;
  ThreadPool pool(2);
  const auto result = Calibrate(TakeViews(session, pool));
  ASSERT_TRUE(result.has_value()) << result.error().message();
  EXPECT_LE(result->refused.size(), 2U);
  const ProjectionMap off = CompareProjections(
      ToBundle(ThesisDepth()), result->state.cameras.front(), result->sizes_px.front());
  EXPECT_LE(off.Rms(true), 0.4);
  EXPECT_LE(off.Max(true), 0.8);
}

TEST(RigCalibrationTest, PoseBetweenTheCamerasIsWithinTheRequirement) {
  TargetSession session;
  session.board = WarpedBoard(0.0012, 8);
  session.count = 12;
  session.seed = 8;
  session.depth = true;
  ThreadPool pool(2);
  const auto result = Calibrate(TakeViews(session, pool));
  ASSERT_TRUE(result.has_value()) << result.error().message();
  EXPECT_TRUE(result->refused.empty())
      << result->refused.front().name << ' ' << result->refused.front().reason;
  const RigidTransform T_thermal_depth = result->state.cameras[1].T_camera_rig;
  const RigidTransform truth = ThesisThermalFromDepth();
  EXPECT_LE(RotationAngle(T_thermal_depth, truth) / kRadPerDeg, 0.05);
  EXPECT_LE(1e3 * TranslationDistance(T_thermal_depth, truth), 0.7);
  // Points that the depth camera sees land where they should.
  BundleState true_state = result->state;
  true_state.cameras[0].lens = ToBundle(ThesisDepth()).lens;
  true_state.cameras[1].lens = ToBundle(ThesisThermal()).lens;
  true_state.cameras[1].T_camera_rig = truth;
  for (const double depth_m : {0.4, 0.9}) {
    const auto at = [&](const BundleState& state) {
      return TransferPoints(state, result->sizes_px[0], result->sizes_px[1], depth_m);
    };
    ProjectionMap off = at(true_state);
    const ProjectionMap measured = at(result->state);
    for (std::size_t i = 0; i < off.values_px.size(); ++i)
      off.values_px[i] -= measured.values_px[i];
    EXPECT_LE(off.Rms(true), 0.15) << depth_m;
  }
  const PoseReport report = ReportPose(*result);
  EXPECT_EQ(report.views, 12);
  EXPECT_GT(report.transfer_sigma_px, 0.0);
  EXPECT_LT(report.transfer_sigma_px, 0.15);
}

}  // namespace
}  // namespace isotherm
