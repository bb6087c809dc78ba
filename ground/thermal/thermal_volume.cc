#include "ground/thermal/thermal_volume.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "ground/thermal/sigma_code.h"

namespace isotherm {

ThermalVoxel ThermalVoxel::Make(float celsius, ConditionClass distance, ConditionClass angle,
                                ConditionClass motion, ConditionClass disagreement) {
  // Code 0 stands for "never measured", so that the coldest temperature has code 1.
  const float code = std::clamp(1.0F + std::round((celsius - kMin_celsius) / kStep_k), 1.0F,
                                ThermalLayout::kMaxCode);
  ThermalVoxel voxel;
  voxel.bits = static_cast<std::uint32_t>(code) << ThermalLayout::kCodeShift |
               ThermalLayout::Classes(distance, angle, motion, disagreement);
  return voxel;
}

ThermalVolume::ThermalVolume(std::int32_t max_blocks, const std::filesystem::path& spill_dir,
                             bool with_records)
    : arena_(static_cast<std::size_t>(max_blocks) * kBlockVoxels * sizeof(ThermalVoxel),
             spill_dir) {
  if (with_records) records_ = std::make_unique<ThermalRecords>(max_blocks, spill_dir);
}

bool ThermalVolume::Commit(std::int32_t blocks) {
  return arena_.Commit(static_cast<std::size_t>(blocks) * kBlockVoxels * sizeof(ThermalVoxel)) &&
         (!records_ || records_->Commit(blocks));
}

namespace {

VoxelPlace PlaceOf(const TsdfVolume& tsdf, const GridIndex& voxel) {
  if ((voxel.array() < 0).any()) return {};
  return {tsdf.Find(voxel / kBlockSide), BlockLayout::Element(voxel.x(), voxel.y(), voxel.z())};
}

ThermalVoxel VoxelAt(const ThermalVolume& thermal, const VoxelPlace& place) {
  return place.block == TsdfVolume::kNoBlock ? ThermalVoxel()
                                             : thermal.voxels(place.block)[place.index];
}

/// The voxel that speaks for a point.
VoxelPlace PlaceFor(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                    const Eigen::Vector3d& p_map) {
  const Eigen::Vector3d p_voxel = tsdf.grid().ToVoxel(p_map);
  const GridIndex centre = p_voxel.array().round().cast<int>();
  // The voxel that the point is in speaks for it if it is measured and checked; else the nearest
  // measured one around it, since a surface point may lie on the border of voxels that were
  // updated.
  const VoxelPlace own = PlaceOf(tsdf, centre);
  if (VoxelAt(thermal, own).assessed()) return own;
  VoxelPlace nearest = own;
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const GridIndex index = centre + GridIndex(x, y, z);
        const double squared = (index.cast<double>() - p_voxel).squaredNorm();
        if (squared >= nearest_squared) continue;
        const VoxelPlace candidate = PlaceOf(tsdf, index);
        if (!VoxelAt(thermal, candidate).measured()) continue;
        nearest = candidate;
        nearest_squared = squared;
      }
    }
  }
  return nearest;
}

}  // namespace

void AdoptRecord(const ThermalVolume& source, const VoxelPlace& from,
                 const Eigen::Matrix3f& R_target_source, ThermalVolume& target,
                 const VoxelPlace& to) {
  if (source.records() == nullptr || target.records() == nullptr) return;
  const int from_row = from.index / RecordRow::kVoxels,
            from_column = from.index % RecordRow::kVoxels;
  const int to_row = to.index / RecordRow::kVoxels, to_column = to.index % RecordRow::kVoxels;
  const RecordRow* old_row = source.records()->Find(from.block, from_row);
  if (old_row == nullptr) return;
  RecordRow& new_row = target.records()->Row(to.block, to_row);
  ConditionRecord& conditions = new_row.conditions[to_column];
  conditions = old_row->conditions[from_column];
  // Directions are in the coordinates of their sub-map.
  conditions.direction = EncodeDirection(R_target_source * DecodeDirection(conditions.direction));
  new_row.disagreement[to_column] = old_row->disagreement[from_column];
  target.records()->Sigmas(to.block, to_row)[to_column] = source.sigma_code(from.block, from.index);
}

std::uint8_t ThermalVolume::sigma_code(std::int32_t block, int voxel) const {
  if (records_ == nullptr) return 0;
  const std::uint8_t* row = std::as_const(*records_).FindSigmas(block, voxel / RecordRow::kVoxels);
  return row == nullptr ? std::uint8_t{0} : row[voxel % RecordRow::kVoxels];
}

PointMeasurement MeasurementAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                               const Eigen::Vector3d& p_map) {
  const VoxelPlace place = PlaceFor(tsdf, thermal, p_map);
  PointMeasurement measurement{.voxel = VoxelAt(thermal, place), .conditions = {}};
  if (!measurement.voxel.measured() || thermal.records() == nullptr) return measurement;
  const RecordRow* row = thermal.records()->Find(place.block, place.index / RecordRow::kVoxels);
  if (row != nullptr) {
    measurement.conditions = row->conditions[place.index % RecordRow::kVoxels];
    measurement.disagreement = row->disagreement[place.index % RecordRow::kVoxels];
  }
  measurement.sigma_k = SigmaCode::Kelvin(thermal.sigma_code(place.block, place.index));
  return measurement;
}

ThermalVoxel ThermalVoxelAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                            const Eigen::Vector3d& p_map) {
  return VoxelAt(thermal, PlaceFor(tsdf, thermal, p_map));
}

}  // namespace isotherm
