#include "ground/experiment/still_image.h"

#include <vector>

#include "common/base/noise.h"
#include "common/simulation/options.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/thermal_sensor.h"

namespace isotherm {

CameraModel StillCamera() { return DefaultSimulatedRig().thermal->WithoutDistortion(); }

Scene MakeFlatTarget(const FlatTarget& target) {
  constexpr double kFlush_m = 1e-5;  // Ten times what distances are rounded to.
  SceneBuilder scene(target.plate_celsius);
  scene.UseMaterial({1.0, 1.0, 0.0, false});
  const double front = target.distance_m;
  scene.Box("plate", {-4.0, -4.0, front}, {4.0, 4.0, front + 0.1}).temperature =
      Uniform(target.plate_celsius);
  const Eigen::Vector3d middle(target.patch_middle_m.x(), target.patch_middle_m.y(),
                               front - kFlush_m);
  const Eigen::Vector3d half(target.patch_m, target.patch_m, 0.0);
  Primitive& patch =
      target.patch == FlatTarget::Patch::kDisc
          ? scene.Disc("patch", middle, {0.0, 0.0, -1.0}, target.patch_m)
          : scene.Box("patch", middle - half, middle + half + Eigen::Vector3d(0.0, 0.0, 0.01));
  patch.temperature = Uniform(target.patch_celsius);
  return scene.Build("flat target");
}

Image<float> TakeStill(const Scene& scene, const SimulatedThermalOptions& options,
                       ThreadPool& pool) {
  // The mean of 40 images has a sixth of one's noise.
  constexpr int kImages = 40;
  constexpr std::uint64_t kSeed = 1;
  const ThermalSensor sensor(StillCamera(), options);
  const RadiometricScale scale = ScaleOf(options);
  std::vector<Image<std::uint16_t>> images(kImages);
  pool.ParallelFor(kImages, [&](int i) {
    ThermalSensor::Scratch scratch;
    images[static_cast<std::size_t>(i)] =
        sensor.Render(scene, RigidTransform::Identity(),
                      NoiseStream(kSeed, 0, static_cast<std::uint64_t>(i)), scratch);
  });
  Image<float> celsius(images.front().width(), images.front().height());
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    double sum = 0.0;
    for (const Image<std::uint16_t>& image : images)
      sum += static_cast<double>(scale.Celsius(image.pixels()[i]));
    celsius.pixels()[i] = static_cast<float>(sum / kImages);
  }
  return celsius;
}

double MixedCelsius(const BandRadiance& band, const FlatTarget& target, double patch_fraction) {
  return band.CelsiusFromRadiance(patch_fraction * band.RadianceFromCelsius(target.patch_celsius) +
                                  (1.0 - patch_fraction) *
                                      band.RadianceFromCelsius(target.plate_celsius));
}

}  // namespace isotherm
