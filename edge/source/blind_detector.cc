#include "edge/source/blind_detector.h"

#include "edge/options/edge_options.pb.h"

namespace isotherm {

BlindDetector::BlindDetector(const FrameCheckOptions& options)
    : min_valid_ratio_(options.expert().min_valid_ratio()),
      blind_after_(FromSeconds(options.expert().blind_after_s())) {}

bool BlindDetector::Update(const RawFrame& frame) {
  if (ValidRatio(frame.pixels) >= min_valid_ratio_) {
    dark_since_.reset();
    return false;
  }
  if (!dark_since_) dark_since_ = frame.arrival_wall;
  return frame.arrival_wall - *dark_since_ >= blind_after_;
}

double ValidRatio(const Image<std::uint16_t>& depth_raw) {
  if (depth_raw.empty()) return 0.0;
  std::uint32_t valid = 0;
  for (const std::uint16_t value : depth_raw.pixels()) {
    valid += value != kNoDepth && value != kNoDepthSaturated ? 1U : 0U;
  }
  return static_cast<double>(valid) / static_cast<double>(depth_raw.size());
}

}  // namespace isotherm
