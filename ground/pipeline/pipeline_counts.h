#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "ground/thermal/thermal_fuser.h"

namespace isotherm {

/// Holds what the pipeline did with the frames it was given: in = sum of the outcomes.
struct PipelineCounts {
  std::uint64_t depth_in = 0;
  std::uint64_t depth_repeated = 0;  ///< The image of the frame before again.
  std::uint64_t depth_tracked = 0;
  std::uint64_t depth_degraded = 0;     ///< Some of the tracked ones.
  std::uint64_t depth_unconfirmed = 0;  ///< Found again, but not yet believed.
  std::uint64_t depth_integrated = 0;   ///< Some of the tracked ones.
  std::uint64_t depth_behind = 0;       ///< Not integrated for want of time.
  std::uint64_t depth_refused = 0;      ///< Frames of another size than the calibration's.
  std::map<std::string, std::uint64_t> depth_lost;  ///< By reason.
  std::uint64_t thermal_in = 0;
  std::uint64_t thermal_fused = 0;
  std::map<std::string, std::uint64_t> thermal_left_out;  ///< By reason.
  FusionReport fusion;  ///< Sum over all fused frames; dropped counts the last review, too.
};

}  // namespace isotherm
