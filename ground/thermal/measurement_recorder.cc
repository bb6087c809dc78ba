#include "ground/thermal/measurement_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace isotherm {
namespace {

/// Fewer cannot tell a disagreement from noise.
constexpr int kMinGoodCount = 5;
/// Noise alone hardly ever shows a range of more standard deviations.
constexpr double kNoiseRange = 6.0;

}  // namespace

ConditionClass ClassifyDisagreement(const ThermalOptions& options, float range_k, int count) {
  if (count < kMinGoodCount) return ConditionClass::kUnchecked;
  const double beyond_noise_k =
      static_cast<double>(range_k) - kNoiseRange * options.expert().disagreement().noise_k();
  if (beyond_noise_k <= options.expert().disagreement().good_k()) return ConditionClass::kGood;
  return beyond_noise_k <= options.expert().disagreement().max_k() ? ConditionClass::kAcceptable
                                                                   : ConditionClass::kBad;
}

MeasurementRecorder::MeasurementRecorder(const ThermalOptions& options,
                                         const RigidTransform& T_map_thermal, const float* axes,
                                         const NucAge& nuc)
    : options_(options),
      R_map_thermal_(T_map_thermal.linear().cast<float>()),
      axes_(Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(axes)) {
  frame_.epoch = nuc.epoch;
  frame_.age = ConditionRecord::kNoAge;
  if (!nuc.seconds_since || !(*nuc.seconds_since >= 0.0)) return;
  const double steps = std::round(*nuc.seconds_since / double{ConditionRecord::kAgeStep_s});
  frame_.age = static_cast<std::uint32_t>(std::min(steps, double{ConditionRecord::kNoAge})) &
               ConditionRecord::kNoAge;
}

void MeasurementRecorder::Record(const BlockMeasurements& measured, const Eigen::Vector3f& first,
                                 std::int32_t block, ThermalVolume& thermal) const {
  const Eigen::Vector3f middle = first + axes_ * Eigen::Vector3f::Constant(0.5F * (kBlockSide - 1));
  // The directions within a block differ by a degree or two.
  const std::uint16_t direction = EncodeDirection((R_map_thermal_ * -middle).normalized());
  const auto voxels = thermal.voxels(block);
  // Rows lie anywhere in memory: all are asked for before the first one is needed.
  std::array<RecordRow*, ThermalRecords::kRowsPerBlock> rows{};
  for (int i = 0; i < measured.count; ++i) {
    const int voxel = measured.voxels[i] & BlockMeasurements::kVoxelMask;
    RecordRow*& row = rows[static_cast<std::size_t>(voxel / RecordRow::kVoxels)];
    if (row != nullptr) continue;
    row = &thermal.records()->Row(block, voxel / RecordRow::kVoxels);
    __builtin_prefetch(row->conditions, 1);
    __builtin_prefetch(row->disagreement, 1);
  }
  for (int i = 0; i < measured.count; ++i) {
    const std::int32_t voxel = measured.voxels[i] & BlockMeasurements::kVoxelMask;
    const auto word = static_cast<std::uint32_t>(measured.words[i]);
    const bool good = (word & ThermalLayout::kConditionMask) == kAllGood;
    RecordRow* row = rows[static_cast<std::size_t>(voxel / RecordRow::kVoxels)];
    ConditionRecord& record = row->conditions[voxel % RecordRow::kVoxels];
    if ((measured.voxels[i] & BlockMeasurements::kAssigned) != 0) {
      const Eigen::Vector3f offset(static_cast<float>(BlockLayout::X(voxel)),
                                   static_cast<float>(BlockLayout::Y(voxel)),
                                   static_cast<float>(BlockLayout::Z(voxel)));
      const float distance_m = (first + axes_ * offset).norm();
      const std::uint32_t count = record.good_count;
      record = frame_;
      record.good_count = count & ConditionRecord::kMaxGoodCount;
      record.direction = direction;
      record.cosine = ThermalPixel::Cosine(measured.flags[i]);
      thermal.records()->Sigmas(block, voxel / RecordRow::kVoxels)[voxel % RecordRow::kVoxels] =
          ThermalPixel::Sigma(measured.flags[i]);
      const auto steps =
          static_cast<std::uint32_t>(distance_m / ConditionRecord::kDistanceStep_m + 0.5F);
      record.distance =
          std::clamp(steps, 1U, ConditionRecord::kMaxDistance) & ConditionRecord::kMaxDistance;
    }
    if (!good) continue;
    DisagreementRecord& disagreement = row->disagreement[voxel % RecordRow::kVoxels];
    const int count = static_cast<int>(record.good_count);
    disagreement.Add(static_cast<std::uint16_t>(ThermalLayout::Code(word)), count);
    if (record.good_count < ConditionRecord::kMaxGoodCount)
      record.good_count = (record.good_count + 1) & ConditionRecord::kMaxGoodCount;
    voxels[voxel].set_disagreement_class(
        ClassifyDisagreement(options_, disagreement.range_k(), count + 1));
  }
}

}  // namespace isotherm
