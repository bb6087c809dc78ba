#include "ground/feedback/feedback_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/base/units.h"
#include "common/png/png.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm {
namespace {

/// Two upright columns and a small ball before a wall. Only the ball holds the rig along y, so that
/// is the least certain direction.
double ColumnsAndBall(const Eigen::Vector3d& p) {
  const double columns = std::min(std::hypot(p.x() - 0.18, p.z() - 0.46) - 0.06,
                                  std::hypot(p.x() - 0.41, p.z() - 0.48) - 0.05);
  const double ball = (p - Eigen::Vector3d(0.30, 0.26, 0.46)).norm() - 0.04;
  return std::min({columns, ball, 0.62 - p.z(), 0.48 - p.x()});
}

/// Frames that a test makes one by one, and the feedback on each.
class FeedbackMakerTest : public ::testing::Test {
 protected:
  FeedbackMakerTest() {
    rig_.session = 7;
    rig_.rig.depth = testing::SmallDepthCamera();
    *options_.mutable_volume() = testing::SmallVolume();
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(
        testing::kSmallTruncation_m);
    options_.mutable_tsdf()->mutable_expert()->set_max_step_deg(10.0);
    options_.mutable_tsdf()->mutable_expert()->set_min_step_m(
        0.0);  // Each frame counts for the loop closer.
    options_.mutable_tsdf()->mutable_expert()->set_min_step_deg(0.0);
    options_.mutable_submaps()->mutable_expert()->set_start_after_lost_s(0.1);
    options_.mutable_submaps()->mutable_expert()->set_max_rotation_deg(0.0);
    options_.mutable_feedback()->mutable_expert()->set_image_width_px(0);
    options_.set_threads(2);
    Start();
  }
  void Start() {
    auto created = GroundPipeline::Create(options_, rig_.rig, testing::FirstPose());
    ASSERT_TRUE(created.has_value()) << created.error().message();
    pipeline_ = std::move(*created);
    maker_ = std::make_unique<FeedbackMaker>(options_, rig_);
  }

  /// A thermal camera beside the depth camera: next views are planned for it.
  void AddThermalCamera() {
    rig_.rig.thermal = rig_.rig.depth;
    rig_.rig.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  }
  /// The first pose, a little beside it in each frame, rolled about the optical axis.
  RigidTransform TruePose(double roll_deg) const {
    const double sway_m = 0.0002 * (frame_ % 5);
    return testing::FirstPose() *
           MakeTransform({sway_m + beside_m_, 0.0, 0.0},
                         Eigen::Quaterniond(
                             Eigen::AngleAxisd(roll_deg * kRadPerDeg, Eigen::Vector3d::UnitZ())));
  }
  Feedback Process(DepthFrame frame) {
    frame.header.capture_time = CaptureTime(FromSeconds(100.0 + frame_ / 30.0));
    ++frame_;
    FeedbackMoment moment;
    moment.header = frame.header;
    moment.report = pipeline_->ProcessDepth(frame);
    moment.report.slides = slides_;
    moment.link_is_narrow = link_is_narrow_;
    return maker_->Make(moment, pipeline_->model());
  }
  Feedback Show(double roll_deg = 0.0) {
    last_true_ = TruePose(roll_deg);
    return Process(testing::RenderDepth(ColumnsAndBall, *rig_.rig.depth, last_true_));
  }
  void ThinkAhead(int times) {
    for (int i = 0; i < times; ++i) maker_->ThinkAhead(pipeline_->model());
  }
  /// Returns the surface of the active sub-map by itself, square metres.
  double SurfaceOfActive() const {
    const ScanModel& scan = pipeline_->model();
    ModelCoverage coverage(static_cast<float>(options_.export_().expert().min_weight()));
    coverage.Update(
        scan.tsdf(), scan.thermal(), [](std::int32_t) { return false; }, 1'000'000, scan.pool);
    return coverage.areas().total_m2();
  }
  Feedback ShowNothing() {
    DepthFrame frame;
    frame.depth_scale = 1000.0;
    frame.depth_raw = Image<std::uint16_t>(rig_.rig.depth->width, rig_.rig.depth->height, kNoDepth);
    return Process(std::move(frame));
  }
  /// A scan that is lost and begins elsewhere with the camera rolled by 90 degrees: so are the axes
  /// of its second sub-map. What the first frame there brings.
  Feedback BeginRolledElsewhere() {
    for (int i = 0; i < 6; ++i) Show();
    for (int i = 0; i < 5; ++i) ShowNothing();
    return Show(90.0);
  }

  GroundOptions options_;
  RigDescription rig_;
  std::unique_ptr<GroundPipeline> pipeline_;
  std::unique_ptr<FeedbackMaker> maker_;
  RigidTransform last_true_;
  double beside_m_ = 0.0;
  bool link_is_narrow_ = false;
  bool slides_ = false;  ///< The pipeline says so of each frame.
  int frame_ = 0;
};

TEST_F(FeedbackMakerTest, ASubMapThatIsNotJoinedYetHasNeitherPoseNorUncertaintyInWorld) {
  const Feedback feedback = BeginRolledElsewhere();
  ASSERT_EQ(pipeline_->model().atlas.size(), 2);
  ASSERT_FALSE(pipeline_->model().atlas.active().joined);
  EXPECT_EQ(feedback.tracking_state, TrackingState::kTracked);
  EXPECT_FALSE(feedback.T_world_depth.has_value());
  EXPECT_FALSE(feedback.pose_covariance.has_value()) << "nobody could tell whose axes are meant";
}

TEST_F(FeedbackMakerTest, LostInASubMapThatIsNotJoinedTheWayBackBeginsAtTheLastPoseInWorld) {
  Feedback last;
  for (int i = 0; i < 6; ++i) {
    beside_m_ = 0.003 * i;
    last = Show();
  }
  for (int i = 0; i < 5; ++i) ShowNothing();
  Show(90.0);
  frame_ += 30 * 60;  // A minute there.
  ASSERT_EQ(Show(90.0).tracking_state, TrackingState::kTracked);
  ASSERT_FALSE(pipeline_->model().atlas.active().joined);
  const Feedback lost = ShowNothing();
  ASSERT_EQ(lost.tracking_state, TrackingState::kLost);
  ASSERT_TRUE(lost.T_world_depth_next && last.T_world_depth);
  EXPECT_TRUE(lost.T_world_depth_next->isApprox(*last.T_world_depth, 1e-9));
}

TEST_F(FeedbackMakerTest, InARotatedSubMapPoseAndUncertaintyAreBothInWorld) {
  // The same view from a scan that was never lost, whose sub-map is `world`.
  Feedback expected;
  for (int i = 0; i < 12; ++i) expected = Show();
  ASSERT_TRUE(expected.pose_covariance.has_value());
  const auto sigma = [](const Feedback& feedback, int i) {
    return std::sqrt((*feedback.pose_covariance)(i, i));
  };
  constexpr double kClearly = 1.5;
  ASSERT_GT(sigma(expected, 1), kClearly * sigma(expected, 0)) << "y is the less certain one";

  Start();
  BeginRolledElsewhere();
  Feedback feedback;
  for (int roll_deg = 87; roll_deg > 0; roll_deg -= 3) feedback = Show(roll_deg);
  for (int i = 0; i < 80 && !pipeline_->model().atlas.active().joined; ++i) feedback = Show();
  ASSERT_TRUE(pipeline_->model().atlas.active().joined) << "the rig sees what it began with";
  ASSERT_EQ(pipeline_->model().atlas.active_index(), 1);
  const Eigen::Matrix3d R_world_map = pipeline_->model().atlas.active().T_world_map.linear();
  ASSERT_NEAR(R_world_map(1, 0), 1.0, 0.01) << "the sub-map's x axis is world's y axis";

  ASSERT_TRUE(feedback.T_world_depth && feedback.pose_covariance);
  constexpr double kVoxel_m = 0.004;
  EXPECT_LT(TranslationDistance(*feedback.T_world_depth, last_true_), kVoxel_m);
  EXPECT_LT(RotationAngle(*feedback.T_world_depth, last_true_), 1.0 * kRadPerDeg);
  EXPECT_TRUE(IsCovariance(*feedback.pose_covariance));
  EXPECT_GT(sigma(feedback, 1), kClearly * sigma(feedback, 0)) << "y is the less certain one still";
  constexpr double kAlike = 2.0;  // Another model of the same surface.
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(sigma(feedback, i), kAlike * sigma(expected, i)) << i;
    EXPECT_GT(sigma(feedback, i), sigma(expected, i) / kAlike) << i;
  }
}

TEST_F(FeedbackMakerTest, WhoIsNotFoundIsSentBackAlongTheWayTheyCame) {
  constexpr double kStep_m = 0.002;
  for (int i = 0; i < 30; ++i, beside_m_ += kStep_m) Show();  // One second.
  const RigidTransform last = last_true_;
  const auto next_of = [](const Feedback& feedback) { return feedback.T_world_depth_next.value(); };
  Feedback feedback = ShowNothing();
  EXPECT_EQ(feedback.tracking_state, TrackingState::kLost);
  EXPECT_EQ(feedback.advice, std::vector<Advice>{Advice::kGoBackToRelocalise});
  EXPECT_FALSE(feedback.T_world_depth || feedback.pose_covariance || feedback.T_depth_next);
  constexpr double kVoxel_m = 0.004;
  EXPECT_LT(TranslationDistance(next_of(feedback), last), kVoxel_m);
  // For two seconds the last pose; half a second later, where the rig was half a second before it.
  for (int i = 0; i < 75; ++i) feedback = ShowNothing();
  EXPECT_NEAR(TranslationDistance(next_of(feedback), last), 15 * kStep_m, kVoxel_m);
  for (int i = 0; i < 60; ++i) feedback = ShowNothing();
  EXPECT_LT(TranslationDistance(next_of(feedback), testing::FirstPose()), kVoxel_m)
      << "no further than where the scan began";
}

/// As if the view slid on itself: the rig has a pose, but that is a guess.
TEST_F(FeedbackMakerTest, WhoSlidesIsSentBackToWhereTheViewHeldTheRig) {
  AddThermalCamera();
  Start();
  constexpr double kStep_m = 0.002;
  Feedback feedback;
  for (int i = 0; i < 12; ++i, beside_m_ += kStep_m) {
    feedback = Show();
    ThinkAhead(5);
  }
  const RigidTransform held = last_true_;
  EXPECT_TRUE(feedback.T_depth_next.has_value());
  slides_ = true;
  for (int i = 0; i < 12; ++i, beside_m_ += kStep_m) {
    feedback = Show();
    ThinkAhead(1);
  }
  EXPECT_EQ(feedback.tracking_state, TrackingState::kTracked);
  EXPECT_EQ(feedback.advice, std::vector<Advice>{Advice::kGoBackToRelocalise});
  EXPECT_FALSE(feedback.T_depth_next.has_value());
  constexpr double kVoxel_m = 0.004;
  ASSERT_TRUE(feedback.T_world_depth_next.has_value());
  EXPECT_LT(TranslationDistance(*feedback.T_world_depth_next, held), kVoxel_m);
  slides_ = false;
  for (int i = 0; i < 5; ++i) {
    feedback = Show();
    ThinkAhead(5);
  }
  EXPECT_TRUE(feedback.T_depth_next.has_value());
}

TEST_F(FeedbackMakerTest, TheSurfaceOfAllSubMapsCounts) {
  for (int i = 0; i < 6; ++i) Show();
  ThinkAhead(50);
  const SurfaceAreas first = maker_->areas();
  ASSERT_GT(first.total_m2(), 0.1);
  for (int i = 0; i < 5; ++i) ShowNothing();
  for (int i = 0; i < 6; ++i) Show(90.0);
  ASSERT_EQ(pipeline_->model().atlas.size(), 2);
  ThinkAhead(50);
  const double second_m2 = SurfaceOfActive();
  ASSERT_GT(second_m2, 0.1);
  constexpr double kRounding_m2 = 1e-9;
  EXPECT_NEAR(maker_->areas().total_m2(), first.total_m2() + second_m2, kRounding_m2);
  const Feedback feedback = Show(90.0);
  EXPECT_NEAR(feedback.covered_area_m2, maker_->areas().total_m2(), kRounding_m2);
  EXPECT_EQ(feedback.model.never_measured, 1.0F) << "there is no thermal camera";
}

TEST_F(FeedbackMakerTest, SurfaceThatTwoJoinedSubMapsShareCountsOnce) {
  for (int i = 0; i < 6; ++i) Show();
  ThinkAhead(50);
  const double first_m2 = maker_->areas().total_m2();
  for (int i = 0; i < 5; ++i) ShowNothing();
  for (int roll_deg = 90; roll_deg > 0; roll_deg -= 3) Show(roll_deg);
  for (int i = 0; i < 80 && !pipeline_->model().atlas.active().joined; ++i) Show();
  ASSERT_TRUE(pipeline_->model().atlas.active().joined) << "the rig sees what it began with";
  const double second_m2 = SurfaceOfActive();
  ThinkAhead(100);
  // Rolled on the way, the second saw all that the first saw, and more beside it.
  ASSERT_GT(second_m2, first_m2);
  constexpr double kEdges = 0.05;  // What one saw of an edge, and the other did not.
  EXPECT_NEAR(maker_->areas().total_m2(), second_m2, kEdges * second_m2);
}

TEST_F(FeedbackMakerTest, TheImageShowsThatTheRigIsLost) {
  options_.mutable_feedback()->mutable_expert()->set_image_width_px(80);
  Start();
  Feedback tracked;
  for (int i = 0; i < 3; ++i) tracked = Show();
  const Feedback lost = ShowNothing();
  for (const Feedback& feedback : {tracked, lost}) {
    const Result<PngHead> head = ReadPngHead(feedback.image);
    ASSERT_TRUE(head.has_value()) << head.error().message();
    EXPECT_EQ(head->channels, 3);
    EXPECT_LE(feedback.image.size(), kMaxConfidenceImageBytes);
  }
  // The view is the same, so that only the frame around it differs.
  EXPECT_NE(tracked.image, lost.image);
  EXPECT_EQ(tracked.view.never_measured, lost.view.never_measured);
}

TEST_F(FeedbackMakerTest, WhileTheLinkIsTooNarrowTheImageIsSmaller) {
  options_.mutable_feedback()->mutable_expert()->set_image_width_px(640);
  Start();
  EXPECT_GT(Show().image.size(), 1000U);
  link_is_narrow_ = true;
  const Feedback narrow = Show();
  EXPECT_LE(narrow.image.size(), 1000U);
  EXPECT_TRUE(ReadPngHead(narrow.image).has_value());
}

TEST_F(FeedbackMakerTest, WithoutAWidthThereIsNoImage) {
  Show();
  EXPECT_TRUE(Show().image.empty());
}

TEST_F(FeedbackMakerTest, TheNextViewOfASubMapThatIsNotJoinedIsKnownFromTheRigOnly) {
  AddThermalCamera();
  Start();
  BeginRolledElsewhere();
  Feedback feedback;
  for (int i = 0; i < 12; ++i) {
    feedback = Show(90.0);
    ThinkAhead(5);
  }
  ASSERT_EQ(pipeline_->model().atlas.size(), 2);
  ASSERT_FALSE(pipeline_->model().atlas.active().joined);
  ASSERT_TRUE(feedback.T_depth_next.has_value());
  EXPECT_GT(feedback.next_gain_m2, options_.feedback().expert().min_gain_m2());
  EXPECT_FALSE(feedback.T_world_depth_next.has_value()) << "nobody knows where the sub-map is";
}

TEST_F(FeedbackMakerTest, WithoutAThermalCameraThereIsNoNextView) {
  Feedback feedback;
  for (int i = 0; i < 6; ++i) {
    feedback = Show();
    ThinkAhead(5);
  }
  EXPECT_FALSE(feedback.T_depth_next || feedback.T_world_depth_next);
}

}  // namespace
}  // namespace isotherm
