#include "ground/distributor.h"

#include <memory>

#include "common/base/log.h"
#include "ground/export/results.h"
#include "ground/live_scan.h"

namespace isotherm {
namespace {

std::uint64_t SessionOf(const Item& item) {
  if (const auto* depth = std::get_if<ReceivedDepth>(&item)) return depth->frame->header.session;
  if (const auto* thermal = std::get_if<ReceivedThermal>(&item))
    return thermal->frame->header.session;
  if (const auto* sample = std::get_if<OutsidePoseSample>(&item)) return sample->session;
  return 0;
}

}  // namespace

void Distributor::OnRig(const RigDescription& rig) {
  if (rig.session == session_) return;
  SessionStart start;
  start.rig = rig;
  start.folder = SessionFolder(options_, single_scan_, rig.session, clock_.Now());
  if (const Status prepared = PrepareOutputDir(start.folder); !prepared.ok()) {
    LOG(Ground, Error) << "this scan will have no results: " << prepared.message();
  }
  start.recording_promise = std::make_shared<std::promise<RecordingOutcome>>();
  start.recording = start.recording_promise->get_future().share();
  session_ = rig.session;
  Send(start);
  std::deque<Item> early = std::exchange(early_, {});
  for (Item& item : early) {
    if (SessionOf(item) == session_) Send(std::move(item));
  }
}

void Distributor::OnFrame(Item item) {
  if (SessionOf(item) == session_) {
    Send(std::move(item));
    return;
  }
  constexpr std::size_t kMaxEarly = 128;
  if (early_.size() == kMaxEarly) {
    early_.pop_front();
    if (const auto left_out = early_limiter_.Admit(clock_.SteadyNow())) {
      LOG(Ground, Warning)
          << "frames arrive but no rig description: is the edge of another version?"
          << LeftOutText(*left_out);
    }
  }
  early_.push_back(std::move(item));
}

void Distributor::OnSessionEnd(const SessionAccount& account) {
  if (account.session == session_) Send(account);
}

void Distributor::Send(Item item) {
  if (auto* depth = std::get_if<ReceivedDepth>(&item)) depth->queued = clock_.Now();
  if (auto* thermal = std::get_if<ReceivedThermal>(&item)) thermal->queued = clock_.Now();
  recording_.Push(item, {});
  reconstruction_.Push(std::move(item), stop_);
}

}  // namespace isotherm
