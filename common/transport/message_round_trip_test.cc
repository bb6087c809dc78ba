// Each message arrives at the other side as it was written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/messages/recording_transfer.h"
#include "common/transport/endpoints.h"
#include "common/transport/testing/joined_ends.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

using MessageRoundTripTest = JoinedEndsTest;

EncodedDepthFrame MakeDepth(std::uint64_t number) {
  EncodedDepthFrame frame;
  frame.header = {.session = 7,
                  .frame_number = number,
                  .device_ticks = DeviceTicks(std::chrono::microseconds(33'333 * number)),
                  .capture_time = CaptureTimeFromNanoseconds(1'700'000'000'123'456'789),
                  .capture_sigma = 250us};
  frame.depth_scale = 5000.0;
  frame.image.width = 64;
  frame.image.height = 48;
  frame.image.payload.resize(std::size_t{64} * 48 * 2);
  for (std::size_t i = 0; i < frame.image.payload.size(); ++i) {
    frame.image.payload[i] = static_cast<std::uint8_t>(i * 31 + number);
  }
  return frame;
}

EncodedThermalFrame MakeThermal() {
  EncodedThermalFrame frame;
  frame.header = MakeDepth(3).header;
  frame.image = MakeDepth(3).image;
  frame.image.encoding = Encoding::kThermalRans;
  frame.nuc_state = NucState::kSettling;
  frame.nuc_source = NucSource::kPolled;
  frame.seconds_since_nuc = 12.5;
  frame.housekeeping.fpa_celsius = 31.25F;
  frame.valid = true;
  return frame;
}

Rig MakeRig() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.k1 = -0.1;
  Rig rig;
  rig.depth = camera;
  rig.thermal = camera;
  rig.T_thermal_depth = MakeTransform({0.05, -0.01, 0.002}, Eigen::Quaterniond(0.9, 0.1, 0.2, 0.3));
  rig.thermal_delay_s = 0.012;
  rig.thermal_scale = {0.02, 12.5};
  rig.serial = "RIG-1";
  rig.reprojection_error_px = 0.31;
  rig.depth_sensor = {
      .near_range_m = 0.5, .min_depth_m = 0.4, .max_depth_m = 6.0, .noise_at_1m_m = 0.01};
  rig.depth_sensor.bias = {.columns = 2,
                           .rows = 2,
                           .distances_m = {0.5F, 1.5F},
                           .multipliers = {1.0F, 1.01F, 0.99F, 1.02F, 1.0F, 1.03F, 0.97F, 1.04F}};
  rig.thermal_sensor = {
      .time_constant_s = 0.012,
      .row_readout_s = 1e-4,
      .pixel_pitch_m = 25e-6,
      .lens = LensModel{.focal_length_m = 0.01, .f_number = 1.0, .focus_m = 0.5},
      .scene_influence = {.near_fraction = 0.04, .near_sigma_px = 35.0, .total_fraction = 0.03},
      .radiometric_correction = {{10.0F, 90.0F}, {0.3F, -0.7F}, {0.2F, 0.25F}},
      .housing_drift = HousingDrift{3.5, 0.2}};
  return rig;
}

TEST_F(MessageRoundTripTest, DepthFrameArrivesAsItWasWritten) {
  const EncodedDepthFrame sent = MakeDepth(42);
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->edge_id, "edge-1");
  const EncodedDepthFrame& frame = received->message;
  EXPECT_EQ(frame.header.session, sent.header.session);
  EXPECT_EQ(frame.header.frame_number, 42U);
  EXPECT_EQ(frame.header.device_ticks, sent.header.device_ticks);
  EXPECT_EQ(frame.header.capture_time, sent.header.capture_time);
  EXPECT_EQ(frame.header.capture_sigma, sent.header.capture_sigma);
  EXPECT_EQ(frame.depth_scale, 5000.0);
  EXPECT_EQ(frame.image.width, 64);
  EXPECT_EQ(frame.image.height, 48);
  EXPECT_EQ(frame.image.payload, sent.image.payload);
}

TEST_F(MessageRoundTripTest, ThermalFrameArrivesAsItWasWritten) {
  const EncodedThermalFrame sent = MakeThermal();
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const EncodedThermalFrame& frame = received->message;
  EXPECT_EQ(frame.image.encoding, Encoding::kThermalRans);
  EXPECT_EQ(frame.image.payload, sent.image.payload);
  EXPECT_EQ(frame.nuc_state, NucState::kSettling);
  EXPECT_EQ(frame.nuc_source, NucSource::kPolled);
  EXPECT_EQ(frame.seconds_since_nuc, 12.5);
  EXPECT_EQ(frame.housekeeping.fpa_celsius, 31.25F);
  EXPECT_TRUE(std::isnan(frame.housekeeping.housing_celsius));
  EXPECT_TRUE(frame.valid);
}

TEST_F(MessageRoundTripTest, TemperaturesArriveInTheirScale) {
  EncodedThermalFrame sent = MakeThermal();
  sent.image.encoding = Encoding::kScaledThermalRans;
  sent.scale = {0.02, 12.5};
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->message.image.encoding, Encoding::kScaledThermalRans);
  EXPECT_EQ(received->message.scale, sent.scale);
}

TEST_F(MessageRoundTripTest, RigArrivesAsItWasWritten) {
  RigDescription sent;
  sent.session = 9;
  sent.rig = MakeRig();
  sent.depth = {.width = 640, .height = 480, .rate_hz = 30.0, .serial = "D1", .model = "a, b"};
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const RigDescription& rig = received->message;
  EXPECT_EQ(rig.session, 9U);
  EXPECT_EQ(rig.rig.thermal_scale, sent.rig.thermal_scale);
  ASSERT_TRUE(rig.rig.T_thermal_depth.has_value());
  EXPECT_TRUE(rig.rig.T_thermal_depth->isApprox(*sent.rig.T_thermal_depth, 1e-12));
  ASSERT_TRUE(rig.rig.thermal.has_value());
  EXPECT_EQ(rig.rig.thermal->k1, -0.1);
  EXPECT_EQ(rig.rig.serial, "RIG-1");
  EXPECT_EQ(rig.rig.thermal_delay_s, 0.012);
  EXPECT_EQ(rig.rig.reprojection_error_px, 0.31);
  EXPECT_EQ(rig.rig.depth_sensor.near_range_m, 0.5);
  EXPECT_EQ(rig.rig.depth_sensor.min_depth_m, 0.4);
  EXPECT_EQ(rig.rig.depth_sensor.max_depth_m, 6.0);
  EXPECT_EQ(rig.rig.depth_sensor.noise_at_1m_m, 0.01);
  EXPECT_EQ(rig.rig.thermal_sensor.time_constant_s, 0.012);
  EXPECT_EQ(rig.rig.thermal_sensor.row_readout_s, 1e-4);
  EXPECT_EQ(rig.rig.thermal_sensor.pixel_pitch_m, 25e-6);
  ASSERT_TRUE(rig.rig.thermal_sensor.lens.has_value());
  EXPECT_EQ(rig.rig.thermal_sensor.lens->focal_length_m, 0.01);
  EXPECT_EQ(rig.rig.thermal_sensor.lens->f_number, 1.0);
  EXPECT_EQ(rig.rig.thermal_sensor.lens->focus_m, 0.5);
  EXPECT_EQ(rig.rig.thermal_sensor.scene_influence.near_fraction, 0.04);
  EXPECT_EQ(rig.rig.thermal_sensor.scene_influence.near_sigma_px, 35.0);
  EXPECT_EQ(rig.rig.thermal_sensor.scene_influence.total_fraction, 0.03);
  const RadiometricCorrection& correction = rig.rig.thermal_sensor.radiometric_correction;
  EXPECT_EQ(correction.readings_celsius, (std::vector<float>{10.0F, 90.0F}));
  EXPECT_EQ(correction.corrections_k, (std::vector<float>{0.3F, -0.7F}));
  EXPECT_EQ(correction.sigmas_k, (std::vector<float>{0.2F, 0.25F}));
  ASSERT_TRUE(rig.rig.thermal_sensor.housing_drift);
  EXPECT_EQ(rig.rig.thermal_sensor.housing_drift->error_per_kelvin, 3.5);
  EXPECT_EQ(rig.rig.thermal_sensor.housing_drift->sigma, 0.2);
  EXPECT_EQ(rig.rig.depth_sensor.bias.columns, 2);
  EXPECT_EQ(rig.rig.depth_sensor.bias.multipliers.size(), 8U);
  EXPECT_EQ(rig.depth.serial, "D1");
  EXPECT_EQ(rig.depth.model, "a, b");
  EXPECT_EQ(rig.depth.rate_hz, 30.0);
}

/// Poses are assessed where they are used, so wrong numbers arrive as they are.
TEST_F(MessageRoundTripTest, ExternalOdometryArrivesAsItWasWrittenRightOrWrong) {
  ExternalOdometrySample sent{.session = 3, .number = 12, .pose = {}};
  sent.pose.source = "vio";
  sent.pose.time = CaptureTimeFromNanoseconds(1'700'000'000'123'456'789);
  sent.pose.time_sigma = 40us;
  sent.pose.translation_m = {1.0, -2.0, std::numeric_limits<double>::quiet_NaN()};
  sent.pose.rotation.coeffs() = Eigen::Vector4d(0.1, 0.2, 0.3, 4.0);
  sent.pose.rotation_sigma_rad = 0.01;
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const ExternalOdometry& pose = received->message.pose;
  EXPECT_EQ(received->message.session, 3U);
  EXPECT_EQ(received->message.number, 12U);
  EXPECT_EQ(pose.source, "vio");
  EXPECT_EQ(pose.time, sent.pose.time);
  EXPECT_EQ(pose.time_sigma, sent.pose.time_sigma);
  EXPECT_EQ(pose.translation_m.y(), -2.0);
  EXPECT_TRUE(std::isnan(pose.translation_m.z()));
  EXPECT_EQ(pose.rotation.coeffs(), sent.pose.rotation.coeffs());
  EXPECT_TRUE(std::isnan(pose.position_sigma_m)) << "not known";
  EXPECT_TRUE(pose.has_position());
  EXPECT_EQ(pose.rotation_sigma_rad, 0.01);
  sent.pose.position_sigma_m = ExternalOdometry::kNotMeasured;
  EXPECT_FALSE(RoundTrip(sent)->message.pose.has_position());
}

TEST_F(MessageRoundTripTest, StatusArrivesWithItsDropReasons) {
  EdgeStatus sent;
  sent.session = 5;
  sent.scan_state = ScanState::kEnded;
  sent.depth.published = 100;
  sent.depth.next_frame_number = 103;
  sent.depth.dropped = {{"queue full", 2}, {"clock model warming up", 1}};
  sent.clock.max_error_s = 0.002;
  sent.depth_camera = {CameraState::kLost, 3, 0.0001, 0.0004, 0.0, 0};
  sent.feedback = {.count = 50, .p50_s = 0.05, .p99_s = 0.11};
  sent.nuc = {.state = NucState::kDesired,
              .source = NucSource::kPolled,
              .policy = NucPolicy::kCamera,
              .seconds_since = 12.5,
              .closings_per_minute = 9,
              .closed_fraction = 0.25,
              .storm = true,
              .warming_up = true,
              .housing_celsius = 31.5,
              .reason = "drift"};
  for (std::int64_t i = 0; i < 10; ++i)
    sent.marks.push_back({CaptureTimeFromNanoseconds(i), fmt::format("place {}", i)});
  sent.served_ground = 0xFEDCBA9876543210;
  sent.spool_bytes = 42'000'000;
  sent.frames_gone = 17;
  sent.spool_keeps_s = 12.5;
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const EdgeStatus& status = received->message;
  EXPECT_EQ(status.scan_state, ScanState::kEnded);
  EXPECT_EQ(status.depth.next_frame_number, 103U);
  ASSERT_EQ(status.depth.dropped.size(), 2U);
  EXPECT_EQ(status.depth.dropped[1].reason, "clock model warming up");
  EXPECT_EQ(status.depth.dropped[0].frames, 2U);
  EXPECT_EQ(status.clock.max_error_s, 0.002);
  EXPECT_EQ(status.depth_camera.state, CameraState::kLost);
  EXPECT_EQ(status.depth_camera.failures, 3U);
  EXPECT_EQ(status.depth_camera.stamping_p50_s, 0.0001);
  EXPECT_EQ(status.depth_camera.stamping_p99_s, 0.0004);
  EXPECT_EQ(status.thermal_camera.state, CameraState::kNone);
  EXPECT_TRUE(std::isnan(status.thermal_camera.stamping_p99_s));
  EXPECT_EQ(status.feedback.count, 50U);
  EXPECT_EQ(status.feedback.p50_s, 0.05);
  EXPECT_EQ(status.feedback.p99_s, 0.11);
  EXPECT_TRUE(std::isnan(status.cpu_temperature_celsius));
  EXPECT_EQ(status.nuc.state, NucState::kDesired);
  EXPECT_EQ(status.nuc.source, NucSource::kPolled);
  EXPECT_EQ(status.nuc.policy, NucPolicy::kCamera);
  EXPECT_EQ(status.nuc.seconds_since, 12.5);
  EXPECT_EQ(status.nuc.closings_per_minute, 9U);
  EXPECT_EQ(status.nuc.closed_fraction, 0.25);
  EXPECT_TRUE(status.nuc.storm);
  EXPECT_TRUE(status.nuc.warming_up);
  EXPECT_TRUE(std::isnan(status.nuc.fpa_celsius));
  EXPECT_EQ(status.nuc.housing_celsius, 31.5);
  EXPECT_EQ(status.nuc.reason, "drift");
  EXPECT_EQ(status.served_ground, sent.served_ground);
  EXPECT_EQ(status.spool_bytes, sent.spool_bytes);
  EXPECT_EQ(status.frames_gone, sent.frames_gone);
  EXPECT_EQ(status.spool_keeps_s, sent.spool_keeps_s);
  ASSERT_EQ(status.marks.size(), kMaxMarks);
  EXPECT_EQ(status.marks.front(), sent.marks[2]) << "the oldest were sent before";
  EXPECT_EQ(status.marks.back(), sent.marks[9]);
}

TEST_F(MessageRoundTripTest, CommandAndItsResultArrive) {
  const auto command = RoundTrip(
      Command{.number = 3, .kind = CommandKind::kSetNucPolicy, .nuc_policy = NucPolicy::kManual});
  ASSERT_TRUE(command.has_value());
  EXPECT_EQ(command->message.number, 3U);
  EXPECT_EQ(command->message.kind, CommandKind::kSetNucPolicy);
  EXPECT_EQ(command->message.nuc_policy, NucPolicy::kManual);
  const auto hold = RoundTrip(Command{.number = 4, .kind = CommandKind::kHoldNuc, .hold_s = 12.5});
  ASSERT_TRUE(hold.has_value());
  EXPECT_EQ(hold->message.kind, CommandKind::kHoldNuc);
  EXPECT_EQ(hold->message.hold_s, 12.5);
  const auto mark = RoundTrip(Command{.kind = CommandKind::kMark, .text = "left burner"});
  ASSERT_TRUE(mark.has_value());
  EXPECT_EQ(mark->message.kind, CommandKind::kMark);
  EXPECT_EQ(mark->message.text, "left burner");
  const auto result = RoundTrip(
      CommandResult{.number = 3, .outcome = CommandOutcome::kRefused, .text = "scan is running"});
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->message.outcome, CommandOutcome::kRefused);
  EXPECT_EQ(result->message.text, "scan is running");
}

TEST_F(MessageRoundTripTest, ReceiptCarriesTheNewestHoles) {
  Receipt sent;
  sent.session = 4;
  sent.depth = {.next = 1000, .handled = 990, .received = 800};
  for (std::uint64_t i = 0; i < 100; ++i) sent.depth.holes.push_back({i * 10, i * 10 + 1});
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  ASSERT_EQ(received->message.depth.holes.size(), kMaxHoles);
  EXPECT_EQ(received->message.depth.holes.back(), (FrameRange{990, 991}));
  EXPECT_EQ(received->message.depth.handled, 990U);
}

TEST_F(MessageRoundTripTest, FeedbackArrivesAsItWasWritten) {
  Feedback sent;
  sent.session = 1;
  sent.frame_number = 77;
  sent.tracking_state = TrackingState::kTracked;
  sent.T_world_depth = MakeTransform({1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  sent.model = {.good = 0.5F, .acceptable = 0.25F, .bad = 0.125F, .never_measured = 0.125F};
  sent.advice = {Advice::kSlower, Advice::kMoveCloser};
  sent.image.assign(kMaxConfidenceImageBytes, 0xAB);
  sent.latencies = {{"track", 0.006F, 0.012F}};
  sent.pose_covariance.emplace();  // Each of its 21 numbers another one, diagonally dominant.
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      (*sent.pose_covariance)(i, j) = (*sent.pose_covariance)(j, i) =
          i == j ? 100.0 + i : 1.0 + 6 * i + j;
    }
  }
  sent.advice_reason = "0.45 m/s, the model follows up to 0.30 m/s";
  sent.frames_left_out = 764;
  sent.link = "to come from the rig's recording: 640 frames";
  sent.done = true;
  sent.T_depth_next = MakeTransform({0.1, 0, 0.2}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5));
  sent.next_gain_m2 = 0.25;
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const Feedback& feedback = received->message;
  ASSERT_TRUE(feedback.T_world_depth.has_value());
  EXPECT_TRUE(feedback.T_world_depth->isApprox(*sent.T_world_depth, 1e-12));
  EXPECT_FALSE(feedback.T_world_depth_next.has_value());
  EXPECT_EQ(feedback.model.good, 0.5F);
  EXPECT_TRUE(std::isnan(feedback.view.good));
  EXPECT_THAT(feedback.advice, testing::ElementsAre(Advice::kSlower, Advice::kMoveCloser));
  EXPECT_EQ(feedback.image, sent.image);
  ASSERT_EQ(feedback.latencies.size(), 1U);
  EXPECT_EQ(feedback.latencies[0].stage, "track");
  ASSERT_TRUE(feedback.pose_covariance.has_value());
  EXPECT_EQ(*feedback.pose_covariance, *sent.pose_covariance);
  const auto without = RoundTrip(Feedback());
  ASSERT_TRUE(without.has_value());
  EXPECT_FALSE(without->message.pose_covariance.has_value());
  EXPECT_EQ(feedback.advice_reason, sent.advice_reason);
  EXPECT_EQ(feedback.frames_left_out, sent.frames_left_out);
  EXPECT_EQ(feedback.link, sent.link);
  EXPECT_TRUE(feedback.done);
  ASSERT_TRUE(feedback.T_depth_next.has_value());
  EXPECT_TRUE(feedback.T_depth_next->isApprox(*sent.T_depth_next, 1e-12));
  EXPECT_EQ(feedback.next_gain_m2, 0.25);
}

TEST_F(MessageRoundTripTest, ARequestForARecordingArrivesAsItWasWritten) {
  const RecordingRequest sent{.asker = UINT64_MAX,
                              .number = 2,
                              .kind = RecordingRequestKind::kChecksum,
                              .recording = "edge-20231114-221320-0123abcd.mcap",
                              .offset = std::uint64_t{1} << 40U,
                              .length = kMaxChecksumBytes};
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->edge_id, "edge-1");
  EXPECT_EQ(received->message.asker, sent.asker);
  EXPECT_EQ(received->message.number, sent.number);
  EXPECT_EQ(received->message.kind, sent.kind);
  EXPECT_EQ(received->message.recording, sent.recording);
  EXPECT_EQ(received->message.offset, sent.offset);
  EXPECT_EQ(received->message.length, sent.length);
}

TEST_F(MessageRoundTripTest, APieceOfARecordingArrivesAsItWasWritten) {
  RecordingPiece sent{.asker = 1,
                      .number = UINT64_MAX,
                      .outcome = RecordingOutcome::kBusy,
                      .recording = "scan.mcap",
                      .size = 17'000'000'000,
                      .written = CaptureTimeFromNanoseconds(1'700'000'000'123'456'789),
                      .offset = 16'999'900'000,
                      .crc = 0xCBF43926};
  sent.bytes.assign(kMaxPieceBytes, 0xAB);
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const RecordingPiece& piece = received->message;
  EXPECT_EQ(piece.asker, sent.asker);
  EXPECT_EQ(piece.number, sent.number);
  EXPECT_EQ(piece.outcome, sent.outcome);
  EXPECT_EQ(piece.recording, sent.recording);
  EXPECT_EQ(piece.size, sent.size);
  EXPECT_EQ(piece.written, sent.written);
  EXPECT_EQ(piece.offset, sent.offset);
  EXPECT_EQ(piece.bytes, sent.bytes);
  EXPECT_EQ(piece.crc, sent.crc);
}

}  // namespace
}  // namespace isotherm
