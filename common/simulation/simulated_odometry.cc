#include "common/simulation/simulated_odometry.h"

#include <cmath>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "common/geometry/rigid_transform.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kPurpose = 40;  ///< Keeps the noise apart from that of the cameras.

/// Where the reference frame lies is of no importance: anywhere.
RigidTransform ReferenceFromWorld() {
  return MakeTransform({12.0, -5.0, 3.0}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                              2.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized())));
}

Eigen::Vector3d Jitter(double sigma, std::uint64_t stream, std::uint64_t counter) {
  Eigen::Vector3d jitter;
  for (int axis = 0; axis < 3; ++axis)
    jitter[axis] = sigma * double{NormalNoise(stream, counter + static_cast<std::uint64_t>(axis))};
  return jitter;
}

}  // namespace

std::vector<ExternalOdometry> SimulateOdometry(const OdometryOptions& options,
                                               const SimulatedScan& scan, std::uint64_t seed) {
  std::vector<ExternalOdometry> poses;
  if (options.rate_hz() <= 0.0 || scan.depth_times().empty()) return poses;
  const double rotation_sigma_rad = options.rotation_sigma_deg() * kRadPerDeg;
  const CaptureTime first = scan.depth_times().front().exposure;
  const CaptureTime last = scan.depth_times().back().exposure;
  const RigidTransform T_world_first = scan.PoseAt(first);
  for (std::uint64_t i = 0;; ++i) {
    ExternalOdometry pose;
    pose.source = "odometry";
    pose.time = first + FromSeconds(static_cast<double>(i) / options.rate_hz());
    if (pose.time > last) return poses;
    RigidTransform motion = T_world_first.inverse() * scan.PoseAt(pose.time);
    // Relative to the first pose: a wrong scale, as of monocular odometry, makes an error that
    // grows with the way.
    motion.translation() *= 1.0 + options.scale_error();
    const RigidTransform seen = ReferenceFromWorld() * T_world_first * motion;
    const std::uint64_t stream = NoiseStream(seed, kPurpose, i);
    pose.translation_m = seen.translation() + Jitter(options.position_sigma_m(), stream, 0);
    const Eigen::Vector3d rotation = Jitter(rotation_sigma_rad, stream, 3);
    pose.rotation =
        Eigen::Quaterniond(seen.linear()) *
        Eigen::Quaterniond(
            TransformFromTwist(
                (Eigen::Matrix<double, 6, 1>() << Eigen::Vector3d::Zero(), rotation).finished())
                .linear());
    pose.position_sigma_m = options.position_sigma_m();
    pose.rotation_sigma_rad = rotation_sigma_rad;
    if (options.attitude_only()) {
      pose.translation_m.setZero();
      pose.position_sigma_m = ExternalOdometry::kNotMeasured;
    }
    poses.push_back(pose);
  }
}

}  // namespace isotherm
