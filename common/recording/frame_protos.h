#pragma once

#include "common/recording/foxglove.pb.h"
#include "common/recording/recording.h"

/// Between frames and their messages in a recording.
namespace isotherm::recording {

/// Image is a foxglove::RawImage or foxglove::CompressedImage; what is returned has no image data
/// yet.
template <typename Image>
Image ToMessage(const EncodedDepthFrame& frame, const std::optional<CaptureTime>& arrival);
template <typename Image>
Image ToMessage(const EncodedThermalFrame& frame, const std::optional<CaptureTime>& arrival);
void SetImageData(EncodedImage&& image, foxglove::CompressedImage& message);
/// `image` must be raw (IsRaw).
void SetImageData(EncodedImage&& image, foxglove::RawImage& message);

/// `log_time` and `sequence` of the container stand in for what a foreign writer left out. Takes
/// the image data out of `message`.
template <typename Image>
Result<RecordedDepth> ToDepth(Image& message, CaptureTime log_time, std::uint32_t sequence);
template <typename Image>
Result<RecordedThermal> ToThermal(Image& message, CaptureTime log_time, std::uint32_t sequence);

}  // namespace isotherm::recording
