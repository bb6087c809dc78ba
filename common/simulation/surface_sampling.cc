#include "common/simulation/surface_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/simulation/ray_caster.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

/// Points of one primitive in its own coordinates.
class LocalSampler {
 public:
  LocalSampler(const Primitive& primitive, double spacing_m)
      : primitive_(primitive), spacing_m_(spacing_m) {}

  struct Sample {
    Vector3d p, n;
  };

  std::vector<Sample> Run() {
    const Vector3d& s = primitive_.size;
    switch (primitive_.shape) {
      case Shape::kBox:
        Box(s);
        break;
      case Shape::kRectangle:
        Face(Vector3d::Zero(), {s.x(), 0, 0}, {0, s.y(), 0}, Vector3d::UnitZ());
        break;
      case Shape::kSphere:
        Sphere(s.x());
        break;
      case Shape::kCylinder:
        Side(s.x(), s.z(), 1.0);
        Ring(s.x(), 0.0, s.z(), 1.0);
        Ring(s.x(), 0.0, -s.z(), -1.0);
        break;
      case Shape::kTube:
        Side(s.x(), s.z(), 1.0);
        Side(s.y(), s.z(), -1.0);
        Ring(s.x(), s.y(), s.z(), 1.0);
        Ring(s.x(), s.y(), -s.z(), -1.0);
        break;
      case Shape::kDisc:
        Ring(s.x(), s.y(), 0.0, 1.0);
        break;
    }
    return std::move(samples_);
  }

 private:
  // Samples lie in the middle of equal pieces, so that each stands for the same area.
  int Count(double length) const {
    return std::max(1, static_cast<int>(std::lround(length / spacing_m_)));
  }

  void Face(const Vector3d& center, const Vector3d& half_u, const Vector3d& half_v,
            const Vector3d& normal) {
    const int count_u = Count(2.0 * half_u.norm()), count_v = Count(2.0 * half_v.norm());
    for (int v = 0; v < count_v; ++v) {
      for (int u = 0; u < count_u; ++u) {
        samples_.push_back({center + half_u * ((2.0 * u + 1.0) / count_u - 1.0) +
                                half_v * ((2.0 * v + 1.0) / count_v - 1.0),
                            normal});
      }
    }
  }

  void Box(const Vector3d& s) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const double sign : {-1.0, 1.0}) {
        const Vector3d normal = sign * Vector3d::Unit(axis);
        Face(normal * s[axis], Vector3d::Unit(u) * s[u], Vector3d::Unit(v) * s[v], normal);
      }
    }
  }

  void Sphere(double radius) {
    const int rings = Count(kFullCircle_rad / 2.0 * radius);
    for (int ring = 0; ring < rings; ++ring) {
      const double polar = kFullCircle_rad / 2.0 * (ring + 0.5) / rings;
      // Fewer points on smaller rings, so that each stands for the same area.
      const int count = Count(kFullCircle_rad * radius * std::sin(polar));
      for (int i = 0; i < count; ++i) {
        const double angle = kFullCircle_rad * i / count;
        const Vector3d normal(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                              std::cos(polar));
        samples_.push_back({radius * normal, normal});
      }
    }
  }

  void Side(double radius, double half_length, double sign) {
    const int count_around = Count(kFullCircle_rad * radius),
              count_along = Count(2.0 * half_length);
    for (int along = 0; along < count_along; ++along) {
      const double z = half_length * ((2.0 * along + 1.0) / count_along - 1.0);
      for (int i = 0; i < count_around; ++i) {
        const double angle = kFullCircle_rad * i / count_around;
        const Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
        samples_.push_back({radius * outward + Vector3d(0.0, 0.0, z), sign * outward});
      }
    }
  }

  void Ring(double outer, double inner, double z, double sign) {
    const int rings = Count(outer - inner);
    for (int ring = 0; ring < rings; ++ring) {
      const double radius = inner + (outer - inner) * (ring + 0.5) / rings;
      const int count = Count(kFullCircle_rad * radius);
      for (int i = 0; i < count; ++i) {
        const double angle = kFullCircle_rad * i / count;
        samples_.push_back(
            {{radius * std::cos(angle), radius * std::sin(angle), z}, {0.0, 0.0, sign}});
      }
    }
  }

  const Primitive& primitive_;
  const double spacing_m_;
  std::vector<Sample> samples_;
};

void AppendLittleEndian(float value, std::string& out) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(bits >> shift));
}

void AppendLittleEndian(std::uint16_t value, std::string& out) {
  out.push_back(static_cast<char>(value & 0xff));
  out.push_back(static_cast<char>(value >> 8));
}

}  // namespace

std::vector<SurfaceSample> SampleSurface(const Scene& scene, double spacing_m) {
  // Far above rounding and far below any gap that is meant.
  constexpr double kTouching_m = 1e-6;
  std::vector<SurfaceSample> samples;
  for (std::size_t i = 0; i < scene.primitives().size(); ++i) {
    const Primitive& primitive = scene.primitives()[i];
    const int index = static_cast<int>(i);
    for (const auto& local : LocalSampler(primitive, spacing_m).Run()) {
      const Vector3d p_world = primitive.T_world_primitive * local.p;
      // Where primitives touch or overlap, their faces inside are no surface of the scene.
      if (scene.IsCovered(p_world, index, kTouching_m)) continue;
      samples.push_back({{p_world, primitive.T_world_primitive.linear() * local.n,
                          primitive.temperature.CelsiusAt(local.p), index}});
    }
  }
  return samples;
}

void CountSeen(const Scene& scene, const CameraModel& camera, const RigidTransform& T_world_camera,
               double max_distance_m, SeenBy seen_by, std::span<SurfaceSample> samples) {
  // A ray to a point meets the point's own surface, up to rounding at grazing angles.
  constexpr double kSameSurface_m = 1e-4;
  const Vector3d camera_world = T_world_camera.translation();
  const RigidTransform T_camera_world = T_world_camera.inverse();
  for (SurfaceSample& sample : samples) {
    const Vector3d to_point = sample.point.p_world - camera_world;
    const double distance = to_point.norm();
    // The cheap tests go first; the last one walks through the scene.
    if (distance > max_distance_m || to_point.dot(sample.point.n_world) >= 0.0) continue;
    const auto pixel = Project(camera, T_camera_world * sample.point.p_world);
    if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > camera.width - 1 ||
        pixel->y() > camera.height - 1) {
      continue;
    }
    const auto hit = scene.Intersect(camera_world, to_point / distance);
    if (hit && hit->distance < distance - kSameSurface_m) continue;
    std::uint16_t& count = seen_by == SeenBy::kDepth ? sample.seen_depth : sample.seen_thermal;
    if (count < std::numeric_limits<std::uint16_t>::max()) ++count;
  }
}

Status WriteSurfacePly(const std::filesystem::path& path, std::span<const SurfaceSample> samples) {
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\n"
      "comment world, metres; scalar_temperature: true surface temperature in degC; seen, "
      "seen_thermal: poses that see the point\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property float scalar_temperature\nproperty uchar primitive\nproperty ushort seen\n"
      "property ushort seen_thermal\nend_header\n",
      samples.size());
  for (const SurfaceSample& sample : samples) {
    for (const Vector3d& vector : {sample.point.p_world, sample.point.n_world}) {
      for (const double value : vector) AppendLittleEndian(static_cast<float>(value), out);
    }
    AppendLittleEndian(static_cast<float>(sample.point.celsius), out);
    out.push_back(static_cast<char>(sample.point.primitive));
    AppendLittleEndian(sample.seen_depth, out);
    AppendLittleEndian(sample.seen_thermal, out);
  }
  std::ofstream file(path, std::ios::binary);
  file.write(out.data(), static_cast<std::streamsize>(out.size()));
  file.close();
  if (!file) return IoError(fmt::format("cannot write {}", path.string()));
  return OkStatus();
}

}  // namespace isotherm
