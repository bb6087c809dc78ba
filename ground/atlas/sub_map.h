#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ground/relocaliser/relocaliser.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/block_versions.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A part of the scan that is rigid in itself: its surface, its temperatures, and the views from
/// which it was scanned, all in its own coordinates (`map`). Thread-compatible.
struct SubMap {
  std::unique_ptr<TsdfVolume> tsdf;
  std::unique_ptr<ThermalVolume> thermal;
  std::unique_ptr<Relocaliser> relocaliser;

  /// From `map` to the first sub-map's coordinates, which are `world`. Without meaning while not
  /// joined.
  RigidTransform T_world_map = RigidTransform::Identity();
  bool joined = false;  ///< A chain of views connects it with the first sub-map.
  /// Views that drift is counted from: the one where it was begun, or those of a saved model.
  std::vector<RigidTransform> anchors;
  std::uint64_t integrated = 0;  ///< Frames.
  BlockVersions versions;        ///< When blocks of `tsdf` and `thermal` last changed.
};

}  // namespace isotherm
