#include "common/simulation/thermal_sensor.h"

#include <algorithm>
#include <cmath>

#include "common/base/noise.h"
#include "common/frame/frame.h"
#include "common/frame/gaussian_blur.h"
#include "common/simulation/options.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/thermal_errors.h"

namespace isotherm {
namespace {

constexpr double kNetd_celsius = 30.0;  // Temperature at which makers state the NETD.

}  // namespace

ThermalSensor::ThermalSensor(const CameraModel& camera, const SimulatedThermalOptions& options)
    : grid_(camera),
      average_(camera, options),
      band_(SpectralBand{options.expert().band_min_um(), options.expert().band_max_um()}),
      scale_(ScaleOf(options)),
      noise_radiance_(options.expert().netd_kelvin() *
                      PlanckBandRadianceSlope(kNetd_celsius, band_.band())),
      readout_s_(options.expert().readout_s()),
      offset_error_k_(options.expert().offset_error_k()),
      gain_error_(options.expert().gain_error()),
      influence_(InfluenceOf(options)),
      blur_weights_(GaussianWeights(options.expert().blur_px())) {}

Image<std::uint16_t> ThermalSensor::Render(const Scene& scene,
                                           const RigidTransform& T_world_thermal,
                                           std::uint64_t noise_stream, Scratch& scratch) const {
  return RenderMoving(
      scene, [&](double) { return T_world_thermal; }, noise_stream, scratch);
}

Image<std::uint16_t> ThermalSensor::RenderMoving(const Scene& scene,
                                                 const PoseAfter& T_world_thermal,
                                                 std::uint64_t noise_stream,
                                                 Scratch& scratch) const {
  Expose(scene, T_world_thermal, scratch);
  return Detect(noise_stream, scratch);
}

void ThermalSensor::Expose(const Scene& scene, const PoseAfter& T_world_thermal,
                           Scratch& scratch) const {
  const int height = grid_.height();
  const int strip_rows = readout_s_ > 0.0 ? RayGrid::kTileHeight : height;
  const auto pose_of_rows = [&](int first_row, double age_s) {
    // The capture time is that of the middle row; the rows above it were read before, those below
    // later.
    const double middle = first_row + 0.5 * std::min(strip_rows, height - first_row);
    return T_world_thermal(readout_s_ * (middle / height - 0.5) - age_s);
  };
  const auto pose_of_row = [&](int first_row) { return pose_of_rows(first_row, 0.0); };
  if (readout_s_ > 0.0) {
    // A detector that is read row by row sees each strip from where the rig is then.
    CastRays(scene, grid_, pose_of_row, scratch.hits);
  } else {
    CastRays(scene, grid_, T_world_thermal(0.0), scratch.hits);
  }
  const EmissivityTables emissivity(scene);
  scratch.radiance.Resize(grid_.width(), height);
  for (int row = 0; row < height; row += strip_rows) {
    const RadianceView view(scene, band_, emissivity, pose_of_row(row));
    FillRadiance(view, row, std::min(row + strip_rows, height), scratch);
  }
  if (!average_.IsSingleRay())
    average_.Apply({scene, grid_, band_, emissivity, pose_of_rows, strip_rows}, scratch.hits,
                   scratch.radiance, scratch.average);
  Blur(blur_weights_, scratch.radiance, scratch.rows);
}

Image<std::uint16_t> ThermalSensor::RenderShutter(double shutter_celsius,
                                                  std::uint64_t noise_stream,
                                                  Scratch& scratch) const {
  scratch.radiance.Resize(grid_.width(), grid_.height());
  scratch.radiance.Fill(static_cast<float>(band_.RadianceFromCelsius(shutter_celsius)));
  return Detect(noise_stream, scratch);
}

void ThermalSensor::FillRadiance(const RadianceView& view, int first_row, int end_row,
                                 Scratch& scratch) const {
  for (int y = first_row; y < end_row; ++y) {
    for (int x = 0; x < grid_.width(); ++x) {
      scratch.radiance.At(x, y) = static_cast<float>(
          view.At(scratch.hits.primitive.At(x, y), grid_.Ray(x, y), scratch.hits.z_m.At(x, y)));
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
  // Before the noise: what falls on a pixel is mixed with its neighbours', its own noise is not.
  AddInfluence(scratch);
  Image<std::uint16_t> temperature_raw(grid_.width(), grid_.height());
  const auto radiance = scratch.radiance.pixels();
  const auto out = temperature_raw.pixels();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double measured = static_cast<double>(radiance[i]) +
                            noise_radiance_ * static_cast<double>(NormalNoise(noise_stream, i));
    // NaN (out of the radiometric range) and what 16 bits cannot say become 0 = no value.
    const double celsius = band_.CelsiusFromRadiance(measured);
    out[i] = scale_.CountOf(celsius + offset_error_k_ + gain_error_ * celsius);
  }
  return temperature_raw;
}

}  // namespace isotherm
