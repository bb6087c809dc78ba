#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>

#include "ground/thermal/measurement_quality.h"
#include "ground/thermal/thermal_records.h"
#include "ground/thermal/voxel_layout.h"
#include "ground/tsdf/growing_arena.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// One thermal voxel in 32 bits (ThermalLayout): a temperature and the classes of the conditions
/// under which it was measured.
struct ThermalVoxel {
  static constexpr float kMin_celsius = ThermalLayout::kMin_celsius;
  static constexpr float kStep_k = ThermalLayout::kStep_k;

  std::uint32_t bits = 0;

  static ThermalVoxel Make(float celsius, ConditionClass distance, ConditionClass angle,
                           ConditionClass motion = ConditionClass::kUnchecked,
                           ConditionClass disagreement = ConditionClass::kUnchecked);
  bool measured() const { return ThermalLayout::Code(bits) != 0; }
  /// Measured, or tried under bad conditions: the classes say which (temperature code 0).
  bool assessed() const { return bits != 0; }
  /// °C; NaN = never measured.
  float celsius() const {
    const std::uint32_t code = ThermalLayout::Code(bits);
    return code == 0 ? NAN : kMin_celsius + kStep_k * static_cast<float>(code - 1);
  }
  ConditionClass distance_class() const {
    return static_cast<ConditionClass>(bits >> ThermalLayout::kDistanceShift &
                                       ThermalLayout::kClassMask);
  }
  ConditionClass angle_class() const {
    return static_cast<ConditionClass>(bits >> ThermalLayout::kAngleShift &
                                       ThermalLayout::kClassMask);
  }
  /// Returns how much the image was smeared when the temperature was measured.
  ConditionClass motion_class() const {
    return ThermalLayout::Decode(bits >> ThermalLayout::kMotionShift);
  }
  /// Returns how far measurements under good conditions contradict each other.
  ConditionClass disagreement_class() const {
    return ThermalLayout::Decode(bits >> ThermalLayout::kDisagreementShift);
  }
  /// kNever if it was not even tried.
  MeasurementQuality quality() const {
    return assessed() ? QualityOf(distance_class(), angle_class(), motion_class())
                      : MeasurementQuality::kNever;
  }
  void set_disagreement_class(ConditionClass c) {
    bits = (bits & ~ThermalLayout::kDisagreementMask) |
           (ThermalLayout::Encode(c) << ThermalLayout::kDisagreementShift);
  }
};
static_assert(sizeof(ThermalVoxel) == 4);

/// Temperatures and their conditions, in a block parallel to each TSDF block (same index).
/// Thread-compatible; different blocks may be written by different threads.
class ThermalVolume {
 public:
  /// With a `spill_dir`, memory can be given back (GrowingArena). `with_records`: the conditions of
  /// each measurement are kept, too.
  explicit ThermalVolume(std::int32_t max_blocks, const std::filesystem::path& spill_dir = {},
                         bool with_records = true);

  /// To be called before blocks up to this number are written. False if the disk is full.
  bool Commit(std::int32_t blocks);
  /// Gives the memory of blocks back until they are touched again; does nothing without a spill
  /// folder.
  void Decommit(std::int32_t first_block, std::int32_t count) const {
    constexpr std::size_t kBlockBytes = kBlockVoxels * sizeof(ThermalVoxel);
    arena_.Decommit(static_cast<std::size_t>(first_block) * kBlockBytes,
                    static_cast<std::size_t>(count) * kBlockBytes);
    if (records_) records_->Decommit(first_block, count);
  }

  /// Has blocks that were given back read in the background.
  void Fetch(std::int32_t first_block, std::int32_t count) const {
    constexpr std::size_t kBlockBytes = kBlockVoxels * sizeof(ThermalVoxel);
    arena_.Fetch(static_cast<std::size_t>(first_block) * kBlockBytes,
                 static_cast<std::size_t>(count) * kBlockBytes);
    if (records_) records_->Fetch(first_block, count);
  }

  /// nullptr if none are kept.
  ThermalRecords* records() { return records_.get(); }
  const ThermalRecords* records() const { return records_.get(); }

  /// SigmaCode of a voxel's temperature; 0 = not known.
  std::uint8_t sigma_code(std::int32_t block, int voxel) const;

  std::span<ThermalVoxel, kBlockVoxels> voxels(std::int32_t block) {
    return std::span<ThermalVoxel, kBlockVoxels>(base() + std::size_t{kBlockVoxels} * block,
                                                 kBlockVoxels);
  }
  std::span<const ThermalVoxel, kBlockVoxels> voxels(std::int32_t block) const {
    return std::span<const ThermalVoxel, kBlockVoxels>(base() + std::size_t{kBlockVoxels} * block,
                                                       kBlockVoxels);
  }

 private:
  ThermalVoxel* base() const { return reinterpret_cast<ThermalVoxel*>(arena_.data()); }
  GrowingArena arena_;
  std::unique_ptr<ThermalRecords> records_;
};

/// Holds what is known about the temperature of a surface point.
struct PointMeasurement {
  ThermalVoxel voxel;
  ConditionRecord conditions;  ///< Empty: not kept.
  float sigma_k = NAN;  ///< Standard uncertainty of the apparent temperature; NaN = not known.
  DisagreementRecord disagreement{};  ///< Between conditions.good_count measurements.
};

/// Where a voxel is kept.
struct VoxelPlace {
  std::int32_t block = TsdfVolume::kNoBlock;
  int index = 0;  ///< Within the block.
};

/// Copies the record of a voxel of `source` to one of `target`, whose coordinate frame is turned by
/// R_target_source, as far as both volumes keep any.
void AdoptRecord(const ThermalVolume& source, const VoxelPlace& from,
                 const Eigen::Matrix3f& R_target_source, ThermalVolume& target,
                 const VoxelPlace& to);

/// The measurement that belongs to a surface point: of the voxel the point lies in, or, if nothing
/// was ever tried there, of the nearest measured one among the 26 around it. Unmeasured if none.
PointMeasurement MeasurementAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                               const Eigen::Vector3d& p_map);
ThermalVoxel ThermalVoxelAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                            const Eigen::Vector3d& p_map);

}  // namespace isotherm
