#include "ground/calibration/own_temperatures.h"

#include <algorithm>
#include <cmath>

namespace isotherm {

Eigen::Vector2d OwnTemperatures::ByFractions(const Eigen::Vector2d& pixel) const {
  return -gain * Eigen::Vector2d(means.NearAt(pixel.x(), pixel.y()), means.total);
}

SceneInfluence Convergent(const SceneInfluence& influence) {
  SceneInfluence convergent = influence;
  for (double* fraction : {&convergent.near_fraction, &convergent.total_fraction}) {
    *fraction = std::clamp(*fraction, -SceneInfluence::kMaxFraction, SceneInfluence::kMaxFraction);
  }
  return convergent;
}

OwnTemperatures FindOwnTemperatures(const Image<std::uint16_t>& temperature_raw,
                                    const RadiometricScale& scale,
                                    const SceneInfluence& influence) {
  const int width = temperature_raw.width(), height = temperature_raw.height();
  Image<float> celsius(width, height);
  std::ranges::transform(
      temperature_raw.pixels(), celsius.pixels().begin(),
      [&](std::uint16_t count) { return count == 0 ? NAN : scale.Celsius(count); });
  SceneInfluenceCorrector corrector(influence, width, height);
  corrector.Correct(celsius);
  OwnTemperatures own{Image<std::uint16_t>(width, height), corrector.means(),
                      1.0 / (1.0 - influence.Total())};
  std::ranges::transform(celsius.pixels(), own.temperature_raw.pixels().begin(),
                         [&](float value) { return scale.NearestCountOf(value); });
  return own;
}

}  // namespace isotherm
