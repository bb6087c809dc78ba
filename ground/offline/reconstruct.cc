#include "ground/offline/reconstruct.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/log.h"
#include "common/codec/codec.h"
#include "common/doubts/plausibility_check.h"
#include "common/recording/recording.h"
#include "ground/assembler/assembler.h"
#include "ground/calibration/delay_check.h"
#include "ground/calibration/scan_views.h"
#include "ground/export/result_files.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/pipeline/pipeline_counts.h"
#include "ground/results/scan_result.h"

namespace isotherm {
namespace {

/// Fraction of the progress that the frames take; the rest is writing results.
constexpr double kFramesFraction = 0.85;
constexpr double kMergeFraction = 0.05, kDelayFraction = 0.05;

/// In the frames' stamps when they have reached the pipeline; nullopt if that is not known.
std::optional<double> CalibratedDelay(const RecordingInfo& info, const Rig& rig) {
  const std::optional<double> applied_s = AppliedDelay(info);
  if (!applied_s) return std::nullopt;
  return *applied_s + rig.thermal_delay_s;
}

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
        delay_check_(request.options.delay_check(), rig, CalibratedDelay(reader.info(), rig)),
        assembler_(rig.thermal.has_value()) {
    for (const auto& [topic, count] : reader.info().messages_by_topic) total_ += count;
  }

  Status Run() {
    while (true) {
      Result<std::optional<RecordedItem>> item = reader_.Next();
      ++read_;
      if (!item) {
        ++bad_messages_;
        LOG(Reconstruct, Warning) << item.error().message();
        continue;
      }
      if (!*item) break;
      std::visit([this](auto& recorded) { Take(recorded); }, **item);
      while (const auto frame = assembler_.Pop()) Process(*frame);
      Report();
    }
    while (const auto frame = assembler_.Flush()) Process(*frame);
    pipeline_.Finish([this](double fraction) {
      if (request_.progress)
        request_.progress(kFramesFraction + kMergeFraction * fraction, "putting sub-maps together");
    });
    return OkStatus();
  }

  DelayReport CheckDelay() {
    return delay_check_.Finish(pipeline_.model(), pipeline_.pool(), [this](double fraction) {
      if (request_.progress)
        request_.progress(kFramesFraction + kMergeFraction + kDelayFraction * fraction,
                          "checking the delay");
    });
  }

  Doubts FindDoubts() const { return plausibility_.Find(); }

  std::uint64_t bad_messages() const { return bad_messages_; }
  std::uint64_t undecodable() const { return undecodable_; }
  std::uint64_t out_of_order() const { return assembler_.refused_late(); }

 private:
  void Take(RecordedDepth& recorded) {
    auto frame = std::make_shared<DepthFrame>();
    frame->header = recorded.frame.header;
    // A calibration from elsewhere may be given because the recorded scale is wrong.
    frame->depth_scale = request_.rig ? request_.rig->depth_scale : recorded.frame.depth_scale;
    const bool look = plausibility_.AddDepth(frame->header.capture_time);
    if (!Unpack(Decode(recorded.frame.image), "depth", frame->header, frame->depth_raw)) return;
    if (look) plausibility_.LookAtDepth(frame->depth_raw, frame->depth_scale);
    assembler_.Add(std::move(frame));
  }

  void Take(RecordedThermal& recorded) {
    auto frame = std::make_shared<ThermalFrame>();
    const EncodedThermalFrame& encoded = recorded.frame;
    frame->header = encoded.header;
    const bool look = plausibility_.AddThermal(frame->header.capture_time);
    frame->header.capture_time += thermal_delay_;
    frame->nuc_state = encoded.nuc_state;
    frame->nuc_source = encoded.nuc_source;
    frame->seconds_since_nuc = encoded.seconds_since_nuc;
    frame->housekeeping = encoded.housekeeping;
    frame->valid = encoded.valid && encoded.image.encoding != Encoding::kCounts16;
    frame->scale = encoded.scale;
    if (!Unpack(DecodeTemperatures(encoded.image), "thermal", frame->header,
                frame->temperature_raw))
      return;
    if (look && !frame->temperature_raw.empty())
      plausibility_.LookAtThermal(frame->temperature_raw, frame->scale);
    assembler_.Add(std::move(frame));
  }

  void Take(const ClockStep& /*step*/) {}  // Capture times do not follow the wall clock.
  void Take(const NucEvent& /*event*/) {}  // Each frame carries its NUC state.
  void Take(const RecordedPose& /*pose*/) {}
  void Take(const RecordedLog& /*log*/) {}
  void Take(const ExternalOdometry& pose) { pipeline_.ProcessExternalOdometry(pose); }

  bool Unpack(Result<Image<std::uint16_t>> decoded, const char* stream, const FrameHeader& header,
              Image<std::uint16_t>& image) {
    if (decoded) {
      image = std::move(*decoded);
      return true;
    }
    ++undecodable_;
    LOG(Reconstruct, Warning) << stream << " frame " << header.frame_number
                              << " left out: " << decoded.error().message();
    return false;
  }

  void Process(const Assembler::Frame& frame) {
    if (const auto* depth = std::get_if<DepthFramePtr>(&frame)) {
      pipeline_.ProcessDepth(**depth);
    } else {
      const ThermalFramePtr& thermal = std::get<ThermalFramePtr>(frame);
      pipeline_.ProcessThermal(thermal);
      delay_check_.Add(thermal, pipeline_.model());
    }
  }

  void Report() const {
    if (!request_.progress || total_ == 0) return;
    const double fraction = std::min(1.0, static_cast<double>(read_) / static_cast<double>(total_));
    request_.progress(kFramesFraction * fraction, "reconstructing");
  }

  const ReconstructRequest& request_;
  RecordingReader& reader_;
  const Nanoseconds thermal_delay_;
  GroundPipeline& pipeline_;
  PlausibilityCheck plausibility_;
  DelayCheck delay_check_;
  Assembler assembler_;
  std::uint64_t total_ = 0;
  std::uint64_t read_ = 0;
  std::uint64_t bad_messages_ = 0;
  std::uint64_t undecodable_ = 0;
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

}  // namespace

Result<ReconstructSummary> Reconstruct(const ReconstructRequest& request) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(request.recording);
  if (!reader) return Err(reader.error());
  const RecordingInfo& info = (*reader)->info();
  if (Status status = CheckHasDepth(info, request.recording); !status.ok()) return Err(status);
  const Result<Rig> rig = FindRig(request, **reader);
  if (!rig) return Err(rig.error());
  GroundOptions options = request.options;
  std::unique_ptr<ModelFile> model;
  if (!request.model.empty()) {
    Result<std::unique_ptr<ModelFile>> opened = ModelFile::Open(request.model);
    if (!opened) return Err(opened.error());
    model = std::move(*opened);
    if (Status status = model->AdoptVolume(options); !status.ok()) return Err(status);
  }
  Result<std::unique_ptr<GroundPipeline>> pipeline =
      GroundPipeline::Create(options, *rig, request.initial_pose);
  if (!pipeline) return Err(pipeline.error());
  if (model) {
    if (Status status = (*pipeline)->Continue(*model); !status.ok()) return Err(status);
  }
  if (Status status = PrepareOutputDir(request.output_dir); !status.ok()) return Err(status);

  if (info.bytes_ignored > 0) {
    LOG(Reconstruct, Warning) << request.recording.string()
                              << ": damaged or unfinished parts are left out, bytes="
                              << info.bytes_ignored;
  }
  const auto start = std::chrono::steady_clock::now();
  InlineDriver driver(request, **reader, *rig, **pipeline);
  if (Status status = driver.Run(); !status.ok()) return Err(status);
  const DelayReport delay = driver.CheckDelay();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  Json stats = DescribeScan((*pipeline)->model(), options);
  stats["source"] = DescribeSource(request, info, driver);
  stats["elapsed_s"] = elapsed.count();
  const auto progress = [&](std::string_view what, double fraction) {
    constexpr double kBefore = kFramesFraction + kMergeFraction + kDelayFraction;
    if (request.progress) request.progress(kBefore + (1.0 - kBefore) * fraction, what);
  };
  Result<WrittenScan> written =
      WriteScan((*pipeline)->model(), options, delay, driver.FindDoubts(), std::move(stats),
                request.output_dir, (*pipeline)->pool(), progress);
  if (!written) return Err(written.error());
  const PipelineCounts& counts = (*pipeline)->model().counts;
  return ReconstructSummary{
      counts.depth_in,      counts.depth_repeated,    counts.depth_tracked,      counts.thermal_in,
      counts.thermal_fused, std::move(written->text), std::move(written->doubts)};
}

}  // namespace isotherm
