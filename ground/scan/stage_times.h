#pragma once

#include <cstdint>
#include <string_view>

#include "common/base/enum_array.h"
#include "common/base/stage_stats.h"

namespace isotherm {

/// The stages that the pipeline spends time on, in the order of their names, as in stats.json.
enum class Stage : std::uint8_t {
  kDepthFrame,  ///< All that a depth frame does to the geometric model; the next ones are parts.
  kIntegrate,
  kMerge,  ///< Once, at the end: sub-maps become one model.
  kPreprocess,
  kRaycast,
  kRelocalise,  ///< Instead of kTrack while the rig is lost.
  kSubMaps,
  kThermalFrame,
  kTrack,
  kCount
};
/// "depth_frame", as in stats.json.
std::string_view ToString(Stage stage);

/// Milliseconds per call of each stage, where the stage itself counts them; nullptr if the scan has
/// had no such stage.
using StageTimes = EnumArray<Stage, const StageStats*>;

}  // namespace isotherm
