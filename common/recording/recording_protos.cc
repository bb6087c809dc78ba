#include "common/recording/recording_protos.h"

#include <cmath>
#include <utility>
#include <vector>

#include "common/recording/proto_parts.h"
#include "common/rig/rig_calibration.h"

namespace isotherm::recording {
namespace {

constexpr std::string_view kWorldFrame = "world";

/// A lens as Foxglove names it, and its coefficients in its order.
struct NamedDistortion {
  const char* name;
  std::vector<double> coefficients;
};

NamedDistortion DistortionOf(const CameraModel& c) {
  switch (c.lens) {
    case LensKind::kBrownConrady:
      break;
    case LensKind::kRational:
      return {"rational_polynomial", {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6}};
    case LensKind::kFisheye:
      return {"kannala_brandt", {c.k1, c.k2, c.k3, c.k4}};
  }
  return {"plumb_bob", {c.k1, c.k2, c.p1, c.p2, c.k3}};
}

Eigen::Vector3d ToVector(const foxglove::Vector3& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Quaterniond ToQuaternion(const foxglove::Quaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

foxglove::CameraCalibration ToMessage(CaptureTime time, std::string_view frame_id,
                                      const CameraModel& camera) {
  foxglove::CameraCalibration message;
  SetTime(time, *message.mutable_timestamp());
  message.set_frame_id(std::string(frame_id));
  message.set_width(static_cast<std::uint32_t>(camera.width));
  message.set_height(static_cast<std::uint32_t>(camera.height));
  const NamedDistortion distortion = DistortionOf(camera);
  message.set_distortion_model(distortion.name);
  for (const double d : distortion.coefficients) message.add_d(d);
  // Row-major K, R and P as ROS defines them: no rectification, and P is K without a baseline.
  for (const double k : {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0}) {
    message.add_k(k);
  }
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.add_r(r);
  for (const double p :
       {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0}) {
    message.add_p(p);
  }
  return message;
}

foxglove::PoseInFrame ToMessage(const ExternalOdometry& pose) {
  foxglove::PoseInFrame message;
  SetTime(pose.time, *message.mutable_timestamp());
  message.set_frame_id(pose.source);
  SetVector(pose.translation_m, *message.mutable_pose()->mutable_position());
  SetQuaternion(pose.rotation, *message.mutable_pose()->mutable_orientation());
  ExternalOdometryInfo& info = *message.mutable_external_odometry();
  info.set_time_sigma_ns(pose.time_sigma.count());
  // A position that is not measured has an infinite sigma and keeps it; one whose sigma is not
  // known has none.
  if (!std::isnan(pose.position_sigma_m)) info.set_position_sigma_m(pose.position_sigma_m);
  if (!std::isnan(pose.rotation_sigma_rad)) info.set_rotation_sigma_rad(pose.rotation_sigma_rad);
  return message;
}

namespace {

foxglove::FrameTransform MakeTransformMessage(CaptureTime time, std::string_view parent,
                                              std::string_view child,
                                              const RigidTransform& T_parent_child) {
  foxglove::FrameTransform message;
  SetTime(time, *message.mutable_timestamp());
  message.set_parent_frame_id(std::string(parent));
  message.set_child_frame_id(std::string(child));
  SetVector(T_parent_child.translation(), *message.mutable_translation());
  SetQuaternion(Eigen::Quaterniond(T_parent_child.linear()), *message.mutable_rotation());
  return message;
}

}  // namespace

foxglove::FrameTransform ToMessage(const StampedPose& pose) {
  return MakeTransformMessage(pose.time, kWorldFrame, kDepthFrame, pose.T_world_depth);
}

foxglove::FrameTransform ThermalTransform(CaptureTime time, const RigidTransform& T_thermal_depth) {
  // Foxglove's transforms give the child's pose in the parent, which is the inverse of what the rig
  // file says.
  return MakeTransformMessage(time, kDepthFrame, kThermalFrame, T_thermal_depth.inverse());
}

NucRecord ToMessage(const NucEvent& event) {
  NucRecord message;
  SetTime(event.start, *message.mutable_start());
  SetTime(event.end, *message.mutable_end());
  message.set_source(static_cast<std::uint32_t>(event.source));
  return message;
}

ClockStepRecord ToMessage(const ClockStep& step) {
  ClockStepRecord message;
  SetTime(step.time, *message.mutable_timestamp());
  message.set_step_ns(step.step.count());
  message.set_wall_minus_time_ns(step.wall_minus_time.count());
  return message;
}

RigRecord ToMessage(CaptureTime time, const Rig& rig) {
  RigRecord message;
  SetTime(time, *message.mutable_timestamp());
  *message.mutable_calibration() = ToProto(rig);
  return message;
}

foxglove::Log ToLogMessage(CaptureTime time, std::string_view level, std::string_view text) {
  foxglove::Log message;
  SetTime(time, *message.mutable_timestamp());
  std::string name(level);
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  foxglove::Log::Level parsed = foxglove::Log::UNKNOWN;
  foxglove::Log::Level_Parse(name, &parsed);
  message.set_level(parsed);
  message.set_message(std::string(text));
  message.set_name("isotherm");
  return message;
}

Result<RecordedLog> FromMessage(const foxglove::Log& message) {
  const std::optional<CaptureTime> time = ToTime(message.timestamp());
  if (!time) return Err(DataLoss("its time is impossible"));
  std::string level = foxglove::Log::Level_Name(message.level());
  for (char& c : level) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return RecordedLog{*time, std::move(level), message.message()};
}

Result<StampedPose> FromMessage(const foxglove::FrameTransform& message) {
  const std::optional<CaptureTime> time = ToTime(message.timestamp());
  if (!time) return Err(DataLoss("its timestamp is out of range"));
  const Eigen::Vector3d translation = ToVector(message.translation());
  const Eigen::Quaterniond rotation = ToQuaternion(message.rotation());
  // Shorter quaternions have no direction left to normalise.
  constexpr double kMinNorm = 1e-6;
  if (!translation.allFinite() || !(rotation.norm() > kMinNorm) ||
      !std::isfinite(rotation.norm())) {
    return Err(DataLoss("its pose is not finite"));
  }
  return StampedPose{.time = *time, .T_world_depth = MakeTransform(translation, rotation)};
}

Result<ExternalOdometry> FromMessage(const foxglove::PoseInFrame& message) {
  const std::optional<CaptureTime> time = ToTime(message.timestamp());
  if (!time) return Err(DataLoss("its timestamp is out of range"));
  ExternalOdometry pose;
  pose.source = message.frame_id();
  pose.time = *time;
  pose.translation_m = ToVector(message.pose().position());
  pose.rotation = ToQuaternion(message.pose().orientation());
  const ExternalOdometryInfo& info = message.external_odometry();
  pose.time_sigma = Nanoseconds(info.time_sigma_ns());
  if (info.has_position_sigma_m()) pose.position_sigma_m = info.position_sigma_m();
  if (info.has_rotation_sigma_rad()) pose.rotation_sigma_rad = info.rotation_sigma_rad();
  return pose;
}

Result<NucEvent> FromMessage(const NucRecord& message) {
  const std::optional<CaptureTime> start = ToTime(message.start());
  const std::optional<CaptureTime> end = ToTime(message.end());
  if (!start || !end) return Err(DataLoss("its times are out of range"));
  return NucEvent{.start = *start,
                  .end = *end,
                  .source = KnownOr(message.source(), NucSource::kInferred, NucSource::kUnknown)};
}

Result<ClockStep> FromMessage(const ClockStepRecord& message) {
  const std::optional<CaptureTime> time = ToTime(message.timestamp());
  if (!time) return Err(DataLoss("its time is out of range"));
  return ClockStep{.time = *time,
                   .step = Nanoseconds(message.step_ns()),
                   .wall_minus_time = Nanoseconds(message.wall_minus_time_ns())};
}

}  // namespace isotherm::recording
