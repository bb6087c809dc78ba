#pragma once

#include "common/frame/frame.h"
#include "ground/console/live.pb.h"

namespace isotherm {

/// A camera's image as it was received, thinned out to at most `max_width` columns, in grey with
/// what black and white mean. Empty (no png) if no pixel has a value.
live::CameraImage ToCameraImage(const DepthFrame& frame, int max_width);
live::CameraImage ToCameraImage(const ThermalFrame& frame, int max_width);

/// The same with all its values as a serialised foxglove.RawImage: depth in millimetres, thermal in
/// centi-kelvin, 0 = no value.
std::string ToRawImage(const DepthFrame& frame);
std::string ToRawImage(const ThermalFrame& frame);

}  // namespace isotherm
