#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/time/time_types.h"

namespace isotherm {

struct ScanViews;

/// How long tracked poses remember what they are off by: the surface that they are tracked against
/// was built by poses that drifted alike, and changes as the rig comes to see other parts of it.
inline constexpr double kDriftMemory_s = 4.0;

/// The mean of the surface's points, metres in the trajectory's world.
Eigen::Vector3d MiddleOfSurface(const ScanViews& views);

/// How the middle of the scanned surface moves through the thermal image at one time.
struct StampedVelocity {
  CaptureTime time;
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
};

/// Returns one for each thermal frame at whose time the rig's motion is known, by time.
std::vector<StampedVelocity> ImageVelocities(const ScanViews& views);

/// Returns the RMS of their lengths, pixels per second; 0 for none.
double RmsSpeed(const std::vector<StampedVelocity>& motion);

/// Returns how many pixels a shift of a metre across the line of sight makes at the surface's
/// middle, by its mean depth; nullopt if no pose has it before the camera.
std::optional<double> PixelsPerMetre(const ScanViews& views);

/// Returns the standard deviation, seconds, of a delay that comes from poses which drift by
/// `drift_px` (one sigma along each axis of the image, forgotten within seconds): what of the drift
/// goes along with the velocity is taken for a delay. A rig that reverses often averages it out,
/// one that goes one way does not: a constant velocity says nothing about a delay. Infinite without
/// a change of it. Images are compared within parts of `part_s` seconds; infinity: within the scan.
double DelaySigmaOfDrift(const std::vector<StampedVelocity>& motion, double drift_px,
                         double part_s);

}  // namespace isotherm
