#pragma once

#include <cstdint>
#include <vector>

#include "common/frame/frame.h"

namespace isotherm {

/// Frames of one stream that an earlier process of the ground has recorded.
struct RecordedNumbers {
  struct Frame {
    std::uint64_t number = 0;
    CaptureTime time{};
  };

  std::uint64_t session = 0;
  Sensor sensor = Sensor::kDepth;
  std::vector<Frame> frames;
};

}  // namespace isotherm
