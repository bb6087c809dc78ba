#pragma once

#include <cstdint>

#include "ground/console/group_key.h"
#include "ground/console/live.pb.h"
#include "ground/mesh/surface.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

/// A vertex of a SurfaceGroup; live.proto says what its numbers mean.
struct GroupVertex {
  std::uint16_t position[3];
  std::uint16_t temperature;
  std::uint8_t classes;
  std::uint8_t angle;
  std::uint8_t distance;
  std::uint8_t age;
};
static_assert(sizeof(GroupVertex) == 12);

/// Further numbers of a vertex (GroupDetails).
struct VertexDetails {
  std::uint8_t sigma;
  std::uint8_t epoch;
  std::uint8_t observations;
  std::uint8_t unused;
};
static_assert(sizeof(VertexDetails) == 4);

inline constexpr std::uint8_t kNoAngle = 255;
inline constexpr std::uint8_t kNoDistance = 0;
inline constexpr std::uint8_t kNoNucAge = 255;

/// Quantises a point whose position is `p_group` units of the group's scale from its origin.
GroupVertex ToVertex(const CloudPoint& point, const Eigen::Vector3f& p_group);
VertexDetails ToDetails(const CloudPoint& point);

/// A part of a surface as it is sent.
struct EncodedGroup {
  live::SurfaceGroup group;
  live::GroupDetails details;
};

/// Packs the mesh of a group, reordered so that it compresses well. `surface` has only points that
/// triangles use, in the coordinates of the sub-map.
EncodedGroup EncodeGroup(const GroupKey& key, std::uint32_t version, const VoxelGrid& grid,
                         const Surface& surface);

live::GroupKey ToMessage(const GroupKey& key);
GroupKey FromMessage(const live::GroupKey& key);

}  // namespace isotherm
