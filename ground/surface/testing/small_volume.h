#pragma once

#include "ground/options/ground_options.pb.h"

namespace isotherm::testing {

inline constexpr double kSmallVoxel_m = 0.004;
/// Signed distances in a small volume are cut off here, metres.
inline constexpr double kSmallTruncation_m = 0.016;

/// A volume that holds the analytic scenes as SmallDepthCamera() sees them from FirstPose().
inline VolumeOptions SmallVolume() {
  VolumeOptions volume;
  volume.set_size_x_m(0.64);
  volume.set_size_y_m(0.64);
  volume.set_size_z_m(0.64);
  volume.set_voxel_size_m(kSmallVoxel_m);
  return volume;
}

}  // namespace isotherm::testing
