#include "ground/camera_calibration/wall_view.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "common/base/noise.h"

namespace isotherm {
namespace {

constexpr int kMinPatch_px = 16;
constexpr int kMaxPatchesAcross = 48;   // Of large images patches are larger.
constexpr double kMinPatchShare = 0.5;  // Of its pixels that have a depth.
// A patch with a larger ratio of depths shows an edge.
constexpr float kMaxPatchDepth = 1.12F;
constexpr double kMinImageShare = 0.6;  // Of its patches.
// Fewer do not tell a plane from a bowl.
constexpr std::size_t kMinPatches = 40;
// A wall is no wall if more of the patches than this do not lie on it.
constexpr double kMaxOutside = 0.25;
constexpr int kFitRounds = 6;

std::optional<WallPatch> PatchAt(const CameraModel& camera, const Image<float>& depth_m, int left,
                                 int top, int side) {
  double count = 0.0, inverse = 0.0, x_px = 0.0, y_px = 0.0;
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0F;
  for (int y = top; y < top + side; ++y)
    for (int x = left; x < left + side; ++x) {
      const float depth = depth_m.At(x, y);
      if (!(depth > 0.0F)) continue;
      count += 1.0;
      inverse += 1.0 / depth;
      x_px += x;
      y_px += y;
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  const double share = count / (side * side);
  if (share < kMinPatchShare || farthest > kMaxPatchDepth * nearest) return std::nullopt;
  const Eigen::Vector2d pixel(x_px / count, y_px / count);
  const Eigen::Vector2d ray = Unproject(camera, pixel);
  return WallPatch{static_cast<float>(ray.x()),
                   static_cast<float>(ray.y()),
                   static_cast<float>(pixel.x() / (camera.width - 1)),
                   static_cast<float>(pixel.y() / (camera.height - 1)),
                   static_cast<float>(inverse / count),
                   static_cast<float>(share)};
}

/// Leaves the patches on the plane that most lie on, of planes through three of them; false if too
/// few do.
bool KeepWall(WallView& view) {
  constexpr int kTrials = 60;
  const std::size_t patches = view.patches.size();
  const auto lies_on = [](const Eigen::Vector3d& plane, const WallPatch& patch) {
    return std::abs(plane.dot(patch.Ray()) / patch.inverse_depth - 1.0) < kMaxOffWall;
  };
  const std::uint64_t stream = NoiseStream(patches, 0, 0);
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  std::ptrdiff_t most = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    Eigen::Matrix3d rays;
    Eigen::Vector3d inverse_depths;
    for (std::uint64_t k = 0; k < 3; ++k) {
      const double random = UniformNoise(stream, 3 * trial + k);
      const auto any = static_cast<std::size_t>(random * static_cast<double>(patches));
      const WallPatch& patch = view.patches[std::min(patches - 1, any)];
      rays.row(static_cast<Eigen::Index>(k)) = patch.Ray().transpose();
      inverse_depths[static_cast<Eigen::Index>(k)] = patch.inverse_depth;
    }
    const Eigen::Vector3d plane = rays.colPivHouseholderQr().solve(inverse_depths);
    const auto on = std::count_if(view.patches.begin(), view.patches.end(),
                                  [&](const WallPatch& patch) { return lies_on(plane, patch); });
    if (on > most) std::tie(most, best) = std::pair(on, plane);
  }
  std::erase_if(view.patches, [&](const WallPatch& patch) { return !lies_on(best, patch); });
  return static_cast<double>(view.patches.size()) >
         (1.0 - kMaxOutside) * static_cast<double>(patches);
}

}  // namespace

std::optional<WallView> SeeWall(const CameraModel& depth_camera, double time_s,
                                const Image<float>& depth_m) {
  WallView view{time_s, {}};
  const int longer = std::max(depth_camera.width, depth_camera.height);
  const int side = std::max(kMinPatch_px, longer / kMaxPatchesAcross);
  int places = 0;
  for (int top = 0; top + side <= depth_camera.height; top += side)
    for (int left = 0; left + side <= depth_camera.width; left += side, ++places)
      if (const auto patch = PatchAt(depth_camera, depth_m, left, top, side))
        view.patches.push_back(*patch);
  const auto fills_the_image = [&] {
    return view.patches.size() >= kMinPatches &&
           static_cast<double>(view.patches.size()) >= kMinImageShare * places;
  };
  if (!fills_the_image() || !KeepWall(view) || !fills_the_image()) return std::nullopt;
  return view;
}

double Biweight(double residual, double cut) {
  const double t = residual / cut;
  return std::abs(t) < 1.0 ? std::pow(1.0 - t * t, 2) : 0.0;
}

WallFit FitWall(const WallView& view, std::span<const double> inverse_depths, double cut) {
  WallFit fit;
  fit.off.assign(view.patches.size(), 0.0);
  for (int round = 0; round < kFitRounds; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const double width = round == 0 ? 1.0 : cut;  // At first nothing is known to be off.
    for (std::size_t i = 0; i < view.patches.size(); ++i) {
      const Eigen::Vector3d ray = view.patches[i].Ray();
      const double weight = view.patches[i].weight * Biweight(fit.off[i], width);
      information += weight * ray * ray.transpose();
      sum += weight * inverse_depths[i] * ray;
    }
    fit.plane = information.ldlt().solve(sum);
    for (std::size_t i = 0; i < view.patches.size(); ++i)
      fit.off[i] = fit.plane.dot(view.patches[i].Ray()) / inverse_depths[i] - 1.0;
  }
  return fit;
}

}  // namespace isotherm
