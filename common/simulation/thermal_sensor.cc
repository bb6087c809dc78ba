#include "common/simulation/thermal_sensor.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "common/base/noise.h"
#include "common/frame/frame.h"
#include "common/simulation/options.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/thermal_errors.h"

namespace isotherm {
namespace {

constexpr double kNetd_celsius = 30.0;  // Temperature at which makers state the NETD.

std::vector<float> GaussianWeights(double sigma_px) {
  constexpr double kCutOffSigmas = 3.0;
  const int radius = sigma_px > 0.0 ? static_cast<int>(std::ceil(kCutOffSigmas * sigma_px)) : 0;
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i) {
    weights.push_back(radius == 0 ? 1.0 : std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    sum += weights.back() * (i == 0 ? 1.0 : 2.0);
  }
  std::vector<float> normalized;
  for (const double weight : weights) normalized.push_back(static_cast<float>(weight / sum));
  return normalized;
}

/// Delays between radiation and its reading: an exponential distribution cut into
/// parts of equal weight, each at its median, moved so that the mean is 0.
std::vector<double> ResponseDelays(double time_constant_s) {
  constexpr int kParts = 24;
  if (time_constant_s <= 0.0) return {0.0};
  std::vector<double> delays_s;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    delays_s.push_back(-time_constant_s * std::log(1.0 - (i + 0.5) / kParts));
    sum += delays_s.back();
  }
  for (double& delay_s : delays_s) delay_s -= sum / kParts;
  return delays_s;
}

/// Fraction of the exposure at `times[i]` in what is interpolated linearly at `time_s`.
double InterpolationWeight(const std::vector<double>& times_s, std::size_t i, double time_s) {
  if (times_s.size() == 1) return 1.0;
  const double step_s = times_s[1] - times_s[0];
  return std::max(0.0, 1.0 - std::abs(time_s - times_s[i]) / step_s);
}

}  // namespace

ThermalSensor::ThermalSensor(const CameraModel& camera, const SimulatedThermalOptions& options)
    : grid_(camera),
      average_(camera, options),
      band_(SpectralBand{options.expert().band_min_um(), options.expert().band_max_um()}),
      scale_(ScaleOf(options)),
      noise_radiance_(options.expert().netd_kelvin() *
                      PlanckBandRadianceSlope(kNetd_celsius, band_.band())),
      readout_s_(options.expert().readout_s()),
      influence_(InfluenceOf(options)),
      delays_s_(ResponseDelays(options.expert().time_constant_s())),
      blur_weights_(GaussianWeights(options.expert().blur_px())) {}

Image<std::uint16_t> ThermalSensor::Render(const Scene& scene,
                                           const RigidTransform& T_world_thermal,
                                           std::uint64_t noise_stream, Scratch& scratch) const {
  Expose(scene, T_world_thermal, scratch);
  return Detect(noise_stream, scratch);
}

void ThermalSensor::Expose(const Scene& scene, const RigidTransform& T_world_thermal,
                           Scratch& scratch) const {
  CastRays(scene, grid_, T_world_thermal, scratch.hits);
  const EmissivityTables emissivity(scene);
  FillRadiance(RadianceView(scene, band_, emissivity, T_world_thermal), scratch);
  if (!average_.IsSingleRay())
    average_.Apply(scene, grid_, band_, emissivity, T_world_thermal, scratch.hits, scratch.radiance,
                   scratch.average);
  Blur(scratch);
}

Image<std::uint16_t> ThermalSensor::RenderMoving(const Scene& scene,
                                                 const PoseAfter& T_world_thermal,
                                                 std::uint64_t noise_stream,
                                                 Scratch& scratch) const {
  const double first_s = -delays_s_.back() - 0.5 * readout_s_;
  const double last_s = -delays_s_.front() + 0.5 * readout_s_;
  if (first_s == last_s || T_world_thermal(first_s).isApprox(T_world_thermal(last_s), 1e-12))
    return Render(scene, T_world_thermal(0.0), noise_stream, scratch);
  constexpr int kExposures = 13;
  std::vector<double> times_s;
  for (int i = 0; i < kExposures; ++i)
    times_s.push_back(first_s + (last_s - first_s) * i / (kExposures - 1));
  scratch.smeared.Resize(grid_.width(), grid_.height());
  scratch.smeared.Fill(0.0F);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    Expose(scene, T_world_thermal(times_s[i]), scratch);
    AddSmear(times_s, i, scratch);
  }
  std::swap(scratch.radiance, scratch.smeared);
  return Detect(noise_stream, scratch);
}

void ThermalSensor::AddSmear(const std::vector<double>& exposure_times_s, std::size_t exposure,
                             Scratch& scratch) const {
  const int height = grid_.height();
  for (int y = 0; y < height; ++y) {
    const double read_s = readout_s_ * ((y + 0.5) / height - 0.5);
    double weight = 0.0;
    for (const double delay_s : delays_s_)
      weight += InterpolationWeight(exposure_times_s, exposure, read_s - delay_s);
    weight /= static_cast<double>(delays_s_.size());
    if (weight <= 0.0) continue;
    const std::span<const float> in = scratch.radiance.Row(y);
    const std::span<float> out = scratch.smeared.Row(y);
    for (std::size_t x = 0; x < out.size(); ++x) out[x] += static_cast<float>(weight) * in[x];
  }
}

Image<std::uint16_t> ThermalSensor::RenderShutter(double shutter_celsius,
                                                  std::uint64_t noise_stream,
                                                  Scratch& scratch) const {
  scratch.radiance.Resize(grid_.width(), grid_.height());
  scratch.radiance.Fill(static_cast<float>(band_.RadianceFromCelsius(shutter_celsius)));
  return Detect(noise_stream, scratch);
}

void ThermalSensor::FillRadiance(const RadianceView& view, Scratch& scratch) const {
  scratch.radiance.Resize(grid_.width(), grid_.height());
  for (int y = 0; y < grid_.height(); ++y) {
    for (int x = 0; x < grid_.width(); ++x) {
      scratch.radiance.At(x, y) = static_cast<float>(
          view.At(scratch.hits.primitive.At(x, y), grid_.Ray(x, y), scratch.hits.z_m.At(x, y)));
    }
  }
}

void ThermalSensor::Blur(Scratch& scratch) const {
  const int radius = static_cast<int>(blur_weights_.size()) - 1;
  if (radius == 0) return;
  const int width = grid_.width(), height = grid_.height();
  scratch.rows.Resize(width, height);
  for (int y = 0; y < height; ++y) {
    const float* const in = scratch.radiance.Row(y).data();
    float* const out = scratch.rows.Row(y).data();
    for (int x = 0; x < width; ++x) {
      float sum = blur_weights_[0] * in[x];
      for (int i = 1; i <= radius; ++i) {
        sum += blur_weights_[static_cast<std::size_t>(i)] *
               (in[std::max(0, x - i)] + in[std::min(width - 1, x + i)]);
      }
      out[x] = sum;
    }
  }
  for (int y = 0; y < height; ++y) {
    float* const out = scratch.radiance.Row(y).data();
    const float* const middle = scratch.rows.Row(y).data();
    for (int x = 0; x < width; ++x) out[x] = blur_weights_[0] * middle[x];
    for (int i = 1; i <= radius; ++i) {
      const float weight = blur_weights_[static_cast<std::size_t>(i)];
      const float* const above = scratch.rows.Row(std::max(0, y - i)).data();
      const float* const below = scratch.rows.Row(std::min(height - 1, y + i)).data();
      for (int x = 0; x < width; ++x) out[x] += weight * (above[x] + below[x]);
    }
  }
}

void ThermalSensor::AddInfluence(Scratch& scratch) const {
  if (influence_.Total() == 0.0) return;
  scratch.celsius.Resize(grid_.width(), grid_.height());
  for (std::size_t i = 0; i < scratch.celsius.size(); ++i) {
    scratch.celsius.pixels()[i] = static_cast<float>(
        band_.CelsiusFromRadiance(static_cast<double>(scratch.radiance.pixels()[i])));
  }
  AddSceneInfluence(influence_, scratch.celsius);
  for (std::size_t i = 0; i < scratch.celsius.size(); ++i) {
    const float celsius = scratch.celsius.pixels()[i];
    if (std::isnan(celsius)) continue;  // Out of the radiometric range, as it was.
    scratch.radiance.pixels()[i] =
        static_cast<float>(band_.RadianceFromCelsius(static_cast<double>(celsius)));
  }
}

Image<std::uint16_t> ThermalSensor::Detect(std::uint64_t noise_stream, Scratch& scratch) const {
  AddInfluence(scratch);
  Image<std::uint16_t> temperature_raw(grid_.width(), grid_.height());
  const auto radiance = scratch.radiance.pixels();
  const auto out = temperature_raw.pixels();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double measured = static_cast<double>(radiance[i]) +
                            noise_radiance_ * static_cast<double>(NormalNoise(noise_stream, i));
    // NaN (out of the radiometric range) and what 16 bits cannot say become 0 = no value.
    out[i] = scale_.CountOf(band_.CelsiusFromRadiance(measured));
  }
  return temperature_raw;
}

}  // namespace isotherm
