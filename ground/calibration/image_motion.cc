#include "ground/calibration/image_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ground/calibration/texture_consistency.h"

namespace isotherm {
namespace {

// To each side: longer than what the noise of single poses makes, shorter than a person's swing.
constexpr double kHalfBaseline_s = 0.08;
// Nearer points would move by thousands of pixels a second and decide alone.
constexpr double kMinDepth_m = 0.05;
// Less of the squared speed than this is rounding, not a change of it.
constexpr double kMinChange = 1e-9;
// Of the pairs' sum below, a bounded number of terms however long the scan is.
constexpr std::size_t kMaxVelocities = 1200;

/// The velocities less their mean over the part of the motion that they are in.
std::vector<StampedVelocity> WithoutMeans(std::vector<StampedVelocity> motion, double part_s) {
  const auto part_of =
      [&, start = motion.empty() ? CaptureTime() : motion.front().time](const StampedVelocity& at) {
        return std::floor(ToSeconds(at.time - start) / part_s);
      };
  for (auto first = motion.begin(); first != motion.end();) {
    const double part = part_of(*first);
    const auto end = std::find_if(first, motion.end(),
                                  [&](const StampedVelocity& at) { return part_of(at) != part; });
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (auto at = first; at != end; ++at)
      mean += at->velocity_px_s / static_cast<double>(end - first);
    for (; first != end; ++first) first->velocity_px_s -= mean;
  }
  return motion;
}

}  // namespace

Eigen::Vector3d MiddleOfSurface(const ScanViews& views) {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  for (const TexturePoint& point : views.points)
    p_world += point.p_world / static_cast<double>(views.points.size());
  return p_world;
}

std::vector<StampedVelocity> ImageVelocities(const ScanViews& views) {
  const Eigen::Vector3d p_world = MiddleOfSurface(views);
  const auto pixel_at = [&](CaptureTime time) -> std::optional<Eigen::Vector2d> {
    const auto T_world_depth = InterpolatePose(views.trajectory, time);
    if (!T_world_depth) return std::nullopt;
    const Eigen::Vector3d p_thermal = views.T_thermal_depth * (T_world_depth->inverse() * p_world);
    if (p_thermal.z() < kMinDepth_m) return std::nullopt;
    return views.thermal_camera.fx * p_thermal.head<2>() / p_thermal.z();
  };
  const std::size_t stride = 1 + views.frames.size() / kMaxVelocities;
  std::vector<StampedVelocity> motion;
  for (std::size_t i = 0; i < views.frames.size(); i += stride) {
    const CaptureTime time = views.frames[i].time;
    const auto before = pixel_at(time - FromSeconds(kHalfBaseline_s));
    const auto after = pixel_at(time + FromSeconds(kHalfBaseline_s));
    if (before && after) motion.push_back({time, (*after - *before) / (2.0 * kHalfBaseline_s)});
  }
  return motion;
}

double RmsSpeed(const std::vector<StampedVelocity>& motion) {
  double squares = 0.0;
  for (const StampedVelocity& at : motion) squares += at.velocity_px_s.squaredNorm();
  return motion.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(motion.size()));
}

std::optional<double> PixelsPerMetre(const ScanViews& views) {
  const Eigen::Vector3d p_world = MiddleOfSurface(views);
  double depth_m = 0.0;
  int count = 0;
  for (const StampedPose& pose : views.trajectory) {
    const double z_m = (views.T_thermal_depth * (pose.T_world_depth.inverse() * p_world)).z();
    if (z_m < kMinDepth_m) continue;
    depth_m += z_m;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return views.thermal_camera.fx * count / depth_m;
}

double DelaySigmaOfDrift(const std::vector<StampedVelocity>& motion, double drift_px,
                         double part_s) {
  // Least squares: delay = sum(drift . change) / sum(change . change), where change is the velocity
  // without its mean. Its variance sums the drift's covariance over all pairs of times.
  const std::vector<StampedVelocity> changes = WithoutMeans(motion, part_s);
  double squares = 0.0, all_squares = 0.0, variance = 0.0;
  for (const StampedVelocity& at : motion) all_squares += at.velocity_px_s.squaredNorm();
  for (const StampedVelocity& a : changes) {
    squares += a.velocity_px_s.squaredNorm();
    for (const StampedVelocity& b : changes) {
      const double correlation = std::exp(-std::abs(ToSeconds(a.time - b.time)) / kDriftMemory_s);
      variance += correlation * a.velocity_px_s.dot(b.velocity_px_s);
    }
  }
  if (!(squares > kMinChange * all_squares)) return std::numeric_limits<double>::infinity();
  return drift_px * std::sqrt(std::max(0.0, variance)) / squares;
}

}  // namespace isotherm
