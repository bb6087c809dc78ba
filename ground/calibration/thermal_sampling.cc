#include "ground/calibration/thermal_sampling.h"

#include <algorithm>
#include <cmath>

#include "common/frame/gaussian_blur.h"

namespace isotherm {

std::optional<ThermalSample> SampleThermal(const Image<std::uint16_t>& image,
                                           const RadiometricScale& scale,
                                           const Eigen::Vector2d& pixel) {
  if (!(pixel.x() >= 1.0 && pixel.y() >= 1.0 && pixel.x() < image.width() - 2 &&
        pixel.y() < image.height() - 2))
    return std::nullopt;
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  const double a = pixel.x() - x, b = pixel.y() - y;
  const double v00 = image.At(x, y), v10 = image.At(x + 1, y);
  const double v01 = image.At(x, y + 1), v11 = image.At(x + 1, y + 1);
  if (v00 == 0.0 || v10 == 0.0 || v01 == 0.0 || v11 == 0.0) return std::nullopt;
  const double top = v00 + a * (v10 - v00), bottom = v01 + a * (v11 - v01);
  const Eigen::Vector2d gradient((1.0 - b) * (v10 - v00) + b * (v11 - v01), bottom - top);
  return ThermalSample{scale.Kelvin(top + b * (bottom - top)), scale.kelvin_per_count * gradient};
}

Image<std::uint16_t> BlurKnownPixels(const Image<std::uint16_t>& image,
                                     std::span<const float> weights) {
  Image<float> values(image.width(), image.height()), known(image.width(), image.height());
  Image<float> scratch;
  bool all_known = true;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint16_t value = image.pixels()[i];
    values.pixels()[i] = value;
    known.pixels()[i] = value != 0 ? 1.0F : 0.0F;
    all_known = all_known && value != 0;
  }
  Blur(weights, values, scratch);
  if (!all_known) Blur(weights, known, scratch);
  Image<std::uint16_t> blurred(image.width(), image.height());
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (image.pixels()[i] == 0) continue;
    const float value = all_known ? values.pixels()[i] : values.pixels()[i] / known.pixels()[i];
    blurred.pixels()[i] = static_cast<std::uint16_t>(std::lround(std::max(1.0F, value)));
  }
  return blurred;
}

}  // namespace isotherm
