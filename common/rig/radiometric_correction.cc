#include "common/rig/radiometric_correction.h"

#include <fmt/format.h>

#include <algorithm>

namespace isotherm {
namespace {

/// A reading between two nodes.
struct Place {
  std::size_t below = 0, above = 0;
  float fraction = 0.0F;

  float Of(const std::vector<float>& values) const {
    return values[below] + fraction * (values[above] - values[below]);
  }
};

/// `after` is the number of nodes up to the reading.
Place PlaceOf(const std::vector<float>& nodes, std::size_t after, float reading) {
  if (after == 0) return {};
  if (after == nodes.size()) return {after - 1, after - 1, 0.0F};
  const float below = nodes[after - 1];
  return {after - 1, after, (reading - below) / (nodes[after] - below)};
}

double Interpolate(const std::vector<float>& nodes, const std::vector<float>& values,
                   double reading_celsius) {
  if (nodes.empty()) return 0.0;
  const auto reading = static_cast<float>(reading_celsius);
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), reading) - nodes.begin();
  return static_cast<double>(PlaceOf(nodes, static_cast<std::size_t>(after), reading).Of(values));
}

}  // namespace

double RadiometricCorrection::At(double reading_celsius) const {
  return Interpolate(readings_celsius, corrections_k, reading_celsius);
}

double RadiometricCorrection::SigmaAt(double reading_celsius) const {
  return Interpolate(readings_celsius, sigmas_k, reading_celsius);
}

void RadiometricCorrection::Correct(std::span<float> celsius) const {
  if (empty()) return;
  // Neighbours are of about the same temperature: from one to the next there is hardly a way.
  std::size_t after = 0;
  for (float& value : celsius) {
    while (after < readings_celsius.size() && readings_celsius[after] <= value) ++after;
    while (after > 0 && readings_celsius[after - 1] > value) --after;
    value += PlaceOf(readings_celsius, after, value).Of(corrections_k);
  }
}

Status Validate(const RadiometricCorrection& correction) {
  const std::vector<float>& readings = correction.readings_celsius;
  const std::size_t count = readings.size();
  if (count > RadiometricCorrection::kMaxReadings || correction.corrections_k.size() != count ||
      correction.sigmas_k.size() != count) {
    return InvalidArgument(fmt::format(
        "thermal_sensor.radiometric_correction: need up to {} of each of reading_celsius, "
        "correction_k and sigma_k, got {}, {} and {}",
        RadiometricCorrection::kMaxReadings, count, correction.corrections_k.size(),
        correction.sigmas_k.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float change_k = correction.corrections_k[i], sigma_k = correction.sigmas_k[i];
    if (!(change_k >= -RadiometricCorrection::kMaxCorrection_k &&
          change_k <= RadiometricCorrection::kMaxCorrection_k) ||
        !(sigma_k >= 0.0F && sigma_k <= RadiometricCorrection::kMaxCorrection_k)) {
      return InvalidArgument(fmt::format(
          "thermal_sensor.radiometric_correction: correction_k must be -{0}..{0} and sigma_k "
          "0..{0}, got {1:g} and {2:g}",
          RadiometricCorrection::kMaxCorrection_k, change_k, sigma_k));
    }
    if (!(readings[i] >= -273.15F && readings[i] <= 5000.0F)) {
      return InvalidArgument(fmt::format(
          "thermal_sensor.radiometric_correction.reading_celsius: {:g} °C is none", readings[i]));
    }
    // Otherwise of two things the colder one would become the hotter one.
    if (i > 0 && !(readings[i] > readings[i - 1] &&
                   readings[i] + change_k > readings[i - 1] + correction.corrections_k[i - 1])) {
      return InvalidArgument(fmt::format(
          "thermal_sensor.radiometric_correction: reading_celsius must ascend, and what results "
          "with correction_k as well, which it does not after {:g} °C",
          readings[i - 1]));
    }
  }
  return OkStatus();
}

}  // namespace isotherm
