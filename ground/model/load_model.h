#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "common/rig/rig.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A saved model in memory, for results that need no further frames.
struct LoadedModel {
  Rig rig;  ///< Cameras and T_thermal_depth, as far as the model has them.
  std::vector<RigidTransform> known_poses;  ///< T_world_depth that were tracked well, in order.
  std::unique_ptr<TsdfVolume> tsdf;
  std::unique_ptr<ThermalVolume> thermal;
};

/// Reads all of a model file. The volume in `options` becomes the model's (ModelFile::AdoptVolume);
/// its memory limit and spill folder apply. Messages name the file.
Result<LoadedModel> LoadModel(const std::filesystem::path& path, GroundOptions& options);

}  // namespace isotherm
