#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>

#include "ground/thermal/thermal_records.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Exported where a point was never assigned a temperature.
inline constexpr std::uint8_t kNeverMeasured = 255;

/// Class of a measurement condition (eq. 6.3a-b) as it is exported.
enum class ConditionClass : std::uint8_t {
  kBad = 0,
  kGood = 1,
  kAcceptable = 2,
  kUnchecked = kNeverMeasured,  ///< Motion and disagreement only: not known.
};

/// One thermal voxel in 32 bits (thesis fig. 6.9; the table is in docs/model-format.md):
///   bits 31..16  temperature code: 0 = none, never measured or not kept, else 1 + (celsius + 100)
///   / 0.025 (steps of
///                0.025 K from -100 to 1538 °C)
///   bits 15..12  motion class, bits 11..8 disagreement class, each as 0 unchecked, 1 bad,
///                2 acceptable, 3 good: the zeros of a voxel from before these checks are right
///   bits  7..4   distance class, bits 3..0 angle class (ConditionClass)
struct ThermalVoxel {
  static constexpr float kMinCelsius = -100.0F;
  static constexpr float kStepKelvin = 0.025F;

  std::uint32_t bits = 0;

  static ThermalVoxel Make(float celsius, ConditionClass distance, ConditionClass angle,
                           ConditionClass motion = ConditionClass::kUnchecked,
                           ConditionClass disagreement = ConditionClass::kUnchecked);
  bool measured() const { return (bits >> 16) != 0; }
  /// Measured, or tried under bad conditions: the classes say which (temperature code 0).
  bool judged() const { return bits != 0; }
  /// °C; NaN = never measured.
  float celsius() const {
    const std::uint32_t code = bits >> 16;
    return code == 0 ? NAN : kMinCelsius + kStepKelvin * static_cast<float>(code - 1);
  }
  ConditionClass distance_class() const { return static_cast<ConditionClass>((bits >> 4) & 0xFU); }
  ConditionClass angle_class() const { return static_cast<ConditionClass>(bits & 0xFU); }
  /// How much the picture was smeared when the temperature was measured.
  ConditionClass motion_class() const { return Decode(bits >> kMotionShift); }
  /// How far measurements under good conditions contradict each other.
  ConditionClass disagreement_class() const { return Decode(bits >> kDisagreementShift); }
  void set_disagreement_class(ConditionClass c) {
    bits = (bits & ~(0xFU << kDisagreementShift)) | (Encode(c) << kDisagreementShift);
  }

  static constexpr int kMotionShift = 12;
  static constexpr int kDisagreementShift = 8;
  /// The four bits of a motion or disagreement class: more is better.
  static constexpr std::uint32_t Encode(ConditionClass c) {
    constexpr std::uint32_t kCodes[] = {1, 3, 2};
    return c == ConditionClass::kUnchecked ? 0 : kCodes[static_cast<std::size_t>(c)];
  }
  static constexpr ConditionClass Decode(std::uint32_t code) {
    constexpr ConditionClass kClasses[] = {ConditionClass::kUnchecked, ConditionClass::kBad,
                                           ConditionClass::kAcceptable, ConditionClass::kGood};
    return kClasses[code & 0x3U];
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
  bool Back(std::int32_t blocks);
  /// Gives the memory of blocks back until they are touched again; does nothing without a spill
  /// folder.
  void GiveBack(std::int32_t first_block, std::int32_t count) const {
    constexpr std::size_t kBlockBytes = kBlockVoxels * sizeof(ThermalVoxel);
    arena_.GiveBack(static_cast<std::size_t>(first_block) * kBlockBytes,
                    static_cast<std::size_t>(count) * kBlockBytes);
    if (records_) records_->GiveBack(first_block, count);
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
};

/// Copies the record of a voxel to one of another volume, whose coordinate frame is turned by
/// R_target_source, as far as both volumes keep any.
void AdoptRecord(const ThermalVolume& source, std::int32_t source_block, int source_voxel,
                 const Eigen::Matrix3f& R_target_source, std::int32_t block, int voxel,
                 ThermalVolume& target);

/// The measurement that belongs to a surface point: of the voxel the point lies in, or, if nothing
/// was ever tried there, of the nearest measured one among the 26 around it. Unmeasured if none.
PointMeasurement MeasurementAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                               const Eigen::Vector3d& p_map);
ThermalVoxel ThermalVoxelAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                            const Eigen::Vector3d& p_map);

}  // namespace isotherm
