#include "ground/cli/frame_rendering.h"

#include <fmt/format.h>

#include <cmath>

#include "common/codec/codec.h"
#include "common/frame/sensor_name.h"
#include "ground/export/png_file.h"
#include "ground/options/ground_options.pb.h"
#include "ground/renderer/legend.h"
#include "ground/renderer/palette.h"
#include "ground/renderer/temperature_scale.h"

namespace isotherm {
namespace {

// Colours `values` (NaN = none); the scale's "temperatures" are in the legend's unit.
RgbImage Rendering(const Image<float>& values, const RendererOptions& options,
                   const std::string& title, const std::string& unit) {
  const ColourTable colours(options);
  const std::optional<TemperatureScale> scale = ChooseScale(options, values.pixels());
  RgbImage rendering(values.width(), values.height());
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      const float value = values.At(x, y);
      rendering.At(x, y) = scale && std::isfinite(value) ? colours.At(scale->Fraction(value))
                                                         : NeverMeasuredColour(x, y, 1.0);
    }
  }
  ScaleLegend legend;
  legend.title = title;
  legend.scale = scale;
  legend.rule = ScaleRuleName(options);
  legend.unit.name = unit;
  return WithLegend(rendering, legend,
                    [&](double value) { return colours.At(scale->Fraction(value)); });
}

// Zeroes are no values, as in temperatures.
RgbImage CountsRendering(const Image<std::uint16_t>& counts) {
  Image<float> values(counts.width(), counts.height(), NAN);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (counts.pixels()[i] != 0) values.pixels()[i] = counts.pixels()[i];
  }
  RendererOptions options;
  options.set_palette(Palette::GREY);
  return Rendering(values, options, "thermal image", "counts");
}

Result<RgbImage> RenderingOf(const RecordedItem& item) {
  const auto* depth = std::get_if<RecordedDepth>(&item);
  const auto* thermal = std::get_if<RecordedThermal>(&item);
  if (depth == nullptr && thermal == nullptr) return Err(InvalidArgument("not an image"));
  const Result<Image<std::uint16_t>> image =
      Decode(depth != nullptr ? depth->frame.image : thermal->frame.image);
  if (!image) return Err(image.error());
  if (depth != nullptr) return DepthRendering(*image, depth->frame.depth_scale);
  return thermal->frame.image.encoding == Encoding::kCounts16
             ? CountsRendering(*image)
             : ThermalRendering(*image, thermal->frame.scale);
}

}  // namespace

RgbImage ThermalRendering(const Image<std::uint16_t>& temperature_raw,
                          const RadiometricScale& scale) {
  Image<float> celsius(temperature_raw.width(), temperature_raw.height(), NAN);
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    const std::uint16_t raw = temperature_raw.pixels()[i];
    if (raw != 0) celsius.pixels()[i] = scale.Celsius(raw);
  }
  return TemperatureRendering(celsius, "apparent temperature");
}

RgbImage TemperatureRendering(const Image<float>& celsius, const std::string& title) {
  return Rendering(celsius, RendererOptions(), title, "\u00B0C");
}

RgbImage DepthRendering(const Image<std::uint16_t>& depth_raw, double depth_scale) {
  Image<float> metres(depth_raw.width(), depth_raw.height(), NAN);
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const std::uint16_t raw = depth_raw.pixels()[i];
    if (raw != kNoDepth && raw != kNoDepthSaturated)
      metres.pixels()[i] = static_cast<float>(raw / depth_scale);
  }
  RendererOptions options;
  options.set_palette(Palette::GREY);
  return Rendering(metres, options, "distance", "m");
}

Status RenderFrame(RecordingReader& reader, Sensor sensor, std::uint64_t place,
                   const std::filesystem::path& png) {
  std::uint64_t seen = 0;
  for (;;) {
    const Result<std::optional<RecordedItem>> item = reader.Next();
    if (!item) continue;  // Inspect counts what cannot be read.
    if (!*item) break;
    const bool wanted = sensor == Sensor::kDepth ? std::holds_alternative<RecordedDepth>(**item)
                                                 : std::holds_alternative<RecordedThermal>(**item);
    if (!wanted || seen++ != place) continue;
    const Result<RgbImage> rendering = RenderingOf(**item);
    if (!rendering) return rendering.error();
    return WritePng(*rendering, png);
  }
  return InvalidArgument(
      fmt::format("there is no {} frame {}: the recording has {} (numbered from 0)", NameOf(sensor),
                  place, seen));
}

}  // namespace isotherm
