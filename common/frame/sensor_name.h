#pragma once

#include <string_view>

#include "common/frame/frame.h"

namespace isotherm {

/// Returns "depth" or "thermal": the name of a camera and of its stream, in messages and files.
constexpr std::string_view NameOf(Sensor sensor) {
  return sensor == Sensor::kDepth ? "depth" : "thermal";
}

}  // namespace isotherm
