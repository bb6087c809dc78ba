#include "ground/evaluation/thermal_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "common/frame/image.h"

namespace isotherm {
namespace {

/// Discs seen more from the side than this are left to their neighbours.
constexpr float kMinFacing = 0.05F;
/// Points that lie behind the first surface by no more than this many spacings belong to it.
constexpr float kBehindSpacings = 3.0F;
constexpr float kMinDepth_m = 0.05F;

/// One pose's view of the true points.
class View {
 public:
  View(const TrueSurface& truth, const CameraModel& camera, const RigidTransform& T_truth_camera)
      : truth_(truth),
        camera_(camera.WithoutDistortion()),
        R_(T_truth_camera.linear().transpose().cast<float>()),
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
    const float cosine = -(R_ * truth_.points().normals[i]).dot(p) / distance_m;
    if (cosine < std::cos(limits.max_angle_deg * std::numbers::pi / 180.0)) return false;
    const auto u = static_cast<int>(std::floor(U(p) + 0.5F));
    const auto v = static_cast<int>(std::floor(V(p) + 0.5F));
    if (u < 0 || v < 0 || u >= camera_.width || v >= camera_.height) return false;
    return p.z() <= depth_m_.At(u, v) + kBehindSpacings * truth_.spacing_m();
  }

 private:
  Eigen::Vector3f Point(std::size_t i) const {
    return R_ * (truth_.points().positions_m[i] - position_);
  }
  float U(const Eigen::Vector3f& p) const {
    return static_cast<float>(camera_.fx) * p.x() / p.z() + static_cast<float>(camera_.cx);
  }
  float V(const Eigen::Vector3f& p) const {
    return static_cast<float>(camera_.fy) * p.y() / p.z() + static_cast<float>(camera_.cy);
  }

  void Draw(std::size_t i) {
    const Eigen::Vector3f p = Point(i);
    if (!(p.z() > kMinDepth_m)) return;
    const float radius_m = truth_.spacing_m();
    const Eigen::Vector3f n = R_ * truth_.points().normals[i];
    const float extent_px =
        std::ceil(static_cast<float>(std::max(camera_.fx, camera_.fy)) * radius_m / p.z());
    const auto first = [&](float at) { return std::max(0, static_cast<int>(at - extent_px)); };
    const auto last = [&](float at, int size) {
      return std::min(size - 1, static_cast<int>(at + extent_px));
    };
    for (int y = first(V(p)); y <= last(V(p), camera_.height); ++y) {
      for (int x = first(U(p)); x <= last(U(p), camera_.width); ++x) {
        const Eigen::Vector3f ray = Unproject(camera_, {x, y}).homogeneous().cast<float>();
        const float facing = n.dot(ray);
        if (std::abs(facing) < kMinFacing) continue;
        const float z = n.dot(p) / facing;
        if ((ray * z - p).squaredNorm() > radius_m * radius_m) continue;
        depth_m_.At(x, y) = std::min(depth_m_.At(x, y), z);
      }
    }
  }

  const TrueSurface& truth_;
  const CameraModel camera_;
  const Eigen::Matrix3f R_;
  const Eigen::Vector3f position_;
  Image<float> depth_m_;
};

}  // namespace

ThermalCoverage EvaluateThermalCoverage(const TrueSurface& truth, const CameraModel& camera,
                                        std::span<const RigidTransform> T_truth_thermal,
                                        const WellSeenLimits& limits,
                                        std::span<const Eigen::Vector3f> assigned, float radius_m) {
  std::vector<bool> seen(truth.points().positions_m.size(), false);
  for (const RigidTransform& pose : T_truth_thermal) {
    const View view(truth, camera, pose);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen[i]) seen[i] = view.SeesWell(i, limits);
    }
  }
  const PointIndex index(assigned);
  ThermalCoverage coverage;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) continue;
    ++coverage.well_seen;
    if (index.Nearest(truth.points().positions_m[i], radius_m)) ++coverage.covered;
  }
  return coverage;
}

}  // namespace isotherm
