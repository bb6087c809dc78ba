#pragma once

#include <cstdint>
#include <optional>

#include "common/frame/frame.h"
#include "edge/nuc/image_watch.h"

namespace isotherm {

/// Holds what one thermal frame tells about the correction.
struct NucObservation {
  CaptureTime time{};
  bool shutter_closed = false;        ///< The camera says so in the frame.
  std::optional<CameraNuc> camera{};  ///< The camera's own report; nullopt = none.
  ThermalHousekeeping housekeeping{};
  ImageEvidence image{};
};

}  // namespace isotherm
