#include "ground/guidance/feedback_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/base/units.h"
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
    options_.mutable_tsdf()->set_truncation_distance_m(testing::kSmallTruncation_m);
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

  /// The first pose, a little beside it in each frame, rolled about the optical axis.
  RigidTransform TruePose(double roll_deg) const {
    const double sway_m = 0.0002 * (frame_ % 5);
    return testing::FirstPose() *
           MakeTransform({sway_m, 0.0, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                                 roll_deg * kRadPerDeg, Eigen::Vector3d::UnitZ())));
  }
  Feedback Process(DepthFrame frame) {
    frame.header.capture_time = CaptureTime(FromSeconds(100.0 + frame_ / 30.0));
    ++frame_;
    FeedbackMoment moment;
    moment.header = frame.header;
    moment.report = pipeline_->ProcessDepth(frame);
    return maker_->Make(moment, pipeline_->model(), pipeline_->pool());
  }
  Feedback Show(double roll_deg = 0.0) {
    last_true_ = TruePose(roll_deg);
    return Process(testing::RenderDepth(ColumnsAndBall, *rig_.rig.depth, last_true_));
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
  for (double roll_deg = 87.0; roll_deg > 0.0; roll_deg -= 3.0) feedback = Show(roll_deg);
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

}  // namespace
}  // namespace isotherm
