#pragma once

#include <string>

#include "common/recording/foxglove.pb.h"
#include "common/recording/recording.h"
#include "common/recording/recording.pb.h"
#include "common/recording/recording_topics.h"

/// Between the types of a scan, but for its frames (frame_messages.h), and the messages in its
/// recording.
namespace isotherm::recording {

foxglove::CameraCalibration ToMessage(CaptureTime time, std::string_view frame_id,
                                      const CameraModel& camera);
foxglove::FrameTransform ToMessage(const StampedPose& pose);
/// Tells viewers where the thermal camera is on the rig: depth -> thermal.
foxglove::FrameTransform ThermalTransform(CaptureTime time, const RigidTransform& T_thermal_depth);
foxglove::PoseInFrame ToMessage(const ExternalOdometry& pose);
NucRecord ToMessage(const NucEvent& event);
ClockStepRecord ToMessage(const ClockStep& step);
RigRecord ToMessage(CaptureTime time, const Rig& rig);
foxglove::Log ToLogMessage(CaptureTime time, std::string_view level, std::string_view text);

Result<StampedPose> FromMessage(const foxglove::FrameTransform& message);
/// Checks nothing but the time: what the numbers are worth is assessed where they are used.
Result<ExternalOdometry> FromMessage(const foxglove::PoseInFrame& message);
Result<NucEvent> FromMessage(const NucRecord& message);
Result<ClockStep> FromMessage(const ClockStepRecord& message);
Result<RecordedLog> FromMessage(const foxglove::Log& message);

}  // namespace isotherm::recording
