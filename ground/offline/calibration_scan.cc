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
#include "ground/thermal/nuc_epochs.h"
#include "ground/thermal/reading_corrections.h"

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
  Reader(RecordingReader& reader, GroundPipeline& pipeline, const Rig& rig,
         std::optional<double> depth_scale)
      : reader_(reader),
        pipeline_(pipeline),
        rig_(rig),
        depth_scale_(depth_scale),
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
    if (const auto frame = Unpack(recorded, depth_scale_)) pipeline_.ProcessDepth(**frame);
  }

  void Take(const RecordedThermal& recorded) {
    const NucAge nuc = AgeOf(recorded.frame);
    if (!recorded.frame.valid || seen_++ % stride_ != 0) return;
    Result<Image<std::uint16_t>> image = DecodeTemperatures(recorded.frame.image);
    if (!image || image->width() != rig_.thermal->width || image->height() != rig_.thermal->height)
      return;
    frames_.push_back({recorded.frame.header.capture_time,
                       std::make_shared<const Image<std::uint16_t>>(std::move(*image)),
                       WithoutDrift(recorded.frame.scale, rig_.thermal_sensor.housing_drift, nuc),
                       {},
                       nuc.epoch});
  }

  NucAge AgeOf(const EncodedThermalFrame& encoded) {
    ThermalFrame frame;
    frame.header = encoded.header;
    frame.seconds_since_nuc = encoded.seconds_since_nuc;
    frame.valid = encoded.valid;
    frame.housekeeping = encoded.housekeeping;
    return nuc_epochs_.Follow(frame);
  }

  RecordingReader& reader_;
  GroundPipeline& pipeline_;
  const Rig& rig_;
  const std::optional<double> depth_scale_;  ///< Instead of the frames' own.
  const std::uint64_t stride_;
  std::uint64_t seen_ = 0;
  NucEpochs nuc_epochs_;
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

TrackedRecording::~TrackedRecording() = default;
TrackedRecording::TrackedRecording(TrackedRecording&&) noexcept = default;

ScanModel TrackedRecording::model() const { return pipeline_->model(); }

Result<TrackedRecording> TrackedRecording::Read(const std::filesystem::path& recording,
                                                const std::optional<Rig>& given,
                                                const GroundOptions& options,
                                                const std::function<void(double)>& progress) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(recording);
  if (!reader) return Err(reader.error());
  const Result<Rig> rig = given ? Result<Rig>(*given) : (*reader)->ReadRig();
  if (!rig) return Err(rig.error().WithContext(recording.string()));
  if (Status status = CheckContents((*reader)->info(), *rig); !status.ok())
    return Err(status.WithContext(recording.string()));
  Rig depth_only = *rig;
  depth_only.thermal.reset();
  Result<std::unique_ptr<GroundPipeline>> pipeline =
      GroundPipeline::Create(options, depth_only, std::nullopt);
  if (!pipeline) return Err(pipeline.error());
  const auto depth_scale = given ? std::optional(given->depth_scale) : std::nullopt;
  Reader frames(**reader, **pipeline, *rig, depth_scale);
  frames.Run(progress);
  if (Status fit = CheckTracked((*pipeline)->model().counts); !fit.ok())
    return Err(fit.WithContext(recording.string()));
  TrackedRecording tracked;
  tracked.rig_ = *rig;
  tracked.depth_scale_ = depth_scale;
  tracked.applied_delay_s_ = AppliedDelay((*reader)->info());
  tracked.pipeline_ = std::move(*pipeline);
  tracked.frames_ = frames.TakeFrames();
  return tracked;
}

Result<double> DelayInStamps(std::optional<double> applied_delay_s,
                             const std::optional<Rig>& used) {
  // The ground records what an edge sent, and the edge knows which delay it added: its
  // calibration's.
  if (applied_delay_s) return *applied_delay_s;
  if (used) return used->thermal_delay_s;
  return Err(FailedPrecondition(
      "this recording was made by the ground, which does not know the delay that its stamps "
      "contain: name the calibration file that the edge used (--rig), or take the edge's own "
      "recording"));
}

Result<ScanForCalibration> ReadScan(const std::filesystem::path& recording,
                                    const GroundOptions& options, double range_s,
                                    const std::function<void(double)>& progress) {
  Result<TrackedRecording> tracked = TrackedRecording::Read(recording, std::nullopt, options,
                                                            PartOf(progress, 0.0, kReadFraction));
  if (!tracked) return Err(tracked.error());
  ScanForCalibration scan{{}, tracked->rig(), tracked->applied_delay_s()};
  scan.views.thermal_camera = *scan.rig.thermal;
  scan.views.T_thermal_depth = *scan.rig.T_thermal_depth;
  scan.views.frames = tracked->frames();
  const Status fit = AddSurface(tracked->model(), kMaxPoints, range_s, scan.views,
                                PartOf(progress, kReadFraction, 1.0));
  if (!fit.ok()) return Err(fit.WithContext(recording.string()));
  if (progress) progress(1.0);
  return scan;
}

}  // namespace isotherm
