#include "ground/offline/reconstruct.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/codec/codec.h"
#include "common/doubts/plausibility_check.h"
#include "common/recording/recording.h"
#include "ground/assembler/assembler.h"
#include "ground/calibration/calibration_check.h"
#include "ground/calibration/scan_views.h"
#include "ground/export/result_files.h"
#include "ground/offline/finishing_pass.h"
#include "ground/offline/held_out_views.h"
#include "ground/offline/recorded_frames.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/results/scan_result.h"
#include "ground/scan/scan_counts.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// Fractions of the progress; the rest is writing results.
constexpr double kFramesFraction = 0.60, kMergeFraction = 0.05, kFinishingFraction = 0.25;
constexpr double kCheckFraction = 0.05;
/// Where both passes end.
constexpr double kPassesFraction = kFramesFraction + kMergeFraction + kFinishingFraction;

/// In the frames' stamps when they have reached the pipeline; nullopt if that is not known.
std::optional<double> CalibratedDelay(const RecordingInfo& info, const Rig& rig) {
  const std::optional<double> applied_s = AppliedDelay(info);
  if (!applied_s) return std::nullopt;
  return *applied_s + rig.thermal_delay_s;
}

/// A calibration from elsewhere may be given because the recorded scale is wrong.
std::optional<double> DepthScale(const ReconstructRequest& request) {
  return request.rig ? std::optional(request.rig->depth_scale) : std::nullopt;
}

Status Stopped() { return Unavailable("told to stop"); }

/// Frames of a recording, decoded and fed through the assembler into the pipeline.
class InlineDriver {
 public:
  InlineDriver(const ReconstructRequest& request, RecordingReader& reader, const Rig& rig,
               GroundPipeline& pipeline)
      : request_(request),
        reader_(reader),
        thermal_delay_(FromSeconds(rig.thermal_delay_s)),
        pipeline_(pipeline),
        plausibility_(rig),
        calibration_check_(request.options.calibration_check(), rig,
                           CalibratedDelay(reader.info(), rig)),
        assembler_(rig.thermal.has_value()) {}

  /// From here on, every so-many-th valid thermal frame is kept from the pipeline.
  void HoldOut(int every) { hold_out_every_ = every; }
  /// Stamps of those that were, in order.
  const std::vector<CaptureTime>& held_out() const { return held_out_; }

  Status Run() {
    const auto take = [this](RecordedItem& item) {
      std::visit([this](auto& recorded) { Take(recorded); }, item);
      // As many as are complete: memory does not grow with the recording.
      while (const auto frame = assembler_.Pop()) Process(*frame);
    };
    const auto fail = [this](const Status& error) {
      ++bad_messages_;
      LOG(Reconstruct, Warning) << error.message();
    };
    ReadItems(
        reader_, take, fail,
        [this](double fraction) {
          if (request_.progress) request_.progress(kFramesFraction * fraction, "reconstructing");
        },
        request_.stop);
    // Frames that wait for a partner: none will come.
    while (const auto frame = assembler_.Flush()) Process(*frame);
    if (request_.stop.stop_requested()) return Stopped();
    pipeline_.Finish([this](double fraction) {
      if (request_.progress)
        request_.progress(kFramesFraction + kMergeFraction * fraction, "putting sub-maps together");
    });
    return FinishTemperatures();
  }

  CalibrationCheckReport CheckCalibration() {
    return calibration_check_.Finish(pipeline_.model(), [this](double fraction) {
      if (request_.progress)
        request_.progress(kPassesFraction + kCheckFraction * fraction, "checking the calibration");
    });
  }

  Doubts FindDoubts() const { return plausibility_.Find(); }

  std::uint64_t bad_messages() const { return bad_messages_; }
  std::uint64_t undecodable() const { return undecodable_depth_ + undecodable_thermal_; }
  std::uint64_t undecodable_thermal() const { return undecodable_thermal_; }
  std::uint64_t out_of_order() const { return assembler_.refused_late(); }

 private:
  void Take(RecordedDepth& recorded) {
    const bool look = plausibility_.AddDepth(recorded.frame.header.capture_time);
    Result<DepthFramePtr> frame = Unpack(recorded, DepthScale(request_));
    if (!frame) {
      LOG(Reconstruct, Warning) << frame.error().message();
      ++undecodable_depth_;
      return;
    }
    if (look) plausibility_.LookAtDepth((*frame)->depth_raw, (*frame)->depth_scale);
    assembler_.Add(std::move(*frame));
  }

  void Take(RecordedThermal& recorded) {
    const bool look = plausibility_.AddThermal(recorded.frame.header.capture_time);
    Result<ThermalFramePtr> frame = Unpack(recorded, thermal_delay_);
    if (!frame) {
      LOG(Reconstruct, Warning) << frame.error().message();
      ++undecodable_thermal_;
      return;
    }
    if (look && !(*frame)->temperature_raw.empty())
      plausibility_.LookAtThermal((*frame)->temperature_raw, (*frame)->scale);
    assembler_.Add(std::move(*frame));
  }

  void Take(const ClockStep& /*step*/) {}  // Capture times do not follow the wall clock.
  void Take(const NucEvent& /*event*/) {}  // Each frame carries its NUC state.
  void Take(const RecordedPose& /*pose*/) {}
  void Take(const RecordedLog& /*log*/) {}
  void Take(const ExternalOdometry& pose) { pipeline_.ProcessExternalOdometry(pose); }

  void Process(const Assembler::Frame& frame) {
    if (const auto* depth = std::get_if<DepthFramePtr>(&frame)) {
      pipeline_.ProcessDepth(**depth);
    } else {
      const ThermalFramePtr& thermal = std::get<ThermalFramePtr>(frame);
      if (IsHeldOut(*thermal)) {
        held_out_.push_back(thermal->header.capture_time);
        return;
      }
      pipeline_.ProcessThermal(thermal);
      // After the frame was fused: the check needs its pose.
      calibration_check_.Add(thermal, pipeline_.model());
    }
  }

  bool IsHeldOut(const ThermalFrame& frame) {
    return hold_out_every_ > 0 && frame.valid && ++valid_thermal_ % hold_out_every_ == 0;
  }

  Status FinishTemperatures() {
    if (!request_.options.thermal().expert().finishing_pass()) return OkStatus();
    const std::unique_ptr<ThermalPass> pass = pipeline_.BeginThermalPass();
    if (pass == nullptr) return OkStatus();
    return FuseOnFinishedSurface(
        {request_.recording, DepthScale(request_), thermal_delay_, held_out_, request_.stop}, *pass,
        [this](double fraction) {
          if (request_.progress)
            request_.progress(kFramesFraction + kMergeFraction + kFinishingFraction * fraction,
                              "assigning temperatures to the finished surface");
        });
  }

  const ReconstructRequest& request_;
  RecordingReader& reader_;
  const Nanoseconds thermal_delay_;
  GroundPipeline& pipeline_;
  PlausibilityCheck plausibility_;
  CalibrationCheck calibration_check_;
  Assembler assembler_;
  int hold_out_every_ = 0;  ///< 0 = none.
  int valid_thermal_ = 0;
  std::vector<CaptureTime> held_out_;
  std::uint64_t bad_messages_ = 0;
  std::uint64_t undecodable_depth_ = 0, undecodable_thermal_ = 0;
};

/// A recording without depth cannot give a surface: say so before any work.
Status CheckHasDepth(const RecordingInfo& info, const std::filesystem::path& path) {
  const auto depth = info.messages_by_topic.find("/depth");
  if (depth != info.messages_by_topic.end() && depth->second > 0) return OkStatus();
  return FailedPrecondition(
      fmt::format("{}: the recording has no depth frames, so there is no surface to reconstruct "
                  "(`isotherm inspect --render` shows thermal frames as images)",
                  path.string()));
}

/// A calibration from elsewhere holds the whole delay of the thermal camera; the recording's stamps
/// may contain it already.
Rig WithoutAppliedDelay(Rig rig, const RecordingInfo& info) {
  const std::optional<double> applied_s = AppliedDelay(info);
  // Not known: recorded by the ground, from stamps that contain it.
  rig.thermal_delay_s = applied_s ? rig.thermal_delay_s - *applied_s : 0.0;
  return rig;
}

/// Returns the calibration to use: the request's, or else the recording's.
Result<Rig> FindRig(const ReconstructRequest& request, RecordingReader& reader) {
  if (request.rig) return WithoutAppliedDelay(*request.rig, reader.info());
  Result<Rig> rig = reader.ReadRig();
  if (rig) return rig;
  return Err(
      Status(rig.error().code(), fmt::format("{}: {}; --rig FILE gives one from elsewhere",
                                             request.recording.string(), rig.error().message())));
}

/// Says what became of the recording's messages, as `source` in stats.json.
Json DescribeSource(const ReconstructRequest& request, const RecordingInfo& info,
                    const InlineDriver& driver) {
  return {{"recording", request.recording.filename().string()},
          {"complete", info.complete},
          {"bytes_ignored", info.bytes_ignored},
          {"bad_messages", driver.bad_messages()},
          {"undecodable_frames", driver.undecodable()},
          {"out_of_order_frames", driver.out_of_order()}};
}

/// A recording that is to be reconstructed, and the pipeline for it.
struct OpenedScan {
  std::unique_ptr<RecordingReader> reader;
  std::unique_ptr<Rig> rig;  ///< As it is used; referred to by others.
  GroundOptions options;
  std::unique_ptr<GroundPipeline> pipeline;
};

Result<OpenedScan> OpenScan(const ReconstructRequest& request) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(request.recording);
  if (!reader) return Err(reader.error());
  const RecordingInfo& info = (*reader)->info();
  if (Status status = CheckHasDepth(info, request.recording); !status.ok()) return Err(status);
  const Result<Rig> rig = FindRig(request, **reader);
  if (!rig) return Err(rig.error());
  OpenedScan scan;
  // On the heap, since others refer to it while this struct is moved.
  scan.rig = std::make_unique<Rig>(*rig);
  scan.options = request.options;
  std::unique_ptr<ModelFile> model;
  if (!request.model.empty()) {
    Result<std::unique_ptr<ModelFile>> opened = ModelFile::Open(request.model);
    if (!opened) return Err(opened.error());
    model = std::move(*opened);
    if (Status status = model->AdoptVolume(scan.options); !status.ok()) return Err(status);
  }
  Result<std::unique_ptr<GroundPipeline>> pipeline =
      GroundPipeline::Create(scan.options, *scan.rig, request.initial_pose);
  if (!pipeline) return Err(pipeline.error());
  scan.pipeline = std::move(*pipeline);
  if (model) {
    if (Status status = scan.pipeline->Continue(*model); !status.ok()) return Err(status);
  }
  if (info.bytes_ignored > 0) {
    LOG(Reconstruct, Warning) << request.recording.string()
                              << ": damaged or unfinished parts are left out, bytes="
                              << info.bytes_ignored;
  }
  scan.reader = std::move(*reader);
  return scan;
}

/// Reads the thermal frames with these stamps from a recording once more, and compares them.
Status CompareHeldOut(const ReconstructRequest& request, const Rig& rig,
                      const std::vector<CaptureTime>& stamps, HeldOutViews& views) {
  const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(request.recording);
  if (!reader) return reader.error();
  std::size_t read = 0;
  NucEpochs epochs;
  while (read < stamps.size()) {
    Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (!item) continue;
    if (!*item) break;
    auto* recorded = std::get_if<RecordedThermal>(&**item);
    if (recorded == nullptr) continue;
    ThermalFrame frame;
    frame.header = recorded->frame.header;
    frame.header.capture_time += FromSeconds(rig.thermal_delay_s);
    frame.seconds_since_nuc = recorded->frame.seconds_since_nuc;
    frame.housekeeping = recorded->frame.housekeeping;
    frame.valid = recorded->frame.valid;
    const NucAge nuc = epochs.Follow(frame);
    if (!frame.valid) continue;
    if (!std::ranges::binary_search(stamps, frame.header.capture_time)) continue;
    Result<Image<std::uint16_t>> image = DecodeTemperatures(recorded->frame.image);
    if (!image) continue;  // Counted when it was not held out.
    frame.temperature_raw = std::move(*image);
    frame.scale = recorded->frame.scale;
    views.Compare(frame, nuc);
    ++read;
    if (request.progress) {
      request.progress(kPassesFraction + (1.0 - kPassesFraction) * static_cast<double>(read) /
                                             static_cast<double>(stamps.size()),
                       "predicting");
    }
  }
  return OkStatus();
}

}  // namespace

Result<ReconstructSummary> Reconstruct(const ReconstructRequest& request) {
  Result<OpenedScan> scan = OpenScan(request);
  if (!scan) return Err(scan.error());
  const RecordingInfo& info = scan->reader->info();
  const GroundOptions& options = scan->options;
  GroundPipeline& pipeline = *scan->pipeline;
  if (Status status = PrepareOutputDir(request.output_dir); !status.ok()) return Err(status);

  const auto start = std::chrono::steady_clock::now();
  const ProcessorTimes before = ReadProcessorTimes();
  InlineDriver driver(request, *scan->reader, *scan->rig, pipeline);
  if (Status status = driver.Run(); !status.ok()) return Err(status);
  if (request.stop.stop_requested()) return Err(Stopped());
  const ProcessorTimes used = ReadProcessorTimes() - before;
  const CalibrationCheckReport calibration = driver.CheckCalibration();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  Json stats = DescribeScan(pipeline.model(), options);
  stats["source"] = DescribeSource(request, info, driver);
  stats["elapsed_s"] = elapsed.count();
  stats["processor"] = DescribeProcessor(used, pipeline.model().trajectory);
  if (request.describe) request.describe(stats);
  const auto progress = [&](std::string_view what, double fraction) {
    constexpr double kBefore = kPassesFraction + kCheckFraction;
    if (request.progress) request.progress(kBefore + (1.0 - kBefore) * fraction, what);
  };
  Result<WrittenScan> written =
      WriteScan(pipeline.model(), options, {calibration, driver.FindDoubts(), stats},
                request.output_dir, progress);
  if (!written) return Err(written.error());
  const ScanCounts& counts = pipeline.model().counts;
  return ReconstructSummary{
      counts.depth_in,      counts.depth_repeated,    counts.depth_tracked,      counts.thermal_in,
      counts.thermal_fused, std::move(written->text), std::move(written->doubts)};
}

Result<HeldOutReport> PredictHeldOutViews(const ReconstructRequest& request, int every,
                                          const std::optional<SmoothSurface>& surface) {
  if (every < 2) {
    return Err(InvalidArgument(
        fmt::format("every K-th thermal frame is held out: K must be at least 2, got {}", every)));
  }
  if (surface) {
    if (Status status = Validate(*surface); !status.ok()) return Err(status);
  }
  Result<OpenedScan> scan = OpenScan(request);
  if (!scan) return Err(scan.error());
  if (Status status = CheckThermalFusion(*scan->rig); !status.ok())
    return Err(status.WithContext(request.recording.string()));
  InlineDriver driver(request, *scan->reader, *scan->rig, *scan->pipeline);
  driver.HoldOut(every);
  if (Status status = driver.Run(); !status.ok()) return Err(status);
  if (driver.held_out().empty()) {
    return Err(FailedPrecondition(
        fmt::format("{}: the recording has fewer than {} valid thermal frames: none is held out",
                    request.recording.string(), every)));
  }
  const HeldOutOptions options{
      .max_gap_s = scan->options.thermal().expert().max_depth_gap_s(),
      .min_weight = static_cast<float>(scan->options.export_().expert().min_weight()),
      .surface = surface,
      .corrections = CorrectionsOf(scan->options.thermal(), scan->rig->thermal_sensor)};
  HeldOutViews views(scan->pipeline->model(), options);
  if (Status status = CompareHeldOut(request, *scan->rig, driver.held_out(), views); !status.ok()) {
    return Err(status);
  }
  HeldOutReport report = views.report();
  report.undecodable = driver.undecodable_thermal();
  if (report.frames > 0) return report;
  return Err(FailedPrecondition(fmt::format(
      "{}: none of the {} thermal frames that were held out can be compared: the rig was not "
      "tracked at {}, and {} have another size than the calibration's",
      request.recording.string(), driver.held_out().size(), report.without_pose,
      report.wrong_size)));
}

}  // namespace isotherm
