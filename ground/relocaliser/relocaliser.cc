#include "ground/relocaliser/relocaliser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotherm {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Of the depth image's size, for refinement.
constexpr int kHalvings = 2;

/// Correspondences get stricter as the pose gets better.
struct RefinementStage {
  float max_distance_m;
  double max_angle_deg;
  int iterations;
};
constexpr RefinementStage kStages[] = {{0.12F, 60.0, 6}, {0.05F, 40.0, 6}, {0.025F, 30.0, 4}};

}  // namespace

Status Validate(const RelocaliserOptions& o) {
  if (!(o.min_inlier_ratio() > 0.0 && o.min_inlier_ratio() <= 1.0)) {
    return InvalidArgument(
        fmt::format("relocaliser.min_inlier_ratio must be above 0 and at most 1, got {}",
                    o.min_inlier_ratio()));
  }
  if (o.max_views() < 1 || o.max_views() > 100'000 || o.guesses_per_frame() < 1 ||
      o.guesses_per_frame() > 100) {
    return InvalidArgument(
        fmt::format("relocaliser: max_views must be 1..100000 and guesses_per_frame 1..100, got {} "
                    "and {}",
                    o.max_views(), o.guesses_per_frame()));
  }
  if (o.confirming_frames() < 0 || o.confirming_frames() > 100) {
    return InvalidArgument(
        fmt::format("relocaliser.confirming_frames must be 0..100, got {}", o.confirming_frames()));
  }
  return OkStatus();
}

Relocaliser::Relocaliser(const RelocaliserOptions& options, const CameraModel& depth_camera)
    : options_(options), library_(depth_camera, options.max_views()) {
  view_.camera = depth_camera.Downscaled(kHalvings);
}

double Relocaliser::Refine(const PreparedDepth& depth, const TsdfVolume& volume, float min_weight,
                           ThreadPool& pool, RigidTransform& pose) {
  double inlier_ratio = 0.0;
  for (const RefinementStage& stage : kStages) {
    view_.T_world_depth = pose;
    raycaster_.Cast(volume, view_.camera, pose, min_weight, pool, view_.maps);
    const IcpLimits limits{stage.max_distance_m,
                           static_cast<float>(std::cos(stage.max_angle_deg * kRadPerDeg))};
    for (int i = 0; i < stage.iterations; ++i) {
      const IcpSums sums =
          AccumulateIcp(depth.maps[kPyramidLevels - 1], pose, view_, volume.grid(), limits, pool);
      inlier_ratio = static_cast<double>(sums.inliers) /
                     static_cast<double>(std::max<std::int64_t>(sums.candidates, 1));
      constexpr std::int64_t kFewest = 200;
      if (sums.inliers < kFewest) return 0.0;
      const auto twist = MotionSpace().SolveObserved(sums.H, sums.g);
      if (!twist || !twist->allFinite()) return 0.0;
      ApplyTwist(*twist, pose);
      constexpr double kConverged = 1e-4;
      if (twist->norm() < kConverged) break;
    }
    constexpr double kHopeless = 0.4;
    if (inlier_ratio < kHopeless) return 0.0;
  }
  return inlier_ratio;
}

std::optional<RigidTransform> Relocaliser::Find(const PreparedDepth& depth,
                                                const TsdfVolume& volume, float min_weight,
                                                ThreadPool& pool) {
  const std::vector<PoseGuess> guesses =
      library_.Guess(MakeThumbnail(depth.depth_m), options_.guesses_per_frame(), pool);
  std::optional<RigidTransform> best;
  double best_ratio = options_.min_inlier_ratio();
  for (const PoseGuess& guess : guesses) {
    RigidTransform pose = guess.T_world_depth;
    const double ratio = Refine(depth, volume, min_weight, pool, pose);
    if (ratio < best_ratio) continue;
    best_ratio = ratio;
    best = pose;
  }
  return best;
}

}  // namespace isotherm
