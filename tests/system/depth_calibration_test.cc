// Depth frames of a recording tell the depth camera's lens by the holes of a board.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "common/codec/codec.h"
#include "common/concurrency/thread_pool.h"
#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "common/simulation/target_camera.h"
#include "common/testing/temporary_directory.h"
#include "ground/camera_calibration/simulated_session.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TemporaryDirectory;

constexpr int kPoses = 9, kFramesPerPose = 9;
constexpr auto kFrame = std::chrono::milliseconds(33), kPause = std::chrono::milliseconds(300);

/// Depth images of the thesis's board in some poses, before a wall; those of one pose differ by
/// noise.
std::vector<Image<std::uint16_t>> TakeFrames(ThreadPool& pool) {
  const PerforatedBoard board = WarpedBoard(0.001, 1);
  const std::vector<TargetObserver> observers = {{ThesisDepth()}};
  const std::vector<RigidTransform> poses = SampleTargetViews(board, observers, kPoses, {}, 1);
  const TargetCamera camera(ThesisDepth(), {});
  std::vector<Image<std::uint16_t>> frames(kPoses * kFramesPerPose);
  pool.ParallelFor(static_cast<int>(frames.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    frames[index] = camera.Depth(board, poses[index / kFramesPerPose], index + 1);
    constexpr std::uint16_t kWall_mm = 1800;
    for (std::uint16_t& depth : frames[index].pixels()) depth = depth == 0 ? kWall_mm : depth;
  });
  return frames;
}

void Record(const std::vector<Image<std::uint16_t>>& frames, const std::filesystem::path& path) {
  Rig rig;
  rig.depth = ThesisDepth();
  auto writer = RecordingWriter::Create(path, {});
  ASSERT_TRUE(writer) << writer.error().message();
  ASSERT_TRUE((*writer)->Write(rig).ok());
  DepthEncoder encoder;
  EncodedDepthFrame frame;
  frame.header.capture_time = CaptureTime(std::chrono::seconds(1'750'000'000));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0 && i % kFramesPerPose == 0) frame.header.capture_time += kPause;
    frame.image = encoder.Encode(frames[i]);
    ASSERT_TRUE((*writer)->Write(frame, frame.header.capture_time).ok());
    ++frame.header.frame_number;
    frame.header.device_ticks += kFrame;
    frame.header.capture_time += kFrame;
  }
  ASSERT_TRUE((*writer)->Close().ok());
}

TEST(DepthCalibrationSystemTest, TheLensIsFoundFromHolesInDepthAlone) {
  const TemporaryDirectory folder;
  const std::filesystem::path recording = folder.path() / "board.mcap";
  const std::filesystem::path rig_file = folder.path() / "rig.textproto";
  ThreadPool pool(2);
  Record(TakeFrames(pool), recording);
  const std::string calibrate =
      "exec '" + Tool().string() + "' calibrate depth '" + recording.string() + "' ";
  const Finished found = RunToEnd(Shell(calibrate + "-o '" + rig_file.string() + "'"), kPatience);
  ASSERT_EQ(found.status, 0) << found.output;
  EXPECT_THAT(found.output, AllOf(HasSubstr("9 views"), HasSubstr("brown-conrady lens")));
  const Result<Rig> rig = LoadRigCalibration(rig_file);
  ASSERT_TRUE(rig) << rig.error().message();
  // Nine poses tell less than the thirty that are asked for.
  EXPECT_NEAR(rig->depth->fx, ThesisDepth().fx, 5.0);
  EXPECT_NEAR(rig->depth->cx, ThesisDepth().cx, 5.0);

  const Finished corners = RunToEnd(Shell(calibrate + "--target 'chessboard 8x6 0.03'"), kPatience);
  EXPECT_NE(corners.status, 0);
  EXPECT_THAT(corners.output, HasSubstr("a chessboard has no holes"));
}

}  // namespace
}  // namespace isotherm::system_test
