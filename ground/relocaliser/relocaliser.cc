#include "ground/relocaliser/relocaliser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

/// One step of refinement: the model is cast anew, and correspondences get stricter as the pose
/// gets better.
struct RefinementStage {
  int halvings;  ///< How often the depth image's size is halved.
  float max_distance_m;
  double max_angle_deg;
  int iterations;
};
// From the reach of a guess (kSameGuess, some centimetres) to what the tracker begins with
// (tracker.expert.max_distance_m). Coarse images first: they are cheap, and noise matters less than
// reach. Larger distances: other surfaces are taken for the right one; smaller: a guess must be
// better. Not tuned; with these 287 of 300 random starts are found, and none where the rig never
// was (docs/performance.md).
constexpr RefinementStage kFirstStage = {3, 0.12F, 60.0, 6};
constexpr RefinementStage kSecondStage = {3, 0.05F, 40.0, 6};
constexpr RefinementStage kLastStage = {2, 0.025F, 30.0, 4};

}  // namespace

Status Validate(const RelocaliserOptions& o) {
  if (!(o.expert().min_agreement() > 0.0 && o.expert().min_agreement() <= 1.0 &&
        o.expert().min_overlap() > 0.0 && o.expert().min_overlap() <= 1.0)) {
    return InvalidArgument(
        fmt::format("relocaliser.expert: min_agreement and min_overlap must be above 0 and at most "
                    "1, got {} and {}",
                    o.expert().min_agreement(), o.expert().min_overlap()));
  }
  if (o.expert().max_views() < 1 || o.expert().max_views() > 100'000 ||
      o.expert().guesses_per_frame() < 1 || o.expert().guesses_per_frame() > 100) {
    return InvalidArgument(fmt::format(
        "relocaliser.expert: max_views must be 1..100000 and guesses_per_frame 1..100, got {} "
        "and {}",
        o.expert().max_views(), o.expert().guesses_per_frame()));
  }
  if (o.expert().confirming_frames() < 0 || o.expert().confirming_frames() > 100) {
    return InvalidArgument(
        fmt::format("relocaliser.expert.confirming_frames must be 0..100, got {}",
                    o.expert().confirming_frames()));
  }
  return OkStatus();
}

class Relocaliser::Refinement {
 public:
  Refinement(Relocaliser& relocaliser, const PreparedDepth& depth, const TsdfVolume& volume,
             float min_weight, ThreadPool& pool)
      : relocaliser_(relocaliser),
        depth_(depth),
        volume_(volume),
        min_weight_(min_weight),
        pool_(pool) {}

  /// Says how well the frame fits, and where.
  struct Fit {
    RigidTransform pose;
    double agreement = 0.0;
    double overlap = 0.0;

    /// Prefers, among poses that agree equally well, the one that explains more.
    double score() const { return agreement * (1.0 + overlap); }
  };

  /// No agreement if there is nothing to align.
  Fit Run(const RefinementStage& stage, RigidTransform pose) {
    // The model is cast anew from the newest pose of each stage; within a stage it is good enough,
    // as the steps get small.
    ModelView& view = relocaliser_.view_;
    view.camera = relocaliser_.camera_.Downscaled(stage.halvings);
    view.T_map_depth = pose;
    relocaliser_.raycaster_.Cast(volume_, view.camera, pose, min_weight_, pool_, view.maps);
    const IcpLimits limits{stage.max_distance_m,
                           static_cast<float>(std::cos(stage.max_angle_deg * kRadPerDeg))};
    Fit fit;
    for (int i = 0; i < stage.iterations; ++i) {
      const IcpSums sums =
          AccumulateIcp(depth_.maps[kPyramidLevels - 1], pose, view, volume_.grid(), limits, pool_);
      // Of 4800 pixels of an 80 x 60 image. Fewer do not determine six unknowns in noise. Not
      // tuned.
      constexpr std::int64_t kMinInliers = 200;
      if (sums.inliers < kMinInliers) return {};
      // All directions count as observed: what a wall leaves open is refused by the tracker, which
      // measures it at full resolution.
      const auto twist = Observability().SolveObserved(sums.H, sums.g);
      if (!twist || !twist->allFinite()) return {};
      ApplyTwist(*twist, pose);
      fit = {pose, sums.agreement(), sums.overlap_ratio()};
      // A tenth of a millimetre and of a milliradian: far below the next stage's reach.
      constexpr double kConverged = 1e-4;
      if (twist->norm() < kConverged) break;
    }
    return fit;
  }

 private:
  Relocaliser& relocaliser_;
  const PreparedDepth& depth_;
  const TsdfVolume& volume_;
  const float min_weight_;
  ThreadPool& pool_;
};

Relocaliser::Relocaliser(const RelocaliserOptions& options, const CameraModel& depth_camera)
    : options_(options),
      camera_(depth_camera),
      keyframes_(depth_camera, options.expert().max_views()) {}

std::optional<RigidTransform> Relocaliser::Find(const PreparedDepth& depth,
                                                const TsdfVolume& volume, float min_weight,
                                                ThreadPool& pool) {
  if (!knows_model_) {
    // Ten for each cell of a thumbnail, so that a surface in view has no holes. More: each of some
    // hundred looks takes longer; fewer: cells stay empty. Not tuned.
    constexpr std::size_t kMaxPoints = 3000;
    keyframes_.SetCloud(MakeSurfaceCloud(volume, kMaxPoints, pool));
    knows_model_ = true;
  }
  Refinement refinement(*this, depth, volume, min_weight, pool);
  Refinement::Fit best;
  for (const PoseGuess& guess : keyframes_.Guess(MakeThumbnail(depth.depth_m),
                                                 options_.expert().guesses_per_frame(), pool)) {
    // Only the first, cheap stage is run for every guess, the others for the best.
    const Refinement::Fit fit = refinement.Run(kFirstStage, guess.T_map_depth);
    if (fit.score() > best.score()) best = fit;
  }
  for (const RefinementStage& stage : {kSecondStage, kLastStage}) {
    // Less of the model agrees than a right pose has after a coarse stage. Larger: a right pose
    // that began badly is given up; smaller: time is spent on wrong ones. Not tuned; the tracker's
    // verdict at full resolution decides in any case.
    constexpr double kHopeless = 0.4;
    if (best.agreement < kHopeless) return std::nullopt;
    best = refinement.Run(stage, best.pose);
  }
  if (best.agreement < options_.expert().min_agreement() ||
      best.overlap < options_.expert().min_overlap())
    return std::nullopt;
  return best.pose;
}

}  // namespace isotherm
