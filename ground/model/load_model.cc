#include "ground/model/load_model.h"

#include <algorithm>

#include "ground/model/model_file.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

Result<LoadedModel> LoadModel(const std::filesystem::path& path, GroundOptions& options) {
  const Result<std::unique_ptr<ModelFile>> file = ModelFile::Open(path);
  if (!file) return Err(file.error());
  if (Status status = (*file)->AdoptVolume(options); !status.ok()) return Err(status);
  const Result<VoxelGrid> grid = MakeVoxelGrid(options.volume());
  if (!grid) return Err(grid.error().WithContext(path.string()));
  const std::int32_t max_blocks = MaxBlocks(options.volume(), *grid);
  const std::filesystem::path spill_dir = options.volume().spill_dir();
  LoadedModel model;
  model.rig = (*file)->rig();
  model.known_poses = (*file)->known_poses();
  model.tsdf = std::make_unique<TsdfVolume>(*grid, options.tsdf().expert().truncation_distance_m(),
                                            max_blocks, spill_dir);
  model.thermal = std::make_unique<ThermalVolume>(max_blocks, spill_dir);
  if (!model.thermal->Commit(std::min(max_blocks, (*file)->block_count())))
    return Err(ResourceExhausted("no room for the model in volume.spill_dir"));
  if (Status status = (*file)->ReadBlocks(*model.tsdf, *model.thermal); !status.ok())
    return Err(status);
  return model;
}

}  // namespace isotherm
