#include "ground/camera_calibration/view_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

// What a set of views should have, as the guides to calibration ask: tilts that tell focal length
// from distance, several distances, features near the corners, where a lens bends most. Less: the
// report's uncertainty grows; more: nobody has the patience. Not tuned.
constexpr double kTilted_deg = 20.0;
constexpr double kMinDistanceRatio = 1.3;  ///< Farthest view to nearest.
constexpr double kMinReachFraction = 0.85;
constexpr int kEnoughViews = 30;

constexpr std::array<const char*, 9> kZoneNames = {
    "in the upper left corner", "at the upper border", "in the upper right corner",
    "at the left border",       "in the middle",       "at the right border",
    "in the lower left corner", "at the lower border", "in the lower right corner"};
constexpr std::array<const char*, 4> kTiltNames = {
    "its left side nearer to the camera", "its right side nearer to the camera",
    "its upper side nearer to the camera", "its lower side nearer to the camera"};

}  // namespace

void ViewCoverage::Add(const std::vector<Eigen::Vector2d>& features_px,
                       const RigidTransform& T_camera_board) {
  const Eigen::Vector2d size = size_px_.cast<double>();
  const Eigen::Vector2d middle = 0.5 * (size - Eigen::Vector2d::Ones());
  for (const Eigen::Vector2d& p : features_px) {
    const int column = static_cast<int>(p.x() / size.x() * kZoneColumns);
    const int row = static_cast<int>(p.y() / size.y() * kZoneRows);
    ++zones_[static_cast<std::size_t>(std::clamp(row, 0, kZoneRows - 1) * kZoneColumns +
                                      std::clamp(column, 0, kZoneColumns - 1))];
    reach_fraction_ = std::max(reach_fraction_, (p - middle).norm() / middle.norm());
  }
  const double distance_m = T_camera_board.translation().norm();
  min_distance_m_ = views_ == 0 ? distance_m : std::min(min_distance_m_, distance_m);
  max_distance_m_ = std::max(max_distance_m_, distance_m);
  ++views_;
  // The normal points away from the camera, and to the side that is nearer.
  const Eigen::Vector3d normal = T_camera_board.linear().col(2);
  const double tilted = std::sin(kTilted_deg * kRadPerDeg);
  if (normal.x() < -tilted) ++tilted_[0];
  if (normal.x() > tilted) ++tilted_[1];
  if (normal.y() < -tilted) ++tilted_[2];
  if (normal.y() > tilted) ++tilted_[3];
}

std::vector<std::string> ViewCoverage::Missing() const {
  std::vector<std::string> missing;
  // Some features of a few views; one touch of a corner says little.
  constexpr int kFewFeatures = 20;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    if (zones_[i] < kFewFeatures)
      missing.push_back(fmt::format("{} views with the target {}",
                                    zones_[i] == 0 ? "no" : "too few", kZoneNames[i]));
  }
  for (std::size_t i = 0; i < tilted_.size(); ++i) {
    if (tilted_[i] < 2)
      missing.push_back(
          fmt::format("{} views with the target tilted by more than {:.0f} degrees, {}",
                      tilted_[i] == 0 ? "no" : "too few", kTilted_deg, kTiltNames[i]));
  }
  if (views_ > 0 && max_distance_m_ < kMinDistanceRatio * min_distance_m_) {
    missing.push_back(fmt::format(
        "all views at about the same distance ({:.2f} to {:.2f} m): take some nearer or farther",
        min_distance_m_, max_distance_m_));
  }
  if (views_ > 0 && reach_fraction_ < kMinReachFraction) {
    missing.push_back(fmt::format(
        "no feature beyond {:.0f} % of the way from the middle to a corner of the image",
        100.0 * reach_fraction_));
  }
  if (views_ < kEnoughViews)
    missing.push_back(fmt::format("{} views of {} that are advised", views_, kEnoughViews));
  return missing;
}

}  // namespace isotherm
