#include "ground/reconstruction_loop.h"

#include <chrono>
#include <cstdio>

#include "common/base/log.h"
#include "ground/link_account.h"
#include "ground/scan_result.h"
#include "ground/status_teller.h"

namespace isotherm {

using namespace std::chrono_literals;

void ReconstructionLoop::Run(ItemQueue& queue, const std::stop_token& stop) {
  stop_ = stop;
  while (std::optional<Item> item = queue.Pop(stop)) {
    if (stop.stop_requested() && IsFrame(*item)) {
      ++unprocessed_;
      continue;
    }
    std::visit([this](const auto& value) { Handle(value); }, *item);
  }
  End(subscriber_.stats().account);
}

void ReconstructionLoop::Handle(const SessionStart& start) {
  End(last_account_);
  start_ = start;
  TellAboutCameras(start.rig);
  Result<std::unique_ptr<LiveScan>> scan = LiveScan::Create(clock_, options_, start.rig);
  if (!scan) {
    LOG(Ground, Error) << "session " << start.rig.session
                       << " is recorded only: " << scan.error().message();
    status_ = scan.error();
    return;
  }
  scan_ = std::move(*scan);
  LOG(Ground, Info) << "scan started, session=" << start.rig.session
                    << " results=" << start.folder.string();
  if (const Status& thermal = scan_->pipeline().thermal_status(); !thermal.ok()) {
    LOG(Ground, Warning) << thermal.message();
  }
}

void ReconstructionLoop::Handle(const SessionAccount& account) {
  last_account_ = account;
  End(account);
  if (mode_.single_scan) signal_.Request();
}

void ReconstructionLoop::Handle(const OutsidePoseSample& sample) {
  if (scan_) scan_->Add(sample);
}

template <typename Frame>
void ReconstructionLoop::HandleFrame(const Frame& frame) {
  if (!scan_) return;
  scan_->Add(frame);
  ++processed_;
  const std::optional<Feedback> feedback = scan_->TakeFeedback();
  if (!feedback) return;
  if (const Status status = subscriber_.Publish(*feedback); !status.ok()) {
    LOG(Ground, Debug) << "feedback not sent: " << status.message();
  }
  recording_.Push(*feedback, stop_);
  scan_->ThinkAhead();
}

void ReconstructionLoop::Handle(const ReceivedDepth& frame) { HandleFrame(frame); }

void ReconstructionLoop::Handle(const ReceivedThermal& frame) { HandleFrame(frame); }

Json ReconstructionLoop::DescribeEnd(const SessionAccount& account,
                                     const RecordingOutcome& recording) const {
  Json stats = DescribeScan(scan_->pipeline(), options_, scan_->rig());
  Json& link = stats["link"];
  link["session"] = account.session;
  link["closed"] = account.closed;
  link["not_processed_at_stop"] = unprocessed_;
  link["waiting"] = DescribeStage(scan_->waiting());
  link["out_of_order_frames"] = scan_->out_of_order();
  if (scan_->outside_poses_received() > 0) {
    link["outside_poses"]["received"] = scan_->outside_poses_received();
    link["outside_poses"]["missing"] = scan_->outside_poses_missing();
  }
  DescribeAccount(account, recording.stats, link);
  stats["feedback"] = scan_->DescribeFeedback();
  return stats;
}

void ReconstructionLoop::End(const SessionAccount& account) {
  if (!scan_) return;
  scan_->FinishFrames();
  const DelayReport delay = scan_->CheckDelay();
  RecordingOutcome recording;
  if (start_.recording.wait_for(1s) == std::future_status::ready)
    recording = start_.recording.get();
  const Result<std::string> text = WriteScan(
      scan_->pipeline(), options_, delay, DescribeEnd(account, recording), start_.folder, nullptr);
  scan_.reset();
  if (!text) {
    status_ = text.error();
    LOG(Ground, Error) << status_.message();
    return;
  }
  const std::string summary = *text + AccountText(account, recording.stats);
  std::fputs(summary.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace isotherm
