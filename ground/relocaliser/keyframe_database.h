#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A depth image of 20 x 15 cells, metres along z; 0 = nothing seen.
struct Thumbnail {
  /// Coarse enough that a view some centimetres off looks alike, fine enough that places differ:
  /// each cell is 32 x 32 pixels of a 640 x 480 image. Chosen with the relocaliser (ADR 7), not
  /// tuned.
  static constexpr int kWidth = 20;
  static constexpr int kHeight = 15;
  std::array<float, kWidth * kHeight> depth_m{};
};

/// Means of the depths in each cell that has enough of them. Nothing is seen of an image smaller
/// than a thumbnail.
Thumbnail MakeThumbnail(const Image<float>& depth_m);

/// Returns how badly two thumbnails agree: 0 = the same, 1 = nowhere. Of cells that only one of
/// them sees, those of `image` count half: the other may not know what is there.
float Disagreement(const Thumbnail& image, const Thumbnail& expected);

/// A pose from which the model may look like an image.
struct PoseGuess {
  RigidTransform T_map_depth;
  float disagreement = 1.0F;
};

/// Points on the model's surface in `map`, metres, evenly spread and at most `max_points`; the
/// spacing is about half a block or more.
std::vector<Eigen::Vector3f> MakeSurfaceCloud(const TsdfVolume& volume, std::size_t max_points,
                                              ThreadPool& pool);

/// Poses that were tracked well, kept as the scan grows, and where an image may have been taken: a
/// coarse cloud of the model is looked at from poses all around them and compared with the image.
/// Bounded. Thread-compatible.
class KeyframeDatabase {
 public:
  KeyframeDatabase(const CameraModel& depth_camera, int max_views);

  /// Keeps a tracked pose if no known one is near.
  void Add(const RigidTransform& T_map_depth);
  const std::vector<RigidTransform>& poses() const { return poses_; }

  /// Sets what is looked at from now on.
  void SetCloud(const std::vector<Eigen::Vector3f>& cloud);

  /// The best guesses, best first, none close to another. Looks from around some of the known poses
  /// only; the next call goes on with others.
  std::vector<PoseGuess> Guess(const Thumbnail& image, int max_guesses, ThreadPool& pool);

 private:
  /// Moves a guess step by step to where it disagrees least.
  PoseGuess Improve(const Thumbnail& image, PoseGuess guess) const;
  /// Returns what the cloud looks like from a pose.
  Thumbnail Look(const RigidTransform& T_map_depth) const;

  const CameraModel camera_;  ///< The camera of a thumbnail.
  const std::size_t max_views_;
  std::vector<RigidTransform> poses_;
  Eigen::ArrayX3f cloud_;  ///< A point per row.
  std::size_t next_pose_ = 0;
};

}  // namespace isotherm
