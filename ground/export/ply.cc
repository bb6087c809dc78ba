#include "ground/export/ply.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/output_file.h"

namespace isotherm {
namespace {

static_assert(std::endian::native == std::endian::little,
              "PLY records are written as they are in memory");

constexpr std::size_t kChunkBytes = 1U << 20;

/// Packs records without gaps and hands them on in chunks.
class RecordWriter {
 public:
  explicit RecordWriter(OutputFile& file) : file_(file) { bytes_.reserve(kChunkBytes + 64); }
  template <typename T>
  void Add(T value) {
    const auto* begin = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof(T));
  }
  void EndRecord() {
    if (bytes_.size() >= kChunkBytes) Flush();
  }
  void Flush() {
    file_.Write(bytes_);
    bytes_.clear();
  }

 private:
  OutputFile& file_;
  std::vector<std::byte> bytes_;
};

std::string Header(const PlyStyle& style, std::string_view what, std::size_t vertices,
                   std::optional<std::size_t> faces) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += fmt::format("comment {}: {} of a 3D thermogram\n", style.software, what);
  text +=
      "comment coordinate frame: world (edges of the scan volume), metres; unit normals towards "
      "the observed side\n"
      "comment to see it upright, turn it by 180 degrees about x: y points down and z away from "
      "the camera\n"
      "comment scalar_temperature: ";
  text += style.interpreted
              ? "temperature of the object in degrees Celsius; nan = never measured, or no "
                "temperature fits; scalar_apparent_temperature: as measured\n"
              : "apparent temperature in degrees Celsius, emissivity 1 assumed; nan = never "
                "measured\n";
  text += fmt::format(
      "comment quality: the same temperature for programs that take no nan; {} = never measured\n",
      kNeverMeasuredQuality);
  text +=
      "comment scalar_distance_class scalar_angle_class scalar_motion_class "
      "scalar_disagreement_class: 0 bad, 1 good, 2 acceptable, 255 never measured or not known\n"
      "comment scalar_nuc_epoch: NUCs before the measurement (modulo 256), scalar_nuc_age_s: "
      "seconds since the last one; scalar_measured_distance (metres) and scalar_measured_angle "
      "(degrees from the normal): of the thermal camera; nan = not known\n"
      "comment scalar_temperature_sigma: standard uncertainty as measured, kelvin; nan = "
      "never measured or not known\n";
  const std::string never = fmt::format("{} {} {} = never measured", kNeverMeasuredPoint.r,
                                        kNeverMeasuredPoint.g, kNeverMeasuredPoint.b);
  if (style.scale) {
    text +=
        fmt::format("comment palette: {} from {:.3f} to {:.3f} degrees Celsius; {}\n",
                    style.palette_name, style.scale->min_celsius, style.scale->max_celsius, never);
  } else {
    text += fmt::format("comment palette: none, no temperature was measured; {}\n", never);
  }
  text += fmt::format("element vertex {}\n", vertices);
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    text += fmt::format("property float {}\n", name);
  text +=
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float scalar_temperature\n"
      "property uchar scalar_distance_class\nproperty uchar scalar_angle_class\n"
      "property float quality\n"
      "property uchar scalar_motion_class\nproperty uchar scalar_disagreement_class\n"
      "property uchar scalar_nuc_epoch\n"
      "property float scalar_nuc_age_s\nproperty float scalar_measured_distance\n"
      "property float scalar_measured_angle\n"
      "property float scalar_temperature_sigma\n";
  if (style.interpreted) text += "property float scalar_apparent_temperature\n";
  if (faces)
    text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", *faces);
  return text + "end_header\n";
}

/// One vertex, in the order of the header's properties.
void AddPoint(const CloudPoint& point, const PlyStyle& style, RecordWriter& records) {
  for (const float value : point.position_m) records.Add(value);
  for (const float value : point.normal) records.Add(value);
  const bool measured = !std::isnan(point.celsius) && style.scale.has_value();
  records.Add(measured ? style.colours.At(style.scale->Fraction(static_cast<double>(point.celsius)))
                       : kNeverMeasuredPoint);
  records.Add(point.celsius);
  records.Add(point.distance_class);
  records.Add(point.angle_class);
  records.Add(std::isnan(point.celsius) ? kNeverMeasuredQuality : point.celsius);
  records.Add(point.motion_class);
  records.Add(point.disagreement_class);
  records.Add(point.nuc_epoch);
  records.Add(point.nuc_age_s);
  records.Add(point.measured_distance_m);
  records.Add(point.measured_angle_deg);
  records.Add(point.sigma_k);
  if (style.interpreted) records.Add(point.apparent_celsius);
  records.EndRecord();
}

/// One face: the number of its corners, then their indices.
void AddTriangle(const Eigen::Vector3i& triangle, RecordWriter& records) {
  records.Add(std::uint8_t{3});
  for (const std::int32_t index : triangle) records.Add(index);
  records.EndRecord();
}

}  // namespace

Status WriteCloudPly(const Surface& surface, const PlyStyle& style,
                     const std::filesystem::path& path) {
  OutputFile file(path);
  file.Write(Header(style, "extended point cloud", surface.points.size(), std::nullopt));
  RecordWriter records(file);
  for (const CloudPoint& point : surface.points) AddPoint(point, style, records);
  records.Flush();
  return file.Commit();
}

Status WriteMeshPly(const Surface& surface, const PlyStyle& style,
                    const std::filesystem::path& path) {
  const Surface mesh = surface.MeshOnly();
  OutputFile file(path);
  file.Write(Header(style, "mesh", mesh.points.size(), mesh.triangles.size()));
  RecordWriter records(file);
  for (const CloudPoint& point : mesh.points) AddPoint(point, style, records);
  for (const Eigen::Vector3i& triangle : mesh.triangles) AddTriangle(triangle, records);
  records.Flush();
  return file.Commit();
}

}  // namespace isotherm
