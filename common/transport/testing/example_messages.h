#pragma once

#include "common/transport/topics.h"

/// One good message of each kind, with something in every list. For tests only.
namespace isotherm {

template <typename Frame>
Frame GoodFrame() {
  Frame frame;
  frame.header = {.session = 7, .frame_number = 3};
  frame.image.width = 8;
  frame.image.height = 6;
  frame.image.payload.assign(96, 0x5A);
  return frame;
}
template <typename Message>
Message Good();
template <>
inline RecordingRequest Good() {
  return {.asker = 5,
          .number = 6,
          .kind = RecordingRequestKind::kRead,
          .recording = "scan.mcap",
          .offset = 7,
          .length = 8};
}
template <>
inline RecordingPiece Good() {
  return {.asker = 5,
          .number = 6,
          .outcome = RecordingOutcome::kDone,
          .recording = "scan.mcap",
          .size = 70,
          .written = CaptureTime(std::chrono::seconds(1'700'000'000)),
          .offset = 7,
          .bytes = {1, 2, 3},
          .crc = 9};
}
template <>
inline FramePiece Good() {
  FramePiece piece{.session = 7,
                   .sensor = Sensor::kThermal,
                   .frame_number = 3,
                   .sent = std::chrono::seconds(5),
                   .order = 1'000,
                   .frame_bytes = 80'000,
                   .frame_crc = 0xCBF43926,
                   .index = 12};
  piece.bytes.assign(kMinFramePieceBytes, 0x5A);
  return piece;
}
template <>
inline PieceReport Good() {
  return {.session = 7,
          .next_order = 1'000,
          .received = 990,
          .frames = 12,
          .broken = 1,
          .queued = std::chrono::milliseconds(20)};
}
template <>
inline EncodedDepthFrame Good() {
  auto frame = GoodFrame<EncodedDepthFrame>();
  frame.depth_scale = 1000.0;
  return frame;
}
template <>
inline EncodedThermalFrame Good() {
  auto frame = GoodFrame<EncodedThermalFrame>();
  frame.image.encoding = Encoding::kScaledRaw16;
  frame.scale = {0.02, 12.5};
  return frame;
}
template <>
inline RigDescription Good() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  RigDescription rig;
  rig.rig.depth = rig.rig.thermal = camera;
  rig.rig.T_thermal_depth = RigidTransform::Identity();
  rig.rig.serial = "RIG-1";
  rig.depth = {.width = 640, .height = 480, .rate_hz = 30.0, .serial = "D", .model = "a camera"};
  return rig;
}
template <>
inline ExternalOdometrySample Good() {
  ExternalOdometrySample sample{.session = 7, .number = 4, .pose = {}};
  sample.pose.source = "vio";
  return sample;
}
template <>
inline EdgeStatus Good() {
  EdgeStatus status;
  status.session = 7;
  status.depth.dropped = {{"queue full", 2}, {"late", 1}};
  status.thermal.dropped = {{"queue full", 1}};
  status.clock_echo = {.ping = 5, .received = {}, .sent = {}};
  status.nuc.reason = "drift";
  status.marks = {{CaptureTimeFromNanoseconds(9), "left burner"},
                  {CaptureTimeFromNanoseconds(12), "right burner"}};
  status.served_ground = 0x1122334455667788;
  status.spool_bytes = 9'000'000;
  status.frames_gone = 12;
  status.spool_keeps_s = 11.0;
  return status;
}
template <>
inline Command Good() {
  return {.number = 5, .kind = CommandKind::kMark, .hold_s = 3.0, .text = "left burner"};
}
template <>
inline CommandResult Good() {
  return {.number = 5, .outcome = CommandOutcome::kRefused, .text = "not now"};
}
template <>
inline Receipt Good() {
  Receipt receipt{.session = 7, .depth = {}, .thermal = {}, .clock_ping = 9};
  receipt.depth = {.next = 50, .handled = 40, .received = 45, .holes = {{41, 43}, {46, 47}}};
  receipt.thermal = {.next = 50, .handled = 50, .received = 49, .holes = {{7, 7}}};
  return receipt;
}
template <>
inline Feedback Good() {
  Feedback feedback;
  feedback.session = 7;
  feedback.T_world_depth = feedback.T_depth_next = RigidTransform::Identity();
  feedback.model = feedback.view = {.good = 1, .acceptable = 0, .bad = 0, .never_measured = 0};
  feedback.advice = {Advice::kSlower, Advice::kDone};
  feedback.image.assign(33, 0x89);
  feedback.latencies = {{.stage = "track", .p50_s = 0.01F, .p99_s = 0.02F}};
  feedback.pose_covariance = PoseCovariance::Identity();
  feedback.advice_reason = "40 % is too far";
  feedback.frames_left_out = 3;
  feedback.link = "link good";
  return feedback;
}
template <>
inline Hello Good() {
  return {.role = Role::kGround, .software_version = "1.0", .host = "desk"};
}

}  // namespace isotherm
