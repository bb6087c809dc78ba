#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "ground/tracker/surface_maps.h"

namespace isotherm {

/// A depth picture of 20 x 15 cells, metres along z; 0 = nothing seen.
struct Thumbnail {
  static constexpr int kWidth = 20;
  static constexpr int kHeight = 15;
  std::array<float, kWidth * kHeight> depth_m{};
};

/// Means of the depths in each cell that has enough of them.
Thumbnail MakeThumbnail(const Image<float>& depth_m);

/// How badly two thumbnails agree: 0 = the same, 1 = nowhere. Of cells that only one of them sees,
/// those of `picture` count half: the other may not know what is there.
float Disagreement(const Thumbnail& picture, const Thumbnail& expected);

/// What a known view shows: a coarse cloud of its surface.
struct KnownView {
  RigidTransform T_world_depth;
  std::vector<Eigen::Vector3f> points;  ///< In the view's own camera coordinates, metres.
};

/// A pose from which the model may look like a picture.
struct PoseGuess {
  RigidTransform T_world_depth;
  float disagreement = 1.0F;
  std::size_t view = 0;  ///< Whose cloud it was compared with.
};

/// Views that were tracked well, kept as the scan grows, and where a picture may have been taken:
/// each view's cloud is looked at from poses all around it and compared with the picture. Bounded.
/// Thread-compatible.
class ViewLibrary {
 public:
  ViewLibrary(const CameraModel& depth_camera, int max_views);

  /// Keeps a tracked frame if it shows what no view does yet. `maps` in camera coordinates.
  void Add(const SurfaceMaps& maps, const RigidTransform& T_world_depth);
  /// As it was kept.
  void Add(KnownView view) { views_.push_back(std::move(view)); }
  const std::vector<KnownView>& views() const { return views_; }

  /// The best guesses, best first, none close to another. Looks from around some of the views
  /// only; the next call goes on with others.
  std::vector<PoseGuess> Guess(const Thumbnail& picture, int max_guesses, ThreadPool& pool);

 private:
  /// Moves a guess step by step to where it disagrees least.
  PoseGuess Improve(const Thumbnail& picture, const KnownView& view, PoseGuess guess) const;
  /// What the view's cloud looks like from elsewhere.
  Thumbnail Look(const KnownView& view, const RigidTransform& T_look_view) const;

  const CameraModel camera_;  ///< Of a thumbnail.
  const std::size_t max_views_;
  std::vector<RigidTransform> offsets_;  ///< T_view_look.
  std::vector<KnownView> views_;
  std::size_t next_view_ = 0;
};

}  // namespace isotherm
