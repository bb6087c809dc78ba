#include "ground/service/live_scan.h"

#include <fmt/format.h>

#include <deque>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/base/units.h"
#include "ground/results/scan_result.h"

namespace isotherm {

Result<std::unique_ptr<LiveScan>> LiveScan::Create(const Clock& clock, const GroundOptions& options,
                                                   const RigDescription& rig, ConsoleFeed* feed) {
  Result<std::unique_ptr<GroundPipeline>> pipeline =
      GroundPipeline::Create(options, rig.rig, std::nullopt);
  if (!pipeline) return Err(pipeline.error());
  return std::unique_ptr<LiveScan>(new LiveScan(clock, options, rig, std::move(*pipeline), feed));
}

LiveScan::LiveScan(const Clock& clock, const GroundOptions& options, const RigDescription& rig,
                   std::unique_ptr<GroundPipeline> pipeline, ConsoleFeed* feed)
    : clock_(clock),
      options_(options),
      session_(rig.session),
      rig_(rig.rig),
      keeps_up_(options.live().expert().max_wait_s() > 0.0 && !rig.waits_for_ground),
      pipeline_(std::move(pipeline)),
      feed_(feed),
      assembler_(rig.rig.thermal.has_value()),
      calibration_check_(options.calibration_check(), rig.rig, std::nullopt),
      feedback_(options, rig),
      pace_(options.live().expert().feedback_hz()),
      shown_scan_(feed == nullptr ? 0 : feed->scan()) {}

void LiveScan::Add(const ReceivedDepth& depth) {
  if (keeps_up_) KeepUp(depth.queued);
  arrival_ages_.Add(Sensor::kDepth, depth.frame->header.capture_time, depth.arrival);
  arrivals_[depth.frame.get()] = depth.arrival;
  assembler_.Add(depth.frame);
  while (const auto frame = assembler_.Pop()) Process(*frame);
}

void LiveScan::Add(const ReceivedThermal& thermal) {
  const NucState state = thermal.frame->nuc_state;
  // Said by thermal frames as they come, not when they are processed: the operator is to hold still
  // now.
  pace_.set_nuc_running(state == NucState::kImminent || state == NucState::kInProgress ||
                        state == NucState::kSettling);
  arrival_ages_.Add(Sensor::kThermal, thermal.frame->header.capture_time, thermal.arrival);
  arrivals_[thermal.frame.get()] = thermal.arrival;
  assembler_.Add(thermal.frame);
  while (const auto frame = assembler_.Pop()) Process(*frame);
}

void LiveScan::Add(const ExternalOdometrySample& sample) {
  ++odometry_poses_received_;
  next_odometry_pose_ = std::max(next_odometry_pose_, sample.number + 1);
  pipeline_->ProcessExternalOdometry(sample.pose);
}

void LiveScan::AddRecorded(const DepthFramePtr& depth) {
  assembler_.Add(depth);
  ProcessRecorded();
}

void LiveScan::AddRecorded(const ThermalFramePtr& thermal) {
  assembler_.Add(thermal);
  ProcessRecorded();
}

void LiveScan::ProcessRecorded() {
  is_recorded_ = true;
  while (const auto frame = assembler_.Pop()) Process(*frame);
  is_recorded_ = false;
}

void LiveScan::WhileIdle() {
  if (feed_ != nullptr) feed_->WhileIdle(model());
}

void LiveScan::LeaveConsole() {
  if (feed_ != nullptr) console_cost_ = feed_->cost();
  feed_ = nullptr;
}

void LiveScan::FinishFrames(const std::function<void(double fraction)>& progress) {
  while (const auto frame = assembler_.Flush()) Process(*frame);
  pipeline_->Finish(progress);
  processor_after_ = ReadProcessorTimes();
}

ProcessorTimes LiveScan::processor_times() const {
  return (processor_after_ ? *processor_after_ : ReadProcessorTimes()) - processor_before_;
}

BehindCounts LiveScan::behind() const {
  const ScanCounts& counts = model().counts;
  return {.now = is_behind_,
          .thermal_frames = counts.thermal_left_out[LeftOutReason::kBehind],
          .depth_frames = counts.depth_behind};
}

CalibrationCheckReport LiveScan::CheckCalibration(const std::function<void()>& progress,
                                                  const std::stop_token& stop) {
  CHECK(processor_after_.has_value());
  // A check of several seconds (docs/calibration.md) says once that it is at work; a shorter one
  // says nothing.
  constexpr Nanoseconds kSilence = std::chrono::seconds(2);
  const SteadyTime start = clock_.SteadyNow();
  bool told = false;
  const auto say = [&](double fraction) {
    if (progress) progress();
    if (told || clock_.SteadyNow() - start < kSilence) return;
    told = true;
    LOG(Ground, Info) << fmt::format(
        "checking the calibration of the thermal camera, {:.0f} % done", 100.0 * fraction);
  };
  return calibration_check_.Finish(model(), say, stop);
}

void LiveScan::NoteQueueTime(const void* frame) {
  const auto arrival = arrivals_.extract(frame);
  constexpr double kMsPerNs = 1e-6;
  if (arrival) {
    waiting_.Add(kMsPerNs * static_cast<double>((clock_.Now() - arrival.mapped()).count()));
  }
  // Frames that the assembler refused never have a turn, so their entries would stay. It holds at
  // most 96 frames, so beyond this many nearly all are such.
  constexpr std::size_t kMaxHeld = 1024;
  if (arrivals_.size() > kMaxHeld) arrivals_.clear();
}

void LiveScan::KeepUp(CaptureTime queued_at) {
  const Nanoseconds queued = clock_.Now() - queued_at;
  // Fractions of live.expert.max_wait_s. What the model misses least goes first: every second
  // thermal frame, then all but ten per second, then every second integration; depth frames are
  // always tracked. These are well below 1 because `queued` is not the whole wait: the assembler
  // holds a frame until the next one of the other stream has come. In a slow hour with 0.45 and 0.7
  // alone all 600 depth frames were tracked and 185 of 800 thermal ones fused
  // (docs/performance.md). Smaller: work is left out that could have been done; larger: frames wait
  // beyond max_wait_s before anything gives way. Not tuned.
  constexpr double kHalfThermalFraction = 0.35;
  constexpr double kSparseThermalFraction = 0.45;
  constexpr double kIntegrationFraction = 0.7;
  // Where that is not enough, as beside a program that takes half a core of two slow ones, a
  // standing queue would remain. Not tuned.
  constexpr double kQueueFraction = 1.5;
  const double fraction = ToSeconds(queued) / options_.live().expert().max_wait_s();
  is_behind_ = fraction > kHalfThermalFraction;
  const LoadShedding level = fraction > kQueueFraction           ? LoadShedding::kEveryFourth
                             : fraction > kIntegrationFraction   ? LoadShedding::kEverySecond
                             : fraction > kSparseThermalFraction ? LoadShedding::kSparseThermal
                             : fraction > kHalfThermalFraction   ? LoadShedding::kHalfThermal
                                                                 : LoadShedding::kNone;
  pipeline_->set_load_shedding(level);
  load_shedding_.Add(clock_.SteadyNow() - steady_begun_, level);
  if (fraction <= kIntegrationFraction || reported_behind_ || queued_at < begun_) return;
  reported_behind_ = true;
  LOG(Ground, Warning) << fmt::format(
      "a frame waited {:.0f} ms for its turn: work is left out to keep up (frames left out as "
      "\"behind\" in stats.json; the recording has all)",
      1e3 * ToSeconds(queued));
}

void LiveScan::Process(const Assembler::Frame& frame) {
  if (const auto* thermal = std::get_if<ThermalFramePtr>(&frame)) {
    NoteQueueTime(thermal->get());
    if (feed_ != nullptr && !is_recorded_) feed_->Show(*thermal);
    pipeline_->ProcessThermal(*thermal);
    calibration_check_.Add(*thermal, model());
    return;
  }
  const DepthFramePtr& shared = std::get<DepthFramePtr>(frame);
  const DepthFrame& depth = *shared;
  NoteQueueTime(&depth);
  const DepthReport report = pipeline_->ProcessDepth(depth);
  pace_.Add(depth.header, report);
  if (feed_ == nullptr) return;
  // The model is shown as it grows; images are of now.
  if (!is_recorded_) feed_->Show(shared);
  feed_->AfterDepth(depth.header, report, model());
}

std::optional<Feedback> LiveScan::TakeFeedback() {
  std::optional<FeedbackMoment> moment = pace_.Take();
  if (!moment) return std::nullopt;
  const SteadyTime start = clock_.SteadyNow();
  moment->ground_is_behind = is_behind_;
  moment->link_is_narrow = link_is_narrow_;
  Feedback feedback = feedback_.Make(*moment, model());
  making_.Add(kMsPerS * ToSeconds(clock_.SteadyNow() - start));
  LogWhenDone();
  return feedback;
}

void LiveScan::LogWhenDone() {
  if (feedback_.done() == reported_done_) return;
  reported_done_ = feedback_.done();
  const SurfaceAreas areas = feedback_.areas();
  LOG(Ground, Info) << fmt::format(
      "{}: {:.1f} % of {:.3f} m2 of surface are measured well, {:.1f} % are asked for "
      "(feedback.done_fraction)",
      reported_done_ ? "the scan is done" : "the scan is not done any more: there is more surface",
      100.0 * areas.good_m2 / areas.total_m2(), areas.total_m2(),
      100.0 * options_.feedback().done_fraction());
}

void LiveScan::ThinkAhead() {
  // Looking for the next view costs milliseconds that frames are waiting for.
  if (is_behind_) return;
  const SteadyTime start = clock_.SteadyNow();
  feedback_.ThinkAhead(model());
  thinking_.Add(kMsPerS * ToSeconds(clock_.SteadyNow() - start));
}

Json LiveScan::DescribeConsole() const {
  if (!console_cost_) return nullptr;
  Json json = DescribeStage(console_cost_->copying);
  json["copied_blocks"] = console_cost_->copied_blocks;
  json["largest_number_of_viewers"] = console_cost_->max_viewers;
  return json;
}

Json LiveScan::DescribeLoadShedding() const {
  const std::deque<LoadSheddingHistory::Change> changes = load_shedding_.Changes();
  if (changes.empty()) return nullptr;
  Json json;
  // The wall clock's time relates the changes to what else this computer did.
  json["begun_unix_s"] = ToSeconds(begun_.time_since_epoch());
  json["until_s"] = ToSeconds(load_shedding_.last());
  for (const LoadSheddingHistory::Change& change : changes) {
    Json entry;
    entry["since_s"] = ToSeconds(change.since);
    entry["level"] = ToString(change.level);
    json["changes"].push_back(std::move(entry));
  }
  return json;
}

Json LiveScan::DescribeRebuild() const {
  if (!rebuild_) return nullptr;
  return {{"frames", rebuild_->frames},
          {"left_out_meanwhile", rebuild_->left_out},
          {"elapsed_s", rebuild_->elapsed_s},
          {"finished", rebuild_->is_finished}};
}

Json LiveScan::DescribeFeedback() const {
  const SurfaceAreas areas = feedback_.areas();
  Json json;
  json["messages"] = feedback_.messages();
  json["done"] = feedback_.done();
  json["surface_m2"] = areas.total_m2();
  json["good_m2"] = areas.good_m2;
  json["acceptable_m2"] = areas.acceptable_m2;
  json["bad_m2"] = areas.bad_m2;
  json["never_measured_m2"] = areas.never_m2;
  json["making"] = DescribeStage(making_);
  json["thinking_ahead"] = DescribeStage(thinking_);
  return json;
}

}  // namespace isotherm
