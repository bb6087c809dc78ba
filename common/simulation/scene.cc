#include "common/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/simulation/intersection.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

double IntersectPrimitive(const Primitive& primitive, const Vector3d& origin,
                          const Vector3d& direction) {
  const LocalRay<double> ray{origin.x(),    origin.y(),    origin.z(),
                             direction.x(), direction.y(), direction.z()};
  const LocalSize<double> size{primitive.size.x(), primitive.size.y(), primitive.size.z()};
  return VisitShape(primitive.shape,
                    [&]<Shape shape>() { return IntersectShape<shape, double>(ray, size); });
}

/// Returns whether a ray comes closer than `radius` to the centre. `center_to_origin` points at the
/// ray's origin.
bool PassesNear(const Vector3d& center_to_origin, const Vector3d& direction, double radius) {
  const double along = center_to_origin.dot(direction);
  const double outside = center_to_origin.squaredNorm() - radius * radius;
  if (outside <= 0.0) return true;
  return along < 0.0 && along * along >= outside * direction.squaredNorm();
}

}  // namespace

Scene::Scene(std::string name, std::vector<Primitive> primitives, std::vector<Material> materials,
             double surround_celsius)
    : name_(std::move(name)),
      primitives_(std::move(primitives)),
      materials_(std::move(materials)),
      surround_celsius_(surround_celsius) {
  for (const Primitive& primitive : primitives_) {
    CHECK(primitive.material >= 0 && primitive.material < static_cast<int>(materials_.size()));
    T_primitive_world_.push_back(primitive.T_world_primitive.inverse());
    bounding_radius_m_.push_back(HalfExtents(primitive).norm());
  }
}

std::optional<SurfaceHit> Scene::Intersect(const Vector3d& origin_world,
                                           const Vector3d& direction_world) const {
  double nearest = kNoHit<double>;
  int index = -1;
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    const Vector3d offset = origin_world - primitives_[i].T_world_primitive.translation();
    if (!PassesNear(offset, direction_world, bounding_radius_m_[i])) continue;
    const double distance = IntersectPrimitive(primitives_[i], T_primitive_world_[i] * origin_world,
                                               T_primitive_world_[i].linear() * direction_world);
    if (distance < nearest) {
      nearest = distance;
      index = static_cast<int>(i);
    }
  }
  if (index < 0) return std::nullopt;
  const auto i = static_cast<std::size_t>(index);
  SurfaceHit hit{nearest, {origin_world + nearest * direction_world, {}, 0.0, index}};
  const Vector3d p_primitive = T_primitive_world_[i] * hit.point.p_world;
  Vector3d normal =
      primitives_[i].T_world_primitive.linear() * NormalAt(primitives_[i], p_primitive);
  if (normal.dot(direction_world) > 0.0) normal = -normal;
  hit.point.n_world = normal;
  hit.point.celsius = primitives_[i].temperature.CelsiusAt(p_primitive);
  return hit;
}

const Material& Scene::MaterialOf(int primitive) const {
  return materials_[static_cast<std::size_t>(
      primitives_[static_cast<std::size_t>(primitive)].material)];
}

double Scene::TrueCelsius(int primitive, const Vector3d& p_world) const {
  const auto i = static_cast<std::size_t>(primitive);
  return primitives_[i].temperature.CelsiusAt(T_primitive_world_[i] * p_world);
}

bool Scene::IsCovered(const Vector3d& p_world, int except, double tolerance_m) const {
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    if (static_cast<int>(i) == except) continue;
    if (Contains(primitives_[i], T_primitive_world_[i] * p_world, tolerance_m)) return true;
  }
  return false;
}

double TrueRadiance(const Scene& scene, const BandRadiance& band, const SurfacePoint& point,
                    const Vector3d& viewer_world, double emissivity) {
  const Material& material = scene.MaterialOf(point.primitive);
  double reflected = band.RadianceFromCelsius(scene.surround_celsius());
  if (material.mirror) {
    const Vector3d incoming = (point.p_world - viewer_world).normalized();
    const Vector3d outgoing = incoming - 2.0 * incoming.dot(point.n_world) * point.n_world;
    // A reflected ray must not meet the surface that it leaves.
    constexpr double kLeaveSurface_m = 1e-6;
    const auto hit = scene.Intersect(point.p_world + kLeaveSurface_m * point.n_world, outgoing);
    // What is seen in the mirror is taken as black: one bounce only.
    if (hit) reflected = band.RadianceFromCelsius(hit->point.celsius);
  }
  return emissivity * band.RadianceFromCelsius(point.celsius) + (1.0 - emissivity) * reflected;
}

double TrueApparentCelsius(const Scene& scene, const BandRadiance& band, const SurfacePoint& point,
                           const Vector3d& viewer_world) {
  const Material& material = scene.MaterialOf(point.primitive);
  const double cosine = std::abs(point.n_world.dot((viewer_world - point.p_world).normalized()));
  const double emissivity = DirectionalEmissivity(
      std::acos(std::min(1.0, cosine)), material.normal_emissivity, material.n, material.kappa);
  return band.CelsiusFromRadiance(TrueRadiance(scene, band, point, viewer_world, emissivity));
}

}  // namespace isotherm
