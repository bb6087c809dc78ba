#include "ground/evaluation/thermal_coverage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "common/base/units.h"
#include "common/frame/image.h"
#include "common/geometry/rectified_camera.h"

namespace isotherm {
namespace {

/// Discs seen more from the side than this are left to their neighbours.
constexpr float kMinFacing = 0.05F;
/// Points that lie behind the first surface by no more than this many spacings belong to it.
constexpr float kBehindSpacings = 3.0F;
/// Nearer discs would fill the image and belong to no scan.
constexpr float kMinDepth_m = 0.05F;

/// Where the pixels of a camera look: through its lens, so that what it distorts out of the image
/// does not count, nor does what it draws in get lost.
Image<Eigen::Vector2f> LinesOfSight(const CameraModel& camera) {
  Image<Eigen::Vector2f> lines(camera.width, camera.height, Eigen::Vector2f::Zero());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) lines.At(u, v) = Unproject(camera, {u, v}).cast<float>();
  }
  return lines;
}

/// One pose's view of the true points.
class View {
 public:
  View(const TrueSurface& truth, const CameraModel& camera,
       const Image<Eigen::Vector2f>& lines_of_sight, const RigidTransform& T_truth_camera)
      : truth_(truth),
        camera_(camera),
        lines_of_sight_(lines_of_sight),
        rotation_(T_truth_camera.linear().transpose().cast<float>()),
        position_(T_truth_camera.translation().cast<float>()),
        depth_m_(camera.width, camera.height, std::numeric_limits<float>::max()) {
    for (std::size_t i = 0; i < truth.points().positions_m.size(); ++i) Draw(i);
  }

  bool SeesWell(std::size_t i, const WellSeenLimits& limits) const {
    const Eigen::Vector3f p = Point(i);
    const float distance_m = p.norm();
    if (!(p.z() > kMinDepth_m) || distance_m < limits.min_distance_m ||
        distance_m > limits.max_distance_m) {
      return false;
    }
    const float cosine = -(rotation_ * truth_.points().normals[i]).dot(p) / distance_m;
    if (cosine < std::cos(limits.max_angle_deg * kRadPerDeg) ||
        cosine > std::cos(limits.min_angle_deg * kRadPerDeg)) {
      return false;
    }
    const auto pixel = ProjectIntoImage(camera_, Normalized(p));
    if (!pixel) return false;
    const auto u = static_cast<int>(std::floor(pixel->x() + 0.5));
    const auto v = static_cast<int>(std::floor(pixel->y() + 0.5));
    return p.z() <= depth_m_.At(u, v) + kBehindSpacings * truth_.spacing_m();
  }

 private:
  Eigen::Vector3f Point(std::size_t i) const {
    return rotation_ * (truth_.points().positions_m[i] - position_);
  }
  static Eigen::Vector2d Normalized(const Eigen::Vector3f& p) {
    return (p.head<2>() / p.z()).cast<double>();
  }

  /// Pixels that may see a disc of one spacing around `p`; empty outside the image.
  Eigen::AlignedBox2i PixelsAround(const Eigen::Vector3f& p) const {
    const float radius_m = truth_.spacing_m();
    Eigen::AlignedBox2d place;
    for (const float x : {-radius_m, radius_m}) {
      for (const float y : {-radius_m, radius_m})
        place.extend(ProjectNormalized(camera_, Normalized(p + Eigen::Vector3f(x, y, 0.0F))));
    }
    const Eigen::Vector2d last(camera_.width - 1, camera_.height - 1);
    const Eigen::AlignedBox2d image(Eigen::Vector2d::Zero(), last);
    // A point far outside has no place that an integer could hold.
    if (!place.sizes().allFinite() || !image.intersects(place)) return {};
    const Eigen::AlignedBox2d inside = image.intersection(place);
    return {inside.min().array().floor().cast<int>().matrix(),
            inside.max().array().ceil().cast<int>().matrix()};
  }

  void Draw(std::size_t i) {
    const Eigen::Vector3f p = Point(i);
    if (!(p.z() > kMinDepth_m)) return;
    const float radius_m = truth_.spacing_m();
    const Eigen::Vector3f n = rotation_ * truth_.points().normals[i];
    const Eigen::AlignedBox2i pixels = PixelsAround(p);
    for (int y = pixels.min().y(); y <= pixels.max().y(); ++y) {
      for (int x = pixels.min().x(); x <= pixels.max().x(); ++x) {
        const Eigen::Vector3f ray = lines_of_sight_.At(x, y).homogeneous();
        const float facing = n.dot(ray);
        if (std::abs(facing) < kMinFacing) continue;
        const float z = n.dot(p) / facing;
        if ((ray * z - p).squaredNorm() > radius_m * radius_m) continue;
        depth_m_.At(x, y) = std::min(depth_m_.At(x, y), z);
      }
    }
  }

  const TrueSurface& truth_;
  const CameraModel& camera_;
  const Image<Eigen::Vector2f>& lines_of_sight_;
  const Eigen::Matrix3f rotation_;
  const Eigen::Vector3f position_;
  Image<float> depth_m_;
};

}  // namespace

std::vector<ThermalCoverage> EvaluateThermalCoverage(const TrueSurface& truth,
                                                     const ThermalViews& views,
                                                     std::span<const WellSeenLimits> limits,
                                                     const CoveringPoints& cloud,
                                                     ThreadPool& pool) {
  const std::size_t points = truth.points().positions_m.size();
  // Poses that see a point, by limits and then by point.
  std::vector<std::atomic<int>> poses_seeing(limits.size() * points);
  const Image<Eigen::Vector2f> lines_of_sight = LinesOfSight(views.camera);
  pool.ParallelFor(static_cast<int>(views.T_truth_thermal.size()), [&](int pose) {
    const View view(truth, views.camera, lines_of_sight,
                    views.T_truth_thermal[static_cast<std::size_t>(pose)]);
    for (std::size_t k = 0; k < limits.size(); ++k) {
      for (std::size_t i = 0; i < points; ++i) {
        std::atomic<int>& seeing = poses_seeing[k * points + i];
        if (seeing < limits[k].min_poses && view.SeesWell(i, limits[k])) ++seeing;
      }
    }
  });
  const PointIndex index(cloud.assigned.positions_m);
  std::vector<ThermalCoverage> coverage(limits.size());
  for (std::size_t i = 0; i < points; ++i) {
    const auto nearest = index.Nearest(truth.points().positions_m[i], cloud.radius_m);
    for (std::size_t k = 0; k < limits.size(); ++k) {
      if (poses_seeing[k * points + i] < limits[k].min_poses) continue;
      ++coverage[k].well_seen;
      coverage[k].covered += nearest ? 1 : 0;
      coverage[k].measured_well += nearest && cloud.assigned.good[nearest->index] ? 1 : 0;
    }
  }
  return coverage;
}

}  // namespace isotherm
