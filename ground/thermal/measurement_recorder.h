#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/geometry/rigid_transform.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/nuc_epochs.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

/// The class of a disagreement: the range of `count` measurements beyond what noise alone shows.
ConditionClass ClassifyDisagreement(const ThermalOptions& options, float range_k, int count);

/// Writes down the conditions of what one frame measured, and how far measurements under good
/// conditions disagree. Never averages temperatures. Thread-safe for different blocks (immutable).
class MeasurementRecorder {
 public:
  /// `axes`: of FusionKernelArgs. `nuc`: when the frame was captured.
  MeasurementRecorder(const ThermalOptions& options, const RigidTransform& T_map_thermal,
                      const float* axes, const NucAge& nuc);

  /// `first`: centre of the block's first voxel, thermal camera coordinates. `thermal` must keep
  /// records.
  void Record(const BlockMeasurements& measured, const Eigen::Vector3f& first, std::int32_t block,
              ThermalVolume& thermal) const;

 private:
  const ThermalOptions& options_;
  const Eigen::Matrix3f R_map_thermal_;
  const Eigen::Matrix3f axes_;
  ConditionRecord frame_;  ///< Conditions that all measurements of the frame have in common.
};

}  // namespace isotherm
