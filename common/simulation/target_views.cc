#include "common/simulation/target_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/base/check.h"
#include "common/base/noise.h"
#include "common/base/units.h"
#include "common/geometry/rectified_camera.h"

namespace isotherm {
namespace {

bool SeesAllHoles(const TargetObserver& observer, const PerforatedBoard& board,
                  const RigidTransform& T_rig_board, double border_px) {
  constexpr int kRimPoints = 16;
  const CameraModel& camera = observer.camera;
  const RigidTransform T_camera_board = observer.T_camera_rig * T_rig_board;
  for (int hole = 0; hole < board.holes(); ++hole) {
    for (int i = 0; i < kRimPoints; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kRimPoints;
      const Eigen::Vector2d xy =
          board.HoleCentre(hole) +
          0.5 * board.diameters_m[0] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Eigen::Vector3d p = T_camera_board * Eigen::Vector3d(xy.x(), xy.y(), board.FaceZ(xy));
      if (!(p.z() > 0.0)) return false;
      const auto pixel = ProjectIntoImage(camera, p.head<2>() / p.z());
      if (!pixel || pixel->x() < border_px || pixel->y() < border_px ||
          pixel->x() > camera.width - 1 - border_px || pixel->y() > camera.height - 1 - border_px)
        return false;
    }
  }
  return true;
}

/// One pose at random; most do not show all holes.
RigidTransform DrawPose(const PerforatedBoard& board, const TargetObserver& first,
                        const TargetViewOptions& options, std::uint64_t stream) {
  const auto uniform = [&](std::uint64_t i, double low, double high) {
    return std::lerp(low, high, UniformNoise(stream, i));
  };
  const double distance_m = uniform(0, options.min_distance_m, options.max_distance_m);
  const Eigen::Vector2d pixel(uniform(1, 0.0, first.camera.width),
                              uniform(2, 0.0, first.camera.height));
  const double tilt = kRadPerDeg * options.max_tilt_deg * std::sqrt(uniform(3, 0.0, 1.0));
  const double about = uniform(4, 0.0, 2.0 * std::numbers::pi);
  const double roll = uniform(5, -std::numbers::pi, std::numbers::pi);
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(about), std::sin(about), 0.0)) *
      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector2d half = board.HalfSize();
  const Eigen::Vector3d middle = distance_m * Unproject(first.camera, pixel).homogeneous();
  const Eigen::Vector3d origin = middle - rotation * Eigen::Vector3d(half.x(), half.y(), 0.0);
  return first.T_camera_rig.inverse() * MakeTransform(origin, rotation);
}

}  // namespace

std::vector<RigidTransform> SampleTargetViews(const PerforatedBoard& board,
                                              std::span<const TargetObserver> observers, int count,
                                              const TargetViewOptions& options,
                                              std::uint64_t seed) {
  constexpr std::uint64_t kPurpose = 0x76696577, kMaxDraws = 1'000'000;
  CHECK(!observers.empty());
  std::vector<RigidTransform> poses;
  for (std::uint64_t draw = 0; static_cast<int>(poses.size()) < count; ++draw) {
    CHECK(draw < kMaxDraws);  // The board does not fit into the images at these distances.
    const RigidTransform pose =
        DrawPose(board, observers.front(), options, NoiseStream(seed, kPurpose, draw));
    const bool complete =
        std::all_of(observers.begin(), observers.end(), [&](const TargetObserver& observer) {
          return SeesAllHoles(observer, board, pose, options.border_px);
        });
    if (complete) poses.push_back(pose);
  }
  return poses;
}

}  // namespace isotherm
