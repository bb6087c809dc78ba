#include "ground/live_scan.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <numbers>
#include <utility>

#include "common/base/log.h"

namespace isotherm {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// Depth frames per second for the speed that advice is about, if the rig does not say.
constexpr double kNominalDepthHz = 30.0;

std::optional<Advice> ToWire(AdviceKind kind) {
  switch (kind) {
    case AdviceKind::kNone:
      return std::nullopt;
    case AdviceKind::kDone:
      return Advice::kDone;
    case AdviceKind::kCloser:
      return Advice::kMoveCloser;
    case AdviceKind::kFarther:
      return Advice::kMoveFarther;
    case AdviceKind::kLessOblique:
      return Advice::kLessOblique;
    case AdviceKind::kSlower:
      return Advice::kSlower;
    case AdviceKind::kHoldForNuc:
      return Advice::kHoldForNuc;
    case AdviceKind::kGoBack:
      return Advice::kGoBackToRelocalise;
  }
  return std::nullopt;
}

}  // namespace

std::filesystem::path SessionFolder(const GroundOptions& options, bool single_scan,
                                    std::uint64_t session, CaptureTime start) {
  const std::filesystem::path base(options.live().output_dir());
  if (single_scan) return base;
  const std::time_t seconds = ToNanoseconds(start) / 1'000'000'000;
  return base / fmt::format("scan-{:%Y%m%dT%H%M%SZ}-{:08x}", fmt::gmtime(seconds),
                            static_cast<std::uint32_t>(session));
}

Result<std::unique_ptr<LiveScan>> LiveScan::Create(const Clock& clock, const GroundOptions& options,
                                                   const RigDescription& rig) {
  Result<std::unique_ptr<GroundPipeline>> pipeline =
      GroundPipeline::Create(options, rig.rig, std::nullopt);
  if (!pipeline) return Err(pipeline.error());
  return std::unique_ptr<LiveScan>(new LiveScan(clock, options, rig, std::move(*pipeline)));
}

LiveScan::LiveScan(const Clock& clock, const GroundOptions& options, const RigDescription& rig,
                   std::unique_ptr<GroundPipeline> pipeline)
    : clock_(clock),
      options_(options),
      session_(rig.session),
      rig_(rig.rig),
      keeps_up_(options.live().max_wait_s() > 0.0 && !rig.waits_for_ground),
      pipeline_(std::move(pipeline)),
      assembler_(rig.rig.thermal.has_value()) {}

void LiveScan::Add(const ReceivedDepth& depth) {
  if (keeps_up_) KeepUp(clock_.Now() - depth.queued);
  arrivals_[depth.frame.get()] = depth.arrival;
  assembler_.Add(depth.frame);
  while (const auto frame = assembler_.Pop()) Process(*frame);
}

void LiveScan::Add(const ReceivedThermal& thermal) {
  const NucState state = thermal.frame->nuc_state;
  nuc_running_ = state == NucState::kInProgress || state == NucState::kSettling;
  arrivals_[thermal.frame.get()] = thermal.arrival;
  assembler_.Add(thermal.frame);
  while (const auto frame = assembler_.Pop()) Process(*frame);
}

void LiveScan::FinishFrames() {
  while (const auto frame = assembler_.Flush()) Process(*frame);
  pipeline_->Finish();
}

void LiveScan::NoteTurn(const void* frame) {
  const auto arrival = arrivals_.extract(frame);
  constexpr double kMsPerNs = 1e-6;
  if (arrival) {
    waiting_.Add(kMsPerNs * static_cast<double>((clock_.Now() - arrival.mapped()).count()));
  }
  // Frames that the assembler refused never have a turn.
  constexpr std::size_t kMostHeld = 1024;
  if (arrivals_.size() > kMostHeld) arrivals_.clear();
}

void LiveScan::KeepUp(Nanoseconds queued) {
  // The rest is for the other stream's next frame.
  constexpr double kThermalShare = 0.4;
  constexpr double kIntegrationShare = 0.7;
  const double share = ToSeconds(queued) / options_.live().max_wait_s();
  pipeline_->set_effort(share > kIntegrationShare ? Effort::kEverySecond
                        : share > kThermalShare   ? Effort::kNoThermal
                                                  : Effort::kAll);
  if (share <= kIntegrationShare || told_behind_) return;
  told_behind_ = true;
  LOG(Ground, Warning) << fmt::format(
      "a frame waited {:.0f} ms for its turn: work is left out to keep up (frames left out as "
      "\"behind\" in stats.json; the recording has all)",
      1e3 * ToSeconds(queued));
}

void LiveScan::Process(const Assembler::Frame& frame) {
  if (const auto* thermal = std::get_if<ThermalFramePtr>(&frame)) {
    NoteTurn(thermal->get());
    pipeline_->ProcessThermal(*thermal);
    return;
  }
  const DepthFrame& depth = *std::get<DepthFramePtr>(frame);
  NoteTurn(&depth);
  const DepthReport report = pipeline_->ProcessDepth(depth);
  if (report.repeated) return;  // Says nothing new.
  newest_report_ = report;
  newest_header_ = depth.header;
  const CaptureTime time = depth.header.capture_time;
  if (!next_feedback_ || time >= *next_feedback_) {
    feedback_waiting_ = true;
    next_feedback_ = time + FromSeconds(1.0 / options_.live().feedback_hz());
  }
}

std::optional<Feedback> LiveScan::TakeFeedback() {
  if (!feedback_waiting_) return std::nullopt;
  feedback_waiting_ = false;
  return MakeFeedback();
}

Feedback LiveScan::MakeFeedback() {
  Feedback feedback;
  feedback.session = session_;
  feedback.frame_number = newest_header_.frame_number;
  feedback.capture_time = newest_header_.capture_time;
  const TrackingResult& tracking = newest_report_->tracking;
  feedback.tracking_state = !newest_report_->tracked                   ? TrackingState::kLost
                            : tracking.verdict() == Verdict::kDegraded ? TrackingState::kDegraded
                                                                       : TrackingState::kTracked;
  if (newest_report_->tracked) {
    feedback.T_world_depth = pipeline_->ToWorld(tracking.T_world_depth);
    feedback.pose_covariance = pipeline_->uncertainty().covariance();
  }

  const ModelView& model = pipeline_->view();
  CoverageSummary coverage;
  if (model.maps.width() > 0) {
    SampleView(model.maps, model.T_world_depth.translation(), pipeline_->tsdf(),
               pipeline_->thermal(), pipeline_->pool(), view_);
    coverage = SummarizeCoverage(view_, options_.thermal());
  }
  feedback.view = {static_cast<float>(coverage.good), static_cast<float>(coverage.acceptable),
                   static_cast<float>(coverage.bad), static_cast<float>(coverage.never_measured)};
  ScanSituation situation;
  situation.tracking_lost = !newest_report_->tracked;
  situation.nuc_running = nuc_running_;
  situation.speed_m_s = tracking.step_m * kNominalDepthHz;
  situation.turn_rate_deg_s = tracking.step_rad * kDegPerRad * kNominalDepthHz;
  situation.max_speed_m_s = options_.tsdf().max_step_m() * kNominalDepthHz;
  situation.max_turn_rate_deg_s = options_.tsdf().max_step_deg() * kNominalDepthHz;
  if (const auto advice = ToWire(AdviseOperator(coverage, situation, options_.thermal()).advice)) {
    feedback.advice.push_back(*advice);
  }
  return feedback;
}

}  // namespace isotherm
