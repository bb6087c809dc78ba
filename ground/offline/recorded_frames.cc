#include "ground/offline/recorded_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "common/codec/codec.h"

namespace isotherm {
namespace {

Status LeftOut(const char* stream, const FrameHeader& header, const Status& error) {
  return Status(error.code(), fmt::format("{} frame {} left out: {}", stream, header.frame_number,
                                          error.message()));
}

}  // namespace

void ReadItems(RecordingReader& reader, const std::function<void(RecordedItem&)>& take,
               const std::function<void(const Status&)>& fail,
               const std::function<void(double)>& progress, const std::stop_token& stop) {
  std::uint64_t total = 0, read = 0;
  for (const auto& [topic, count] : reader.info().messages_by_topic) total += count;
  while (!stop.stop_requested()) {
    Result<std::optional<RecordedItem>> item = reader.Next();
    ++read;
    if (!item) {
      fail(item.error());
    } else if (!*item) {
      return;
    } else {
      take(**item);
      if (progress && total > 0)
        progress(std::min(1.0, static_cast<double>(read) / static_cast<double>(total)));
    }
  }
}

Result<DepthFramePtr> Unpack(const RecordedDepth& recorded, std::optional<double> depth_scale) {
  Result<Image<std::uint16_t>> image = Decode(recorded.frame.image);
  if (!image) return Err(LeftOut("depth", recorded.frame.header, image.error()));
  auto frame = std::make_shared<DepthFrame>();
  frame->header = recorded.frame.header;
  frame->depth_scale = depth_scale.value_or(recorded.frame.depth_scale);
  frame->depth_raw = std::move(*image);
  return frame;
}

Result<ThermalFramePtr> Unpack(const RecordedThermal& recorded, Nanoseconds thermal_delay) {
  const EncodedThermalFrame& encoded = recorded.frame;
  Result<Image<std::uint16_t>> image = DecodeTemperatures(encoded.image);
  if (!image) return Err(LeftOut("thermal", encoded.header, image.error()));
  auto frame = std::make_shared<ThermalFrame>();
  frame->header = encoded.header;
  frame->header.capture_time += thermal_delay;
  frame->nuc_state = encoded.nuc_state;
  frame->nuc_source = encoded.nuc_source;
  frame->seconds_since_nuc = encoded.seconds_since_nuc;
  frame->housekeeping = encoded.housekeeping;
  frame->valid = encoded.valid && encoded.image.encoding != Encoding::kCounts16;
  frame->scale = encoded.scale;
  frame->temperature_raw = std::move(*image);
  return frame;
}

}  // namespace isotherm
