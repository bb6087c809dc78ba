#pragma once

#include <filesystem>
#include <string>

#include "common/base/status.h"
#include "common/recording/recording.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

/// Thermal frame in false colours with a legend; pixels without a value are striped grey.
RgbImage ThermalRendering(const Image<std::uint16_t>& temperature_raw,
                          const RadiometricScale& scale);

/// Temperatures in °C in false colours with a legend; NaN is striped grey.
RgbImage TemperatureRendering(const Image<float>& celsius, const std::string& title);

/// Depth frame by distance with a legend in metres; pixels without a return are striped grey.
RgbImage DepthRendering(const Image<std::uint16_t>& depth_raw, double depth_scale);

/// Renders the frame with the given place in its stream (from 0) into a PNG file.
Status RenderFrame(RecordingReader& reader, Sensor sensor, std::uint64_t place,
                   const std::filesystem::path& png);

}  // namespace isotherm
