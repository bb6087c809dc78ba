#include "ground/model/saved_model.h"

#include <algorithm>

#include "common/base/check.h"

namespace isotherm {

Status SaveSubMap(const std::filesystem::path& path, const SubMap& map, const Rig& rig,
                  const std::function<void(double fraction)>& progress) {
  return SaveModel(path, *map.tsdf, *map.thermal, rig, map.relocaliser->keyframes().poses(),
                   progress);
}

Status LoadSubMap(const ModelFile& model, const Rig& rig, SubMap& map) {
  CHECK(map.tsdf->block_count() == 0);
  if (Status status = model.CheckRig(rig); !status.ok()) return status;
  if (!map.thermal->Commit(std::min(map.tsdf->max_blocks(), model.block_count())))
    return ResourceExhausted("no room for the model in volume.spill_dir");
  if (Status status = model.ReadBlocks(*map.tsdf, *map.thermal); !status.ok()) return status;
  if (map.tsdf->block_count() == 0) return OkStatus();
  for (const RigidTransform& pose : model.known_poses()) map.relocaliser->Add(pose);
  map.anchors = model.known_poses();
  return OkStatus();
}

}  // namespace isotherm
