// The edge sends images of a board, and `isotherm calibrate thermal --live` calibrates from them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <string>

#include "common/codec/codec.h"
#include "common/concurrency/thread_pool.h"
#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "common/testing/temporary_directory.h"
#include "ground/camera_calibration/simulated_session.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

constexpr int kPoses = 12, kFramesPerPose = 12;
constexpr auto kFrame = std::chrono::milliseconds(50), kPause = std::chrono::milliseconds(300);

/// The image as a camera shows it, with noise of 0.03 K. Between 20 and 60 °C, whatever its units.
Image<std::uint16_t> Show(const Image<float>& image, std::mt19937& engine) {
  std::normal_distribution<float> noise(0.0F, 3.0F);
  const auto range = std::ranges::minmax(image.pixels());
  Image<std::uint16_t> counts(image.width(), image.height());
  std::ranges::transform(image.pixels(), counts.pixels().begin(), [&](float value) {
    const float part = (value - range.min) / (range.max - range.min);
    return static_cast<std::uint16_t>(std::lround(29'315.0F + 4'000.0F * part + noise(engine)));
  });
  return counts;
}

/// A recording of a thermal camera before the thesis's board in some poses.
void RecordBoard(const std::filesystem::path& path) {
  TargetSession session;
  session.board = WarpedBoard(0.001, 1);
  session.count = kPoses;
  ThreadPool pool(2);
  const CalibrationInput input = TakeViews(session, pool);
  Rig rig;
  rig.thermal = ThesisThermal();
  rig.depth = ThesisDepth();
  auto writer = RecordingWriter::Create(path, {});
  ASSERT_TRUE(writer) << writer.error().message();
  ASSERT_TRUE((*writer)->Write(rig).ok());
  ThermalEncoder encoder;
  std::mt19937 engine(3);
  EncodedThermalFrame frame;
  frame.valid = true;
  frame.header.capture_time = CaptureTime(std::chrono::seconds(1'750'000'000));
  for (const CalibrationView& view : input.views) {
    for (int i = 0; i < kFramesPerPose; ++i) {
      frame.image = encoder.Encode(Show(view.images.front(), engine), kCentikelvin);
      ASSERT_TRUE((*writer)->Write(frame, frame.header.capture_time).ok());
      ++frame.header.frame_number;
      frame.header.device_ticks += kFrame;
      frame.header.capture_time += kFrame;
    }
    frame.header.capture_time += kPause;
  }
  ASSERT_TRUE((*writer)->Close().ok());
}

class LiveCalibrationTest : public ::testing::Test {
 protected:
  Command Calibrate(const std::string& more) const {
    return Shell("exec '" + Tool().string() + "' calibrate thermal --live --domain " +
                 std::to_string(OwnDomain()) + " " + more);
  }

  TemporaryDirectory folder_;
};

TEST_F(LiveCalibrationTest, EachPoseSaysWhatIsMissingAndTheEndOfTheSessionCalibrates) {
  const std::filesystem::path recording = folder_.path() / "board.mcap";
  const std::filesystem::path rig_file = folder_.path() / "rig.textproto";
  RecordBoard(recording);
  Process calibrate(Calibrate("--timeout 60 -o '" + rig_file.string() + "'"));
  Process edge({EdgeDaemon(),
                {"--recording", recording.string(), "--exit-at-end", "--domain",
                 std::to_string(OwnDomain())},
                {}});
  EXPECT_TRUE(calibrate.WaitForOutput("Ctrl-C when nothing is missing", kPatience));
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(calibrate.WaitForExit(kPatience), 0) << calibrate.output();
  EXPECT_THAT(calibrate.output(), HasSubstr("thermal: 10 views, uncertain by "));
  EXPECT_THAT(calibrate.output(), HasSubstr("; next: too few views"));
  const Result<Rig> found = LoadRigCalibration(rig_file);
  ASSERT_TRUE(found) << found.error().message();
  // A dozen poses tell less than the thirty that are asked for.
  EXPECT_NEAR(found->thermal->fx, ThesisThermal().fx, 1.0);
  EXPECT_NEAR(found->thermal->cy, ThesisThermal().cy, 1.0);
}

TEST_F(LiveCalibrationTest, WithoutARigItSaysWhatToCheck) {
  const Finished alone = RunToEnd(Calibrate("--timeout 1"), kPatience);
  EXPECT_NE(alone.status, 0);
  EXPECT_THAT(alone.output, HasSubstr("rig"));
  EXPECT_THAT(alone.output, Not(HasSubstr("views")));
  const Finished infrared =
      RunToEnd(Shell("exec '" + Tool().string() + "' calibrate rig --live --infrared"), kPatience);
  EXPECT_NE(infrared.status, 0);
  EXPECT_THAT(infrared.output, HasSubstr("a rig sends no infrared images"));
}

}  // namespace
}  // namespace isotherm::system_test
