#pragma once

#include <open3d/core/Tensor.h>
#include <open3d/t/geometry/Image.h>
#include <open3d/t/geometry/VoxelBlockGrid.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/stage_stats.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/geometry/stamped_pose.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

/// Milliseconds per frame.
struct FusionTimes {
  StageStats track, integrate, raycast, frame;
};

/// Open3D's dense SLAM (t::pipelines::slam::Model) on the CPU from the library's public operators,
/// with blocks of 8^3 voxels: point-to-plane odometry of a frame against the ray-cast model,
/// integration of every frame, ray cast at the depth image's size, all with the library's defaults.
/// Where Debian's build has no bilateral filter for floats (it lacks Intel's IPP), normals come
/// from depth smoothed by a 5 x 5 mean, which is what the library's parameters amount to.
/// Thread-bound.
class Open3dFusion {
 public:
  /// Holds the settings that must be equal for a comparison.
  struct Options {
    VoxelGrid grid;  ///< Blocks outside are left out, as ours are.
    double truncation_distance_m = 0.0;
    double min_depth_m = 0.0;
    double max_depth_m = 0.0;
    int threads = 1;
  };

  /// `camera` without distortion; `T_world_depth` is the first frame's pose.
  Open3dFusion(const Options& options, const CameraModel& camera,
               const RigidTransform& T_world_depth);

  void Process(const DepthFrame& frame);

  const FusionTimes& times() const { return times_; }
  const std::vector<StampedPose>& trajectory() const { return trajectory_; }
  /// Frames without a solution; they keep the pose of the frame before.
  std::uint64_t lost() const { return lost_; }

 private:
  using TensorImage = open3d::t::geometry::Image;
  static constexpr int kLevels = 3;
  /// Coarse to fine; the maps that a frame brings to the odometry.
  struct Level {
    open3d::core::Tensor vertices, normals;
  };
  using Pyramid = std::array<Level, kLevels>;

  Pyramid MakePyramid(const TensorImage& depth_raw, bool with_normals) const;
  void Track(const TensorImage& depth_raw);
  void Integrate(const TensorImage& depth_raw);
  void CastModel();
  open3d::core::Tensor InsideVolume(const open3d::core::Tensor& blocks) const;
  open3d::core::Tensor WorldToCamera() const;

  const Options options_;
  const int width_, height_;
  float depth_scale_ = 1000.0F;
  const float truncation_vox_;
  std::array<open3d::core::Tensor, kLevels> intrinsics_;  ///< Coarse to fine.
  open3d::t::geometry::VoxelBlockGrid model_;
  open3d::core::Tensor blocks_;  ///< Blocks of the last frame's surface.
  TensorImage model_depth_;      ///< Ray cast from the last pose.
  RigidTransform T_world_depth_;
  std::vector<StampedPose> trajectory_;
  std::uint64_t lost_ = 0;
  FusionTimes times_;
};

}  // namespace isotherm
