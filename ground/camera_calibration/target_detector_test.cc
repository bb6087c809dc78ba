#include "ground/camera_calibration/target_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ground/camera_calibration/simulated_session.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

/// Three thermal images of the thesis's board, and where its holes' centres are in the first.
class TargetDetectorTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    TargetSession session;
    session.count = 2;
    ThreadPool pool(2);
    input_ = new CalibrationInput(TakeViews(session, pool));
  }
  static void TearDownTestSuite() { delete input_; }

  static const Image<float>& FirstImage() { return input_->views[0].images[0]; }
  static Result<DetectedTarget> Detect(const Image<float>& image) {
    return DetectTarget(image, input_->target);
  }
  static std::string Refusal(const Image<float>& image) {
    const auto detected = Detect(image);
    return detected ? "found" : detected.error().message();
  }

  static CalibrationInput* input_;
};
CalibrationInput* TargetDetectorTest::input_ = nullptr;

/// The board's first row, from the left, is above its second in the sense that the image gives.
double SenseOfRotation(const CalibrationTarget& target, const DetectedTarget& detected) {
  const auto at = [&](int i) { return detected.features[static_cast<std::size_t>(i)]; };
  const Eigen::Vector2d right = at(target.columns - 1) - at(0);
  const Eigen::Vector2d down = at(target.features() - target.columns) - at(0);
  return right.x() * down.y() - right.y() * down.x();
}

TEST_F(TargetDetectorTest, HotHolesAreFoundAndNumberedFromTheFront) {
  const auto detected = Detect(FirstImage());
  ASSERT_TRUE(detected.has_value()) << detected.error().message();
  EXPECT_TRUE(detected->holes_bright);
  EXPECT_EQ(detected->features.size(), 36U);
  EXPECT_GT(SenseOfRotation(input_->target, *detected), 0.0);
}

TEST_F(TargetDetectorTest, InvertedContrastIsFoundAtTheSamePlaces) {
  Image<float> inverted = FirstImage();
  for (float& value : inverted.pixels()) value = 70'000.0F - value;
  const auto detected = Detect(FirstImage()), other = Detect(inverted);
  ASSERT_TRUE(other.has_value()) << other.error().message();
  EXPECT_FALSE(other->holes_bright);
  for (std::size_t i = 0; i < 36; ++i)
    EXPECT_NEAR((detected->features[i] - other->features[i]).norm(), 0.0, 0.2);
}

TEST_F(TargetDetectorTest, ATargetHalfOutsideIsRefusedWithAdvice) {
  const Image<float>& whole = FirstImage();
  Image<float> half(whole.width(), whole.height(), whole.At(0, 0));
  for (int y = 0; y < whole.height(); ++y)
    for (int x = whole.width() / 2; x < whole.width(); ++x)
      half.At(x - whole.width() / 2, y) = whole.At(x, y);
  EXPECT_THAT(Refusal(half), HasSubstr("the whole target must be in the image"));
}

TEST_F(TargetDetectorTest, NoValuesAreRefused) {
  EXPECT_THAT(Refusal(Image<float>(382, 288, std::nanf(""))), HasSubstr("have no value"));
  EXPECT_THAT(Refusal(Image<float>(382, 288, 30000.0F)), HasSubstr("were not found"));
}

TEST_F(TargetDetectorTest, SaturatedImagesAreRefused) {
  Image<float> saturated = FirstImage();
  for (float& value : saturated.pixels()) value = std::min(value, 31'500.0F);  // 41.9 °C.
  EXPECT_THAT(Refusal(saturated), HasSubstr("is saturated"));
}

TEST_F(TargetDetectorTest, AnotherGridIsSaidWithWhatWasFound) {
  const auto target = ParseTarget("asymmetric-circles 4x7 0.05");
  const auto detected = DetectTarget(FirstImage(), *target);
  ASSERT_FALSE(detected.has_value());
  EXPECT_THAT(detected.error().message(), HasSubstr("found 4 x 9, expected 4 x 7"));
  const auto larger = DetectTarget(FirstImage(), *ParseTarget("asymmetric-circles 4x11 0.05"));
  ASSERT_FALSE(larger.has_value());
  EXPECT_THAT(larger.error().message(), HasSubstr("found 4 x 9, expected 4 x 11"));
}

TEST_F(TargetDetectorTest, AMirroredTargetIsRefusedWhereItCanBeTold) {
  PerforatedBoard board;
  board.rows = 6;
  const TargetObserver observer = {ThesisThermal()};
  const auto poses = SampleTargetViews(board, {&observer, 1}, 1, {}, 4);
  const auto counts = TargetCamera(ThesisThermal(), {}).Thermal(board, poses[0], 1);
  Image<float> image(counts.width(), counts.height()), mirrored = image;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      image.At(x, y) = static_cast<float>(counts.At(x, y));
      mirrored.At(image.width() - 1 - x, y) = image.At(x, y);
    }
  }
  const auto target = ParseTarget("asymmetric-circles 4x6 0.05");
  const auto detected = DetectTarget(image, *target);
  ASSERT_TRUE(detected.has_value()) << detected.error().message();
  const auto refused = DetectTarget(mirrored, *target);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("mirrored"));
}

TEST_F(TargetDetectorTest, ScatterBetweenFramesIsMeasured) {
  std::vector<Image<float>> frames(4, FirstImage());
  const auto still = FeatureScatter(frames, input_->target);
  ASSERT_TRUE(still.has_value());
  EXPECT_NEAR(*still, 0.0, 1e-6);
  // Every second frame a pixel to the right.
  for (const std::size_t i : {1U, 3U}) {
    for (int y = 0; y < frames[i].height(); ++y)
      for (int x = frames[i].width() - 1; x > 0; --x) frames[i].At(x, y) = frames[i].At(x - 1, y);
  }
  const auto moving = FeatureScatter(frames, input_->target);
  ASSERT_TRUE(moving.has_value());
  EXPECT_NEAR(*moving, 0.5 * std::sqrt(4.0 / 3.0), 0.1);
  EXPECT_FALSE(FeatureScatter({FirstImage()}, input_->target).has_value());
}

}  // namespace
}  // namespace isotherm
