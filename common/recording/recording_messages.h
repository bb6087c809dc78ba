#pragma once

#include <string>

#include "common/recording/foxglove.pb.h"
#include "common/recording/recording.h"
#include "common/recording/recording.pb.h"
#include "common/recording/recording_topics.h"

/// Between the types of a scan and the messages in its recording.
namespace isotherm::recording {

/// Raw is a foxglove::RawImage or foxglove::CompressedImage without image data.
template <typename Image>
Image ToMessage(const EncodedDepthFrame& frame, const std::optional<CaptureTime>& arrival);
template <typename Image>
Image ToMessage(const EncodedThermalFrame& frame, const std::optional<CaptureTime>& arrival);
void SetImageData(EncodedImage&& image, foxglove::CompressedImage& message);
/// `image` must be raw (IsRaw).
void SetImageData(EncodedImage&& image, foxglove::RawImage& message);

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

/// `log_time` and `sequence` of the container stand in for what a foreign writer left out. Takes
/// the image data out of `message`.
template <typename Image>
Result<RecordedDepth> ToDepth(Image& message, CaptureTime log_time, std::uint32_t sequence);
template <typename Image>
Result<RecordedThermal> ToThermal(Image& message, CaptureTime log_time, std::uint32_t sequence);
Result<StampedPose> FromMessage(const foxglove::FrameTransform& message);
/// Checks nothing but the time: what the numbers are worth is assessed where they are used.
Result<ExternalOdometry> FromMessage(const foxglove::PoseInFrame& message);
Result<NucEvent> FromMessage(const NucRecord& message);
Result<ClockStep> FromMessage(const ClockStepRecord& message);
Result<RecordedLog> FromMessage(const foxglove::Log& message);

}  // namespace isotherm::recording
