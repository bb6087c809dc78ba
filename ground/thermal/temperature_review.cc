#include "ground/thermal/temperature_review.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace isotherm {
namespace {

/// How far edges are rounded, voxels.
constexpr float kBesideVox = 2.0F;
/// Cosine of 20 degrees. Faces further apart than this are different ones: several times the noise
/// of normals.
constexpr float kOtherFaceCosine = 0.9396926F;

float DistanceAt(const TsdfVolume& tsdf, const GridIndex& voxel) {
  if ((voxel.array() < 0).any()) return NAN;
  const TsdfVoxel at = tsdf.VoxelAt(voxel);
  return at.observed() ? at.tsdf() : NAN;
}

/// Unit normal of the surface by central differences, one-sided beside unobserved voxels; nullopt
/// where an axis has no neighbour.
std::optional<Eigen::Vector3f> NormalAt(const TsdfVolume& tsdf, const GridIndex& voxel) {
  Eigen::Vector3f gradient;
  const float centre = DistanceAt(tsdf, voxel);
  for (int axis = 0; axis < 3; ++axis) {
    const float below = DistanceAt(tsdf, voxel - GridIndex::Unit(axis));
    const float above = DistanceAt(tsdf, voxel + GridIndex::Unit(axis));
    if (!std::isnan(below) && !std::isnan(above)) {
      gradient[axis] = 0.5F * (above - below);
    } else if (!std::isnan(above)) {
      gradient[axis] = above - centre;
    } else if (!std::isnan(below)) {
      gradient[axis] = centre - below;
    } else {
      return std::nullopt;
    }
  }
  const float norm = gradient.norm();
  if (!(norm > 0.0F)) return std::nullopt;
  return gradient / norm;
}

/// The cosine of the difference of two angles in 0..180 degrees that have these cosines.
float CosineOfDifference(float a, float b) {
  const auto squared_sine = [](float cosine) { return std::max(0.0F, 1.0F - cosine * cosine); };
  return a * b + std::sqrt(squared_sine(a) * squared_sine(b));
}

}  // namespace

bool BelongsToFace(const ConditionRecord& record, const Eigen::Vector3f& normal, float min_cosine) {
  const float cosine = normal.dot(DecodeDirection(record.direction));
  return cosine >= min_cosine &&
         CosineOfDifference(cosine, record.cosine_seen()) >= kOtherFaceCosine;
}

TemperatureReview::TemperatureReview(const ThermalOptions& options,
                                     const ThermalSensorModel& sensor)
    : limits_(options, sensor), keep_bad_(options.expert().keep_bad()) {}

bool TemperatureReview::IsBesideSteepFace(const ConditionRecord& record,
                                          const Eigen::Vector3f& normal, const TsdfVolume& tsdf,
                                          const GridIndex& voxel) const {
  const Eigen::Vector3f to_camera = DecodeDirection(record.direction);
  const Eigen::Vector3f right = normal.unitOrthogonal();
  const Eigen::Vector3f down = normal.cross(right);
  for (const Eigen::Vector3f& side :
       {right, Eigen::Vector3f(-right), down, Eigen::Vector3f(-down)}) {
    const GridIndex beside =
        voxel + (kBesideVox * side).array().round().cast<std::int32_t>().matrix();
    const auto other = NormalAt(tsdf, beside);
    if (other && other->dot(normal) < kOtherFaceCosine &&
        other->dot(to_camera) < limits_.cosine_max_angle)
      return true;
  }
  return false;
}

std::int64_t TemperatureReview::Review(std::int32_t block, const TsdfVolume& tsdf,
                                       ThermalVolume& thermal, bool is_final) const {
  if (thermal.records() == nullptr || keep_bad_) return 0;
  std::int64_t dropped = 0;
  const auto voxels = thermal.voxels(block);
  const GridIndex base = tsdf.block_coordinates(block) * kBlockSide;
  for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
    RecordRow* records = thermal.records()->Find(block, row);
    if (records == nullptr) continue;
    for (int x = 0; x < RecordRow::kVoxels; ++x) {
      ThermalVoxel& voxel = voxels[row * RecordRow::kVoxels + x];
      ConditionRecord& record = records->conditions[x];
      if (!voxel.measured() || record.empty()) continue;
      const GridIndex at = base + GridIndex(x, row % kBlockSide, row / kBlockSide);
      const auto normal = NormalAt(tsdf, at);
      if (!normal) continue;
      if (BelongsToFace(record, *normal, limits_.cosine_max_angle) &&
          !(is_final && IsBesideSteepFace(record, *normal, tsdf, at))) {
        continue;
      }
      // The classes stay, but for the angle's: a new measurement of any kind replaces it.
      constexpr std::uint32_t kBadAngle = static_cast<std::uint32_t>(ConditionClass::kBad)
                                          << ThermalLayout::kAngleShift;
      voxel.bits =
          (voxel.bits & ThermalLayout::kClassesMask & ~ThermalLayout::kAngleMask) | kBadAngle;
      record = ConditionRecord();
      thermal.records()->Sigmas(block, row)[x] = 0;
      ++dropped;
    }
  }
  return dropped;
}

}  // namespace isotherm
