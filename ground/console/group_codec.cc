#include "ground/console/group_codec.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/base/check.h"
#include "ground/thermal/sigma_code.h"
#include "ground/thermal/voxel_layout.h"

namespace isotherm {
namespace {

constexpr float kMaxPosition = std::numeric_limits<std::uint16_t>::max();
constexpr float kDegreesPerStep = 0.5F;
constexpr float kMetresPerStep = 0.01F;
/// The oldest a record knows is 1024 s; a square root keeps the first seconds apart.
constexpr float kMaxAge_s = 1024.0F;
constexpr float kMaxAgeCode = 254.0F;

std::uint8_t Byte(float value, float highest) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, highest)));
}

std::uint32_t ClassCode(std::uint8_t exported) {
  return ThermalLayout::Encode(static_cast<ConditionClass>(exported));
}

std::uint16_t TemperatureCode(float celsius) {
  if (std::isnan(celsius)) return 0;
  const float code = (celsius - ThermalLayout::kMin_celsius) * ThermalLayout::kStepsPerKelvin;
  return static_cast<std::uint16_t>(
      1 + std::lround(std::clamp(code, 0.0F, ThermalLayout::kMaxCode - 1.0F)));
}

template <typename Vertex>
std::string EncodeVertices(const std::vector<Vertex>& vertices) {
  std::string bytes(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                          bytes.size(), vertices.data(), vertices.size(),
                                          sizeof(Vertex)));
  return bytes;
}

std::string EncodeIndices(const std::vector<unsigned int>& indices, std::size_t vertex_count) {
  std::string bytes(meshopt_encodeIndexBufferBound(indices.size(), vertex_count), '\0');
  bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                         bytes.size(), indices.data(), indices.size()));
  return bytes;
}

/// Triangles in an order in which they share points with those before.
std::vector<unsigned int> OrderedIndices(const Surface& surface) {
  std::vector<unsigned int> indices;
  indices.reserve(3 * surface.triangles.size());
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    for (const int point : triangle) indices.push_back(static_cast<unsigned int>(point));
  }
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(),
                              surface.points.size());
  return indices;
}

}  // namespace

GroupVertex ToVertex(const CloudPoint& point, const Eigen::Vector3f& p_group) {
  GroupVertex vertex{};
  for (int axis = 0; axis < 3; ++axis) {
    vertex.position[axis] =
        static_cast<std::uint16_t>(std::lround(std::clamp(p_group[axis], 0.0F, kMaxPosition)));
  }
  vertex.temperature = TemperatureCode(point.celsius);
  vertex.classes = static_cast<std::uint8_t>(
      ClassCode(point.distance_class) | ClassCode(point.angle_class) << 2 |
      ClassCode(point.motion_class) << 4 | ClassCode(point.disagreement_class) << 6);
  vertex.angle = std::isnan(point.measured_angle_deg)
                     ? kNoAngle
                     : Byte(point.measured_angle_deg / kDegreesPerStep, kNoAngle - 1.0F);
  vertex.distance =
      std::isnan(point.measured_distance_m)
          ? kNoDistance
          : std::max<std::uint8_t>(1, Byte(point.measured_distance_m / kMetresPerStep, 255.0F));
  vertex.age = std::isnan(point.nuc_age_s)
                   ? kNoNucAge
                   : Byte(kMaxAgeCode * std::sqrt(point.nuc_age_s / kMaxAge_s), kMaxAgeCode);
  return vertex;
}

VertexDetails ToDetails(const CloudPoint& point) {
  return {.sigma = std::isnan(point.sigma_k) ? std::uint8_t{0} : SigmaCode::Of(point.sigma_k),
          .epoch = point.nuc_epoch,
          .observations = point.good_count,
          .unused = 0};
}

EncodedGroup EncodeGroup(const GroupKey& key, std::uint32_t version, const VoxelGrid& grid,
                         const Surface& surface) {
  EncodedGroup encoded;
  *encoded.group.mutable_key() = ToMessage(key);
  *encoded.details.mutable_key() = ToMessage(key);
  encoded.group.set_version(version);
  encoded.details.set_version(version);
  const Eigen::Vector3d origin_m = grid.VoxelCentre(kGroupVoxels * GridIndex(key.x, key.y, key.z));
  // From the first voxel's centre to that of the first one beyond.
  const double scale = kGroupVoxels * grid.voxel_size_m / static_cast<double>(kMaxPosition);
  encoded.group.mutable_origin()->set_x(origin_m.x());
  encoded.group.mutable_origin()->set_y(origin_m.y());
  encoded.group.mutable_origin()->set_z(origin_m.z());
  encoded.group.set_scale(scale);
  if (surface.triangles.empty()) return encoded;
  std::vector<unsigned int> indices = OrderedIndices(surface);
  std::vector<unsigned int> place(surface.points.size());
  const std::size_t count =
      meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), indices.size(), place.size());
  CHECK(count == surface.points.size());
  for (unsigned int& index : indices) index = place[index];
  std::vector<GroupVertex> vertices(count);
  std::vector<VertexDetails> details(count);
  for (std::size_t i = 0; i < count; ++i) {
    const CloudPoint& point = surface.points[i];
    const Eigen::Vector3d p_group = (point.position_m.cast<double>() - origin_m) / scale;
    vertices[place[i]] = ToVertex(point, p_group.cast<float>());
    details[place[i]] = ToDetails(point);
  }
  encoded.group.set_vertex_count(static_cast<std::uint32_t>(count));
  encoded.group.set_index_count(static_cast<std::uint32_t>(indices.size()));
  encoded.group.set_vertices(EncodeVertices(vertices));
  encoded.group.set_indices(EncodeIndices(indices, count));
  encoded.details.set_vertex_count(static_cast<std::uint32_t>(count));
  encoded.details.set_details(EncodeVertices(details));
  return encoded;
}

live::GroupKey ToMessage(const GroupKey& key) {
  live::GroupKey message;
  message.set_map(static_cast<std::uint32_t>(key.map));
  message.set_x(key.x);
  message.set_y(key.y);
  message.set_z(key.z);
  return message;
}

GroupKey FromMessage(const live::GroupKey& key) {
  return {static_cast<int>(key.map()), key.x(), key.y(), key.z()};
}

}  // namespace isotherm
