#include "ground/calibration/scan_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/recording/recording.h"
#include "ground/calibration/image_motion.h"
#include "ground/calibration/point_visibility.h"
#include "ground/scan/scan_model.h"

namespace isotherm {
namespace {

// Fewer points than this, or images (kMinThermalFrames), hardly overlap: the search would fit their
// noise. Not tuned; a minute's scan has a thousand images.
constexpr std::size_t kMinPoints = 500;
// A pose less certain than this does not place a thermal image. Twice what the fusion takes
// (thermal.expert.max_registration_px): translation and rotation, which largely make up for each
// other in the image, are taken apart here.
constexpr double kMaxPoseSigma_px = 2.0;
// The least fraction of poses that must be certain.
constexpr double kMinCertain = 0.25;
// What tracked poses drift by within seconds, along each axis: rendered scans are 0.16 mm off (rms)
// with voxels of 2 mm, and simulated ones of small cameras 0.3 to 0.6 mm with voxels of 4 mm.
constexpr double kDriftPerVoxel = 0.1;
// Slower than this, a millisecond is lost in the noise of all pixels together.
constexpr double kMinMotion_px_s = 4.0;

/// The poses of a scan that place its thermal images well enough to compare them. Where the depth
/// image did not tell the whole motion, as after a gap of its stream, tracked poses may be off by
/// as much as their uncertainty says; thermal frames are not fused there either.
std::vector<StampedPose> CertainPoses(const ScanModel& scan, const CameraModel& thermal_camera) {
  const std::vector<StampedPose>& poses = scan.trajectory.poses();
  const std::vector<PoseSigma>& sigmas = scan.trajectory.sigmas();
  std::vector<StampedPose> certain;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double sigma_px =
        thermal_camera.fx * std::hypot(sigmas[i].translation_m / scan.uncertainty.mean_depth_m(),
                                       sigmas[i].rotation_rad);
    if (sigma_px <= kMaxPoseSigma_px) certain.push_back(poses[i]);
  }
  return certain;
}

}  // namespace

std::optional<double> AppliedDelay(const RecordingInfo& info) {
  const auto value = [&info](const char* name, const char* key) -> const std::string* {
    const auto metadata = info.metadata.find(name);
    if (metadata == info.metadata.end()) return nullptr;
    const auto found = metadata->second.find(key);
    return found == metadata->second.end() ? nullptr : &found->second;
  };
  // Simulated stamps are the true exposures, whatever their metadata says a calibration would find.
  if (info.metadata.contains("simulation")) return 0.0;
  if (const std::string* delay_s = value("timing", "thermal_delay_s"))
    return std::strtod(delay_s->c_str(), nullptr);
  const std::string* program = value("configuration", "program");
  if (program != nullptr && *program == "isotherm-ground") return std::nullopt;
  return 0.0;
}

Status AddSurface(const ScanModel& scan, std::size_t max_points, double range_s, ScanViews& views,
                  const std::function<void(double)>& progress, const std::stop_token& stop) {
  views.trajectory = scan.trajectory.poses();
  views.pose_drift_m = kDriftPerVoxel * scan.tsdf().grid().voxel_size_m;
  if (views.frames.size() < kMinThermalFrames) {
    return FailedPrecondition(fmt::format("{} thermal frames are valid, {} are needed",
                                          views.frames.size(), kMinThermalFrames));
  }
  views.points = DrawPoints(scan.tsdf(), views, max_points, scan.pool);
  if (views.points.size() < kMinPoints) {
    return FailedPrecondition(
        fmt::format("the thermal camera sees {} points of the surface, {} are needed",
                    views.points.size(), kMinPoints));
  }
  const double speed_px_s = RmsSpeed(ImageVelocities(views));
  if (speed_px_s < kMinMotion_px_s) {
    return FailedPrecondition(
        fmt::format("the rig hardly moves: the surface goes through the thermal image at {:.1f} "
                    "pixels a second, {:.0f} are needed; move it back and forth",
                    speed_px_s, kMinMotion_px_s));
  }
  const auto poses = static_cast<double>(views.trajectory.size());
  views.trajectory = CertainPoses(scan, views.thermal_camera);
  if (static_cast<double>(views.trajectory.size()) < kMinCertain * poses) {
    return FailedPrecondition(
        fmt::format("only {} of {:.0f} poses are certain to {:.0f} thermal pixels: scan something "
                    "with more shape",
                    views.trajectory.size(), poses, kMaxPoseSigma_px));
  }
  FindVisiblePoints(scan.tsdf(), range_s, scan.pool, views, progress, stop);
  return OkStatus();
}

}  // namespace isotherm
