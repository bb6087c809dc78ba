#include "ground/service/reconstruction_loop.h"

#include <utility>

#include "common/base/log.h"
#include "common/doubts/doubts.h"
#include "common/messages/backlog.h"
#include "ground/service/status_reporter.h"

namespace isotherm {
namespace {

/// The results of a model (model.iso, cloud and mesh) take about this much per block of 512 voxels.
/// Only the reserve on the disk depends on it (RecordingLoop keeps half as much again).
constexpr std::uint64_t kResultBytesPerBlock = 6'000;
/// Images, trajectory, statistics.
constexpr std::uint64_t kMinResultBytes = 4U << 20;

}  // namespace

void ReconstructionLoop::Run(SessionQueue& queue, const std::stop_token& stop) {
  stop_ = stop;
  while (std::optional<SessionItem> item = Next(queue, stop)) {
    progress_.Busy(clock_.SteadyNow());
    // At a stop the frames that still wait are left out, counted; marks are handled, so that the
    // scan's end is.
    if (stop.stop_requested() && IsFrame(*item)) {
      ++unprocessed_;
    } else {
      std::visit([this](const auto& value) { Handle(value); }, *item);
    }
    progress_.Idle();
  }
  End();
  progress_.Idle();
}

std::optional<SessionItem> ReconstructionLoop::Next(SessionQueue& queue,
                                                    const std::stop_token& stop) {
  constexpr Nanoseconds kIdle = std::chrono::milliseconds(100);
  constexpr int kMaxItemsBetweenSteps = 16;
  while (rebuild_ && !stop.stop_requested()) {
    std::optional<SessionItem> item = queue.PopFor(Nanoseconds(0), stop);
    // What has come goes first: it takes no time. But it must not take all of that.
    if (!item || ++items_since_step_ >= kMaxItemsBetweenSteps) {
      items_since_step_ = 0;
      StepRebuild();
    }
    if (item) return item;
  }
  if (console_ == nullptr) return queue.Pop(stop);
  for (;;) {
    // Somebody may begin to look at a scan that rests.
    std::optional<SessionItem> item = queue.PopFor(kIdle, stop);
    if (item || (stop.stop_requested() && queue.size() == 0)) return item;
    if (scan_ && scan_->has_more_to_show()) scan_->WhileIdle();
  }
}

void ReconstructionLoop::Handle(const SessionStart& start) {
  End();
  start_ = start;
  started_ = true;
  if (start.is_complete) {
    LOG(Ground, Info) << "the scan that the rig still has is complete already, folder="
                      << start.folder.string();
    return BeginRebuild();
  }
  LogCameras(start.rig);
  if (console_ != nullptr)
    console_->BeginScan(start.rig, start.folder.filename().string(), start.folder.string());
  Result<std::unique_ptr<LiveScan>> scan = LiveScan::Create(clock_, options_, start.rig, console_);
  if (!scan) {
    LOG(Ground, Error) << "session " << start.rig.session
                       << " is recorded only: " << scan.error().message();
    status_ = scan.error();
    return;
  }
  scan_ = std::move(*scan);
  LOG(Ground, Info) << "scan started, session=" << start.rig.session
                    << " results=" << start.folder.string();
  for (const std::string& doubt : DoubtsAbout(start.rig.rig)) LOG(Ground, Warning) << doubt;
  BeginRebuild();
  if (const Status& thermal = scan_->model().thermal_status; !thermal.ok()) {
    LOG(Ground, Warning) << thermal.message();
  }
}

void ReconstructionLoop::Handle(const RigDescription& rig) {
  start_.rig = rig;
  LogCameras(rig);  // Frames carry their scale themselves, and the calibration is as it was.
}

void ReconstructionLoop::Handle(const SessionCounters& counters) {
  LOG(Ground, Info) << "scan ended, session=" << counters.session;
  End();
}

void ReconstructionLoop::Handle(const SessionClock& clock) {
  if (!scan_ || clock.session != start_.rig.session) return;
  // A replay as fast as the ground takes it has the times of another day.
  if (!start_.rig.waits_for_ground) scan_->SetClock(clock);
  // It comes with the rig's status.
  const std::optional<EdgeStatus> edge = board_.edge.Get();
  scan_->SetLinkNarrow(edge && LeftForLater(*edge) > 0);
}

void ReconstructionLoop::BeginRebuild() {
  if (start_.earlier_files.empty()) return;
  progress_.Idle();
  reading_.Busy(clock_.SteadyNow());
  rebuild_.emplace(start_, clock_, subscriber_, scan_.get());
  if (!rebuild_->Begin()) rebuild_.reset();
  // An edge that waits for the ground waits for this, too.
  while (rebuild_ && start_.rig.waits_for_ground && !stop_.stop_requested()) StepRebuild();
  reading_.Idle();
  progress_.Busy(clock_.SteadyNow());
}

void ReconstructionLoop::StepRebuild() {
  // Not progress_: a disk may take longer than a frame.
  reading_.Busy(clock_.SteadyNow());
  const bool goes_on = rebuild_->Step();
  board_.rebuilt_fraction.Set(rebuild_->fraction());
  if (!goes_on) {
    rebuild_.reset();
    board_.rebuilt_fraction.Take();
  }
  reading_.Idle();
}

void ReconstructionLoop::Handle(const ExternalOdometrySample& sample) {
  if (!scan_) return;
  if (rebuild_) return rebuild_->CountLeftOut(sample);
  scan_->Add(sample);
}

template <typename Frame>
void ReconstructionLoop::HandleFrame(const Frame& frame) {
  if (!scan_) return;
  if (rebuild_) {
    // Its place is behind what is recorded; the results that are made in the end have it.
    rebuild_->CountLeftOut();
    return;
  }
  scan_->Add(frame);
  const std::optional<Feedback> feedback = scan_->TakeFeedback();
  if (!feedback) return;
  SendFeedback(*feedback);
  EstimateResults();
  // Behind the message: the operator gets what is known now, the next view may come a message
  // later.
  scan_->ThinkAhead();
}

void ReconstructionLoop::EstimateResults() {
  // The results of ended scans need their room until they are written.
  if (board_.scans_being_written == 0) ended_result_bytes_ = 0;
  const auto blocks = static_cast<std::uint64_t>(scan_->model().tsdf().block_count());
  result_bytes_ = kMinResultBytes + kResultBytesPerBlock * blocks;
  board_.result_bytes = ended_result_bytes_ + result_bytes_;
}

void ReconstructionLoop::SendFeedback(const Feedback& feedback) {
  const BehindCounts behind = scan_->behind();
  board_.feedback.Set(feedback);
  if (console_ != nullptr) console_->Add(feedback);
  board_.behind.Set(behind);
  Feedback sent = feedback;
  sent.frames_left_out = static_cast<std::uint32_t>(behind.thermal_frames);
  const std::optional<EdgeStatus> edge = board_.edge.Get();
  if (edge && subscriber_.stats().edge_present) sent.link = LinkText(*edge);
  if (const Status status = subscriber_.Publish(sent); !status.ok()) {
    LOG(Ground, Debug) << "feedback not sent: " << status.message();
  }
  recording_.Offer(std::move(sent), {}, stop_);
}

void ReconstructionLoop::Handle(const ReceivedDepth& frame) { HandleFrame(frame); }

void ReconstructionLoop::Handle(const ReceivedThermal& frame) { HandleFrame(frame); }

void ReconstructionLoop::End() {
  if (!std::exchange(started_, false)) return;
  board_.feedback.Take();
  board_.behind.Take();
  board_.rebuilt_fraction.Take();
  rebuild_.reset();
  ended_result_bytes_ += std::exchange(result_bytes_, 0);
  if (scan_) scan_->LeaveConsole();
  progress_.Idle();  // Enqueue may wait for the results of other scans.
  results_.Enqueue({std::move(start_), std::move(scan_), std::exchange(unprocessed_, 0)}, stop_);
  progress_.Busy(clock_.SteadyNow());
}

}  // namespace isotherm
