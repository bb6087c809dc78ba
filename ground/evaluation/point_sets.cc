#include "ground/evaluation/point_sets.h"

#include <fmt/format.h>

#include <cmath>

#include "ground/evaluation/ply_reader.h"

namespace isotherm {
namespace {

using Columns = std::vector<const std::vector<float>*>;

Result<Columns> Required(const PlyVertices& vertices, const std::vector<std::string>& names,
                         const std::filesystem::path& path) {
  Columns columns;
  for (const std::string& name : names) {
    columns.push_back(vertices.Find(name));
    if (columns.back() == nullptr) {
      return Err(DataLoss(fmt::format("{}: has no vertex property '{}'", path.string(), name)));
    }
  }
  return columns;
}

template <typename T>
std::vector<T> Converted(const std::vector<float>* column) {
  std::vector<T> result;
  if (column == nullptr) return result;
  result.reserve(column->size());
  for (const float value : *column) result.push_back(static_cast<T>(value));
  return result;
}

std::vector<Eigen::Vector3f> Vectors(const Columns& columns, std::size_t first) {
  const std::size_t count = columns[first]->size();
  std::vector<Eigen::Vector3f> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = {(*columns[first])[i], (*columns[first + 1])[i], (*columns[first + 2])[i]};
  }
  return result;
}

}  // namespace

Result<MeasuredCloud> ReadMeasuredCloud(const std::filesystem::path& path) {
  const Result<PlyVertices> vertices = ReadPly(path);
  if (!vertices) return Err(vertices.error());
  const Result<Columns> xyz = Required(*vertices, {"x", "y", "z"}, path);
  if (!xyz) return Err(xyz.error());
  MeasuredCloud cloud;
  cloud.positions_m = Vectors(*xyz, 0);
  if (const Result<Columns> normals = Required(*vertices, {"nx", "ny", "nz"}, path))
    cloud.normals = Vectors(*normals, 0);
  cloud.celsius = Converted<float>(vertices->Find("scalar_temperature"));
  cloud.distance_class = Converted<std::uint8_t>(vertices->Find("scalar_distance_class"));
  cloud.angle_class = Converted<std::uint8_t>(vertices->Find("scalar_angle_class"));
  cloud.motion_class = Converted<std::uint8_t>(vertices->Find("scalar_motion_class"));
  cloud.measured_angle_deg = Converted<float>(vertices->Find("scalar_measured_angle"));
  cloud.measured_distance_m = Converted<float>(vertices->Find("scalar_measured_distance"));
  cloud.sigma_k = Converted<float>(vertices->Find("scalar_temperature_sigma"));
  return cloud;
}

Result<TruePoints> ReadTruePoints(const std::filesystem::path& path) {
  const Result<PlyVertices> vertices = ReadPly(path);
  if (!vertices) return Err(vertices.error());
  const Result<Columns> columns = Required(*vertices, {"x", "y", "z", "nx", "ny", "nz"}, path);
  if (!columns) return Err(columns.error());
  TruePoints points;
  points.positions_m = Vectors(*columns, 0);
  points.normals = Vectors(*columns, 3);
  for (std::size_t i = 0; i < vertices->count; ++i) {
    // Normals are written with few digits.
    constexpr float kLengthTolerance = 0.01F;
    const bool unit = std::abs(points.normals[i].norm() - 1.0F) < kLengthTolerance;
    if (!points.positions_m[i].allFinite() || !unit) {
      return Err(DataLoss(
          fmt::format("{}: vertex {} has no finite position or no unit normal", path.string(), i)));
    }
  }
  points.celsius = Converted<float>(vertices->Find("scalar_temperature"));
  points.seen = Converted<std::uint32_t>(vertices->Find("seen"));
  points.primitive = Converted<std::uint32_t>(vertices->Find("primitive"));
  // Surfaces from elsewhere count as one shape.
  if (points.primitive.empty()) points.primitive.assign(vertices->count, 0);
  if (points.positions_m.empty())
    return Err(DataLoss(fmt::format("{}: has no points", path.string())));
  return points;
}

std::vector<Eigen::Vector3f> Transformed(const RigidTransform& transform,
                                         const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> result;
  result.reserve(points.size());
  for (const Eigen::Vector3f& p : points)
    result.push_back((transform * p.cast<double>()).cast<float>());
  return result;
}

}  // namespace isotherm
