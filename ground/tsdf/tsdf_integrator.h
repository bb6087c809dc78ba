#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "common/geometry/rigid_transform.h"
#include "ground/options/ground_options.pb.h"
#include "ground/tsdf/integration_kernel.h"
#include "ground/tsdf/tsdf_volume.h"
#include "ground/tsdf/visible_blocks.h"

namespace isotherm {

struct PreparedDepth;

/// The option in metres, or what it stands for where it is 0: four voxels.
double TruncationDistance(const TsdfOptions& options, const VolumeOptions& volume);

Status Validate(const TsdfOptions& options, const VolumeOptions& volume);

/// Fuses depth images into the volume (algorithm 2). Distances are measured from the voxel to the
/// plane through the observed point along its normal, so that they do not depend on the direction
/// of view (thesis 8.2); where there is no normal, along the viewing ray as in the thesis. Keeps
/// scratch memory. Thread-compatible.
class TsdfIntegrator {
 public:
  explicit TsdfIntegrator(const TsdfOptions& options) : options_(options) {}

  /// Allocates the blocks within the truncation distance of the measured surface, then updates
  /// these and all that lie in front of it.
  void Integrate(const PreparedDepth& depth, const RigidTransform& T_map_depth, ThreadPool& pool,
                 TsdfVolume& volume);

  /// Blocks that the last call updated.
  const std::vector<std::int32_t>& updated_blocks() const { return updated_blocks_; }

 private:
  void MakeSamples(const PreparedDepth& depth, ThreadPool& pool);
  void AllocateBand(const PreparedDepth& depth, const RigidTransform& T_map_depth, ThreadPool& pool,
                    TsdfVolume& volume);
  void SelectBlocks(const CameraModel& camera, const RigidTransform& T_map_depth,
                    const TsdfVolume& volume);

  const TsdfOptions options_;
  std::vector<DepthSample> samples_;  ///< Per pixel, and one more with weight 0.
  Image<float> farthest_m_;           ///< Largest depth per tile of the image, 0 = nothing seen.
  std::vector<std::vector<std::int32_t>> missing_by_strip_;
  VisibleBlocks visible_;
  std::vector<std::int32_t> updated_blocks_;
};

/// Decides which tracked frames are integrated (thesis 6.1.3). Thread-compatible.
class IntegrationGate {
 public:
  explicit IntegrationGate(const TsdfOptions& options) : options_(options) {}

  /// `previous` is the pose of the frame before, if that was tracked.
  bool Accepts(const std::optional<RigidTransform>& previous, const RigidTransform& T_map_depth);
  std::uint64_t accepted() const { return accepted_; }
  /// The model is good already.
  void EndBootstrap() { bootstrap_ended_ = true; }
  /// An empty model again.
  void Restart() {
    last_integrated_.reset();
    accepted_ = 0;
    bootstrap_ended_ = false;
  }
  /// Returns whether the model still has to become better than one frame's noise.
  bool bootstrapping() const {
    return !bootstrap_ended_ && accepted_ < static_cast<std::uint64_t>(
                                                std::max(0, options_.expert().bootstrap_frames()));
  }

 private:
  const TsdfOptions options_;
  std::optional<RigidTransform> last_integrated_;
  std::uint64_t accepted_ = 0;
  bool bootstrap_ended_ = false;
};

}  // namespace isotherm
