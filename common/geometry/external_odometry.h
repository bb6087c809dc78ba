#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "common/time/time_types.h"

namespace isotherm {

/// Holds where something else says the rig is: visual-inertial odometry, a flight controller,
/// motion capture. Untrusted, as it came: numbers may be anything. The reference's coordinate frame
/// is unknown to us, so only the difference between two poses of one source means something.
struct ExternalOdometry {
  /// NaN = the source does not say.
  static constexpr double kUnknownSigma = std::numeric_limits<double>::quiet_NaN();
  /// The source does not measure it: an attitude filter knows no position.
  static constexpr double kNotMeasured = std::numeric_limits<double>::infinity();

  std::string source{};       ///< Name; at most 32 bytes.
  CaptureTime time{};         ///< When the body was there, edge wall clock.
  Nanoseconds time_sigma{0};  ///< One sigma of `time`; 0 = not estimated.
  /// Maps body to reference coordinates. The body is the depth camera unless
  /// ExternalOdometryOptions.T_depth_body says otherwise. Metres; the quaternion should be of
  /// length 1.
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  /// One sigma of a single pose against those just before and after it (jitter, not drift).
  double position_sigma_m = kUnknownSigma;
  double rotation_sigma_rad = kUnknownSigma;

  bool has_position() const { return position_sigma_m != kNotMeasured; }
};

}  // namespace isotherm
