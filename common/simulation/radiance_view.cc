#include "common/simulation/radiance_view.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Intervals in the cosine: fine enough that interpolation keeps within 0.003 of Fresnel's formula
/// also at grazing angles (the angle experiment requires that).
constexpr int kEmissivityIntervals = 1024;

std::vector<float> MakeEmissivityTable(const Material& material) {
  std::vector<float> table;
  for (int i = 0; i <= kEmissivityIntervals; ++i) {
    const double angle_rad = std::acos(static_cast<double>(i) / kEmissivityIntervals);
    table.push_back(static_cast<float>(
        DirectionalEmissivity(angle_rad, material.normal_emissivity, material.n, material.kappa)));
  }
  return table;
}

}  // namespace

EmissivityTables::EmissivityTables(const Scene& scene) {
  for (const Material& material : scene.materials())
    tables_.push_back(MakeEmissivityTable(material));
}

double EmissivityTables::At(int material, float cosine) const {
  const std::vector<float>& table = tables_[static_cast<std::size_t>(material)];
  const float position = cosine * kEmissivityIntervals;
  const auto index =
      static_cast<std::size_t>(std::clamp(static_cast<int>(position), 0, kEmissivityIntervals - 1));
  const float fraction = position - static_cast<float>(index);
  return static_cast<double>(table[index] + fraction * (table[index + 1] - table[index]));
}

RadianceView::RadianceView(const Scene& scene, const BandRadiance& band,
                           const EmissivityTables& emissivity, const RigidTransform& T_world_camera)
    : scene_(scene),
      band_(band),
      emissivity_(emissivity),
      T_world_camera_(T_world_camera),
      view_(scene, T_world_camera),
      surround_(band.RadianceFromCelsius(scene.surround_celsius())) {}

double RadianceView::At(int primitive, const Eigen::Vector2f& ray, float z_m) const {
  if (primitive < 0) return surround_;
  const CameraView::Surface surface = view_.At(primitive, ray, z_m);
  const int material = scene_.primitives()[static_cast<std::size_t>(primitive)].material;
  const double emissivity = emissivity_.At(material, surface.cosine);
  if (scene_.MaterialOf(primitive).mirror) return MirrorRadiance(ray, emissivity);
  return emissivity * band_.RadianceFromCelsius(static_cast<double>(surface.celsius)) +
         (1.0 - emissivity) * surround_;
}

double RadianceView::MirrorRadiance(const Eigen::Vector2f& ray, double emissivity) const {
  const Eigen::Vector3d viewer_world = T_world_camera_.translation();
  const Eigen::Vector3d direction_world =
      T_world_camera_.linear() * ray.cast<double>().homogeneous();
  const auto hit = scene_.Intersect(viewer_world, direction_world);
  if (!hit) return surround_;
  return TrueRadiance(scene_, band_, hit->point, viewer_world, emissivity);
}

}  // namespace isotherm
