#include "edge/daemon/resume_scan.h"

#include <gtest/gtest.h>

#include "common/testing/temporary_directory.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr CaptureTime kStart{1'700'000'000s};

CameraDescription Camera(Sensor sensor, std::string serial) {
  CameraDescription camera;
  camera.sensor = sensor;
  camera.driver = "test";
  camera.serial = std::move(serial);
  camera.width = 2;
  camera.height = 1;
  camera.rate_hz = 10.0;
  return camera;
}

/// A rig whose edge was killed after ten seconds, and is started again three seconds later.
class ResumeScanTest : public ::testing::Test {
 protected:
  ResumeScanTest() {
    options_.mutable_source()->set_kind(CAMERAS);
    options_.mutable_source()->set_rig_file("rig.textproto");
    options_.mutable_spool()->set_record(folder_.path() / "scan.mcap");
    Rig rig;
    rig.depth =
        CameraModel{.width = 2, .height = 1, .fx = 500.1, .fy = 500.3, .cx = 0.5, .cy = 0.1};
    rig.thermal = rig.depth;
    rig.T_thermal_depth =
        MakeTransform({0.05, 0.1, 0.0}, Eigen::Quaterniond(1.0, 0.01, -0.02, 0.03));
    before_ = {.time = kStart,
               .cameras = {Camera(Sensor::kDepth, "D1"), Camera(Sensor::kThermal, "T1")},
               .rig = rig};
    again_ = before_;
    again_.time = kStart + 13s;
    WriteKilled();
  }

  /// A copy of a growing file is what a process that is killed leaves.
  void WriteKilled() const {
    const testing::TemporaryDirectory elsewhere;
    RecordingFiles files(
        {elsewhere.path() / "scan.mcap", 500ms, before_.rig, RecordingMetadata(options_, before_)});
    const RecordingFile file = files.Next().value();
    for (int i = 0; i <= 100; ++i) {
      EncodedDepthFrame frame;
      frame.header = {.session = before_.session(),
                      .frame_number = static_cast<std::uint64_t>(i),
                      .capture_time = kStart + i * 100ms};
      frame.depth_scale = 1000.0;
      frame.image = {
          .encoding = Encoding::kRaw16, .width = 2, .height = 1, .payload = {1, 2, 3, 4}};
      ASSERT_TRUE(file.writer->Write(frame, std::nullopt).ok());
    }
    ASSERT_TRUE(file.writer->Flush().ok());
    Copy(file.path, options_.spool().record(), 10s);
  }
  /// Leaves a file of which nothing but metadata was on the disk.
  void WriteKilledAtOnce(const std::filesystem::path& path, const EdgeSession& session) const {
    const testing::TemporaryDirectory elsewhere;
    RecordingFiles files(
        {elsewhere.path() / "scan.mcap", 500ms, session.rig, RecordingMetadata(options_, session)});
    const RecordingFile file = files.Next().value();
    Copy(file.path, path, 13s);
  }
  static void Copy(const std::filesystem::path& from, const std::filesystem::path& to,
                   Nanoseconds written) {
    std::filesystem::copy_file(from, to);
    const std::chrono::sys_time<Nanoseconds> time((kStart + written).time_since_epoch());
    std::filesystem::last_write_time(to, std::chrono::file_clock::from_sys(time));
  }
  bool GoesOn() const { return FindScanToResume(options_, again_).has_value(); }

  const testing::TemporaryDirectory folder_;
  EdgeOptions options_;
  EdgeSession before_;
  EdgeSession again_;
};

TEST_F(ResumeScanTest, GoesOnWithTheSessionItsNumbersAndItsCounts) {
  const std::optional<InterruptedScan> scan = FindScanToResume(options_, again_);
  ASSERT_TRUE(scan);
  Resume(*scan, again_);
  EXPECT_EQ(again_.session(), before_.session());
  const std::uint64_t depth_limit = again_.first_numbers[0];
  EXPECT_GE(depth_limit, 131U) << "ten frames a second for three seconds more";
  EXPECT_LE(depth_limit, 145U);

  const SessionBefore published = PublishedBy(*scan, again_);
  EXPECT_EQ(published.depth.frames, 101U);
  EXPECT_EQ(published.depth.next_frame_number, 101U);
  EXPECT_EQ(published.depth.number_limit, depth_limit);

  FrameCounters counters;
  CountBefore(*scan, again_, counters);
  const SensorCounters depth = counters.Get(Sensor::kDepth);
  EXPECT_EQ(depth.captured, 101U);
  EXPECT_EQ(depth.OnTheWayToGround(), 0);
  EXPECT_EQ(depth.lost_by_restart, depth_limit - 101U);
}

TEST_F(ResumeScanTest, ACalibrationThatIsAnotherOneBeginsAnotherScan) {
  ASSERT_TRUE(GoesOn());
  again_.rig->thermal_scale = {0.02, 0.0};
  EXPECT_TRUE(GoesOn()) << "that is the camera's, which may have come late";
  again_.rig->depth->fx = 500.2;
  EXPECT_FALSE(GoesOn());
  again_.rig.reset();
  EXPECT_FALSE(GoesOn());
}

TEST_F(ResumeScanTest, ACameraThatIsAnotherOneBeginsAnotherScanAndOneThatIsNotThereYetDoesNot) {
  again_.cameras.pop_back();
  EXPECT_TRUE(GoesOn());
  again_.cameras.push_back(Camera(Sensor::kThermal, "T2"));
  EXPECT_FALSE(GoesOn());
}

TEST_F(ResumeScanTest, GoesOnAlsoWhenTheProcessBeforeWasKilledBeforeItHadRecordedAnything) {
  const std::optional<InterruptedScan> first = FindScanToResume(options_, again_);
  ASSERT_TRUE(first);
  Resume(*first, again_);
  WriteKilledAtOnce(folder_.path() / "scan-2.mcap", again_);
  EdgeSession third = before_;
  third.time = kStart + 14s;
  const std::optional<InterruptedScan> scan = FindScanToResume(options_, third);
  ASSERT_TRUE(scan);
  Resume(*scan, third);
  EXPECT_EQ(third.session(), before_.session());
  EXPECT_GT(third.first_numbers[0], again_.first_numbers[0] + 10);
}

TEST_F(ResumeScanTest, AStreamThatNeverWasHasLostNothing) {
  const std::optional<InterruptedScan> scan = FindScanToResume(options_, again_);
  ASSERT_TRUE(scan);
  Resume(*scan, again_);
  EXPECT_GT(again_.first_numbers[1], 0U) << "it may have begun just before";
  FrameCounters counters;
  CountBefore(*scan, again_, counters);
  EXPECT_EQ(counters.Get(Sensor::kThermal).lost_by_restart, 0U);
}

TEST_F(ResumeScanTest, WithoutACalibrationACameraThatComesLateDoesNotMatter) {
  std::filesystem::remove(options_.spool().record());
  options_.mutable_source()->clear_rig_file();
  before_.rig->thermal.reset();
  before_.rig->T_thermal_depth.reset();
  WriteKilled();
  again_.rig.reset();
  EXPECT_TRUE(GoesOn());
  options_.mutable_source()->set_rig_file("rig.textproto");
  EXPECT_FALSE(GoesOn()) << "then it is the file that has changed";
}

TEST_F(ResumeScanTest, AReplayWithItsOwnTimesAndAnOptionThatSaysSoBeginAnotherScan) {
  options_.mutable_source()->set_kind(REPLAY);
  options_.mutable_source()->set_rate(0.0);
  EXPECT_FALSE(GoesOn());
  options_.mutable_source()->set_rate(1.0);
  EXPECT_TRUE(GoesOn());
  options_.mutable_spool()->set_resume_s(2.9);
  EXPECT_FALSE(GoesOn());
}

}  // namespace
}  // namespace isotherm
