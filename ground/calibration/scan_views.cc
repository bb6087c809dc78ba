#include "ground/calibration/scan_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "common/base/log.h"
#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "ground/calibration/image_motion.h"
#include "ground/calibration/part_of_progress.h"
#include "ground/calibration/point_visibility.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/pipeline/scan_model.h"

namespace isotherm {
namespace {

// Images are kept decoded: 1200 of a PI 450 are 264 MB. Of a longer scan every n-th image is taken.
constexpr std::size_t kMaxFrames = 1200;
// As many as the fine search compares (FindDelayOptions::fine_points). Not tuned.
constexpr std::size_t kMaxPoints = 30'000;
// Fewer points than this, or images, hardly overlap: the search would fit their noise. Not tuned; a
// minute's scan has a thousand images.
constexpr std::size_t kMinPoints = 500;
constexpr std::size_t kMinFrames = 40;
// The part of the progress that reading and tracking take; the rest is finding out what is visible.
constexpr double kReadFraction = 0.8;
// With more than half of the poses missing, what is left is mostly pauses between losses. Not
// tuned.
constexpr double kMinTracked = 0.5;
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

std::uint64_t Count(const RecordingInfo& info, const std::string& topic) {
  const auto found = info.messages_by_topic.find(topic);
  return found == info.messages_by_topic.end() ? 0 : found->second;
}

Status CheckContents(const RecordingInfo& info, const Rig& rig) {
  if (Count(info, "/depth") == 0)
    return FailedPrecondition("the recording has no depth frames, so its motion is not known");
  if (Count(info, "/thermal") < kMinFrames) {
    return FailedPrecondition(fmt::format("the recording has {} thermal frames, {} are needed",
                                          Count(info, "/thermal"), kMinFrames));
  }
  if (!rig.depth) return FailedPrecondition("the calibration has no depth camera");
  return CheckThermalFusion(rig);
}

/// Depth frames through the pipeline, thermal frames kept.
class Reader {
 public:
  Reader(RecordingReader& reader, GroundPipeline& pipeline, const Rig& rig)
      : reader_(reader),
        pipeline_(pipeline),
        rig_(rig),
        stride_(1 + Count(reader.info(), "/thermal") / kMaxFrames) {}

  void Run(const std::function<void(double)>& progress) {
    std::uint64_t total = 0, read = 0;
    for (const auto& [topic, count] : reader_.info().messages_by_topic) total += count;
    while (true) {
      Result<std::optional<RecordedItem>> item = reader_.Next();
      ++read;
      if (!item) {
        LOG(Calibrate, Warning) << item.error().message();
        continue;
      }
      if (!*item) break;
      if (auto* depth = std::get_if<RecordedDepth>(&**item)) Take(*depth);
      if (auto* thermal = std::get_if<RecordedThermal>(&**item)) Take(*thermal);
      if (progress && total > 0)
        progress(std::min(1.0, static_cast<double>(read) / static_cast<double>(total)));
    }
    pipeline_.Finish();
  }

  std::vector<StampedThermal> TakeFrames() { return std::move(frames_); }

 private:
  void Take(const RecordedDepth& recorded) {
    Result<Image<std::uint16_t>> image = Decode(recorded.frame.image);
    if (!image) return;
    DepthFrame frame;
    frame.header = recorded.frame.header;
    frame.depth_scale = recorded.frame.depth_scale;
    frame.depth_raw = std::move(*image);
    pipeline_.ProcessDepth(frame);
  }

  void Take(const RecordedThermal& recorded) {
    if (!recorded.frame.valid || seen_++ % stride_ != 0) return;
    Result<Image<std::uint16_t>> image = DecodeTemperatures(recorded.frame.image);
    if (!image || image->width() != rig_.thermal->width || image->height() != rig_.thermal->height)
      return;
    frames_.push_back({recorded.frame.header.capture_time,
                       std::make_shared<const Image<std::uint16_t>>(std::move(*image)),
                       recorded.frame.scale,
                       {}});
  }

  RecordingReader& reader_;
  GroundPipeline& pipeline_;
  const Rig& rig_;
  const std::uint64_t stride_;
  std::uint64_t seen_ = 0;
  std::vector<StampedThermal> frames_;
};

Status CheckTracked(const PipelineCounts& counts) {
  const auto tracked = static_cast<double>(counts.depth_tracked + counts.depth_repeated);
  if (tracked >= kMinTracked * static_cast<double>(counts.depth_in)) return OkStatus();
  return FailedPrecondition(
      fmt::format("only {} of {} depth frames could be tracked, so the motion is not known "
                  "(options as for `isotherm reconstruct`: --config, --set)",
                  counts.depth_tracked, counts.depth_in));
}

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

Status AddSurface(const ScanModel& scan, std::size_t max_points, double range_s, ThreadPool& pool,
                  ScanViews& views, const std::function<void(double)>& progress) {
  views.trajectory = scan.trajectory.poses();
  views.pose_drift_m = kDriftPerVoxel * scan.tsdf().grid().voxel_size_m;
  if (views.frames.size() < kMinFrames) {
    return FailedPrecondition(
        fmt::format("{} thermal frames are valid, {} are needed", views.frames.size(), kMinFrames));
  }
  views.points = DrawPoints(scan.tsdf(), views, max_points, pool);
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
  FindVisiblePoints(scan.tsdf(), range_s, pool, views, progress);
  return OkStatus();
}

Result<ScanForCalibration> ReadScan(const std::filesystem::path& recording,
                                    const GroundOptions& options, double range_s,
                                    const std::function<void(double)>& progress) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(recording);
  if (!reader) return Err(reader.error());
  const Result<Rig> rig = (*reader)->ReadRig();
  if (!rig) return Err(rig.error().WithContext(recording.string()));
  if (Status status = CheckContents((*reader)->info(), *rig); !status.ok())
    return Err(status.WithContext(recording.string()));
  Rig depth_only = *rig;
  depth_only.thermal.reset();
  Result<std::unique_ptr<GroundPipeline>> pipeline =
      GroundPipeline::Create(options, depth_only, std::nullopt);
  if (!pipeline) return Err(pipeline.error());

  Reader frames(**reader, **pipeline, *rig);
  frames.Run(PartOf(progress, 0.0, kReadFraction));
  ScanForCalibration scan{{}, *rig, AppliedDelay((*reader)->info())};
  scan.views.thermal_camera = *rig->thermal;
  scan.views.T_thermal_depth = *rig->T_thermal_depth;
  const ScanModel model = (*pipeline)->model();
  scan.views.frames = frames.TakeFrames();
  Status fit = CheckTracked(model.counts);
  if (fit.ok()) {
    fit = AddSurface(model, kMaxPoints, range_s, (*pipeline)->pool(), scan.views,
                     PartOf(progress, kReadFraction, 1.0));
  }
  if (!fit.ok()) return Err(fit.WithContext(recording.string()));
  if (progress) progress(1.0);
  return scan;
}

}  // namespace isotherm
