#include "ground/offline/calibration_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/log.h"
#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "ground/calibration/part_of_progress.h"
#include "ground/calibration/scan_views.h"
#include "ground/offline/recorded_frames.h"
#include "ground/pipeline/ground_pipeline.h"

namespace isotherm {
namespace {

// Images are kept decoded: 1200 of a PI 450 are 264 MB. Of a longer scan every n-th image is taken.
constexpr std::size_t kMaxFrames = 1200;
// As many as the fine search compares (FindDelayOptions::fine_points). Not tuned.
constexpr std::size_t kMaxPoints = 30'000;
// The part of the progress that reading and tracking take; the rest is finding out what is visible.
constexpr double kReadFraction = 0.8;
// With more than half of the poses missing, what is left is mostly pauses between losses. Not
// tuned.
constexpr double kMinTracked = 0.5;

std::uint64_t Count(const RecordingInfo& info, const std::string& topic) {
  const auto found = info.messages_by_topic.find(topic);
  return found == info.messages_by_topic.end() ? 0 : found->second;
}

Status CheckContents(const RecordingInfo& info, const Rig& rig) {
  if (Count(info, "/depth") == 0)
    return FailedPrecondition("the recording has no depth frames, so its motion is not known");
  if (Count(info, "/thermal") < kMinThermalFrames) {
    return FailedPrecondition(fmt::format("the recording has {} thermal frames, {} are needed",
                                          Count(info, "/thermal"), kMinThermalFrames));
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
    const auto take = [this](const RecordedItem& item) {
      if (const auto* depth = std::get_if<RecordedDepth>(&item)) Take(*depth);
      if (const auto* thermal = std::get_if<RecordedThermal>(&item)) Take(*thermal);
    };
    const auto warn = [](const Status& error) { LOG(Calibrate, Warning) << error.message(); };
    ReadItems(reader_, take, warn, progress);
    pipeline_.Finish();
  }

  std::vector<StampedThermal> TakeFrames() { return std::move(frames_); }

 private:
  void Take(const RecordedDepth& recorded) {
    if (const auto frame = Unpack(recorded, std::nullopt)) pipeline_.ProcessDepth(**frame);
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

Status CheckTracked(const ScanCounts& counts) {
  const auto tracked = static_cast<double>(counts.depth_tracked + counts.depth_repeated);
  if (tracked >= kMinTracked * static_cast<double>(counts.depth_in)) return OkStatus();
  return FailedPrecondition(
      fmt::format("only {} of {} depth frames could be tracked, so the motion is not known "
                  "(options as for `isotherm reconstruct`: --config, --set)",
                  counts.depth_tracked, counts.depth_in));
}

}  // namespace

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
    fit = AddSurface(model, kMaxPoints, range_s, scan.views, PartOf(progress, kReadFraction, 1.0));
  }
  if (!fit.ok()) return Err(fit.WithContext(recording.string()));
  if (progress) progress(1.0);
  return scan;
}

}  // namespace isotherm
