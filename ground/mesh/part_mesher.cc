#include "ground/mesh/part_mesher.h"

namespace isotherm {

PartMesher::Part& PartMesher::PartOf(std::int32_t block) {
  std::int32_t& position = position_[static_cast<std::size_t>(block)];
  if (position >= 0) return parts_[static_cast<std::size_t>(position)];
  position = static_cast<std::int32_t>(part_count_);
  if (part_count_ == parts_.size()) parts_.emplace_back();
  Part& part = parts_[part_count_++];
  part.block = block;
  part.layers = 0;
  part.crossings.keys.clear();
  part.crossings.points.clear();
  return part;
}

Surface PartMesher::Extract(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                            std::span<const std::int32_t> blocks) {
  for (std::size_t i = 0; i < part_count_; ++i) {
    const auto block = static_cast<std::size_t>(parts_[i].block);
    if (block < position_.size()) position_[block] = -1;
  }
  part_count_ = 0;
  position_.resize(static_cast<std::size_t>(tsdf.block_count()), -1);
  const SurfaceCells cells(tsdf, thermal, options_);
  for (const std::int32_t block : blocks) PartOf(block).layers |= kWholeBlock;
  // A cube at the upper end of a block uses edges that start in its upper neighbours.
  for (const std::int32_t block : blocks) {
    for (int offset = 1; offset < 8; ++offset) {
      const GridIndex step(offset & 1, offset >> 1 & 1, offset >> 2 & 1);
      const std::int32_t neighbour = tsdf.Find(tsdf.block_coordinates(block) + step);
      if (neighbour == TsdfVolume::kNoBlock) continue;
      PartOf(neighbour).layers |= static_cast<VoxelLayers>(1U << offset);
    }
  }
  Surface surface;
  for (std::size_t i = 0; i < part_count_; ++i) {
    Part& part = parts_[i];
    cells.FindCrossings(part.block, part.layers, part.crossings);
    part.crossings.first = static_cast<std::uint32_t>(surface.points.size());
    surface.points.insert(surface.points.end(), part.crossings.points.begin(),
                          part.crossings.points.end());
  }
  BlockSigns signs;
  for (const std::int32_t block : blocks) {
    if (!cells.Gather(block, signs)) continue;
    const GridIndex& coordinates = tsdf.block_coordinates(block);
    const auto find = [&](const GridIndex& step, std::uint16_t key) {
      const std::int32_t owner = tsdf.Find(coordinates + step);
      return owner == TsdfVolume::kNoBlock ? kNoPoint : FindCrossing(PartOf(owner).crossings, key);
    };
    cubes_.Add(signs, find, surface.triangles);
  }
  return surface.MeshOnly();
}

}  // namespace isotherm
