#include "ground/service/distributor.h"

#include <memory>
#include <tuple>
#include <utility>

#include "common/base/log.h"
#include "ground/service/scan_board.h"

namespace isotherm {
namespace {

std::uint64_t SessionOf(const SessionItem& item) {
  if (const auto* depth = std::get_if<ReceivedDepth>(&item)) return depth->frame->header.session;
  if (const auto* thermal = std::get_if<ReceivedThermal>(&item))
    return thermal->frame->header.session;
  if (const auto* sample = std::get_if<ExternalOdometrySample>(&item)) return sample->session;
  return 0;
}

}  // namespace

void Distributor::OnRig(const RigDescription& rig) {
  if (over_) return;
  if (rig.session == session_) return OnRigAnew(rig);
  if (session_ && single_scan_) {  // The edge was started anew: the one scan is over.
    over_ = true;
    SessionCounters end;
    end.session = *session_;
    SendMark(end);
    return;
  }
  ScanFolder folder = folders_.Begin(rig.session, clock_.Now());
  start_ = {.rig = rig,
            .folder = std::move(folder.path),
            .earlier_files = std::move(folder.earlier_files),
            .lock = std::move(folder.lock),
            .is_complete = folder.is_complete,
            .recording = std::make_shared<RecordingTracker>()};
  session_ = rig.session;
  recording_behind_ = false;
  board_.recording.Set(start_.recording);
  SendMark(start_);
  // Frames may overtake the description of their rig on the link.
  std::deque<SessionItem> early = std::exchange(early_, {});
  for (SessionItem& item : early) {
    if (SessionOf(item) == session_) Send(std::move(item));
  }
}

void Distributor::OnRigAnew(const RigDescription& rig) {
  const auto cameras = [](const RigDescription& described) {
    return std::tuple(described.depth, described.thermal, described.rig.thermal_scale);
  };
  if (cameras(rig) == cameras(start_.rig)) return;
  start_.rig = rig;
  SendMark(rig);
}

void Distributor::OnItem(SessionItem item) {
  if (over_) return;
  if (SessionOf(item) == session_) {
    Send(std::move(item));
    return;
  }
  // Frames kept until their rig is described: nearly two seconds at 30 and 40 Hz. More: up to some
  // 100 MB of frames that may belong to no rig; fewer: the beginning of a scan is lost when its
  // description comes late. Not tuned.
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

void Distributor::OnClock(const SessionClock& clock) {
  if (over_) return;
  recording_.Offer(clock, {}, stop_);
  Reconstruct(clock);
}

void Distributor::OnMark(const SessionMark& mark) {
  if (mark.session == session_ && !over_ && options_.live().record()) recording_.Push(mark);
}

void Distributor::OnSessionEnd(const SessionCounters& counters) {
  if (counters.session != session_ || over_) return;
  over_ = single_scan_;
  SendMark(counters);
}

void Distributor::Send(SessionItem item) {
  if (auto* depth = std::get_if<ReceivedDepth>(&item)) depth->queued = clock_.Now();
  if (auto* thermal = std::get_if<ReceivedThermal>(&item)) thermal->queued = clock_.Now();
  // Recorded before it may wait for the reconstruction: a slow reconstruction must not cost the
  // recording anything.
  Record(item);
  Reconstruct(std::move(item));
}

void Distributor::SendMark(const SessionItem& mark) {
  // Marks are never left out: without the beginning or end of a session the rest has no place.
  recording_.Push(mark);
  Reconstruct(mark);
}

void Distributor::Reconstruct(SessionItem item) {
  progress_.Idle();  // Whether that goes on is for the reconstruction to say.
  reconstruction_.Push(std::move(item), stop_);
  progress_.Busy(clock_.SteadyNow());
}

void Distributor::Record(const SessionItem& item) {
  if (!options_.live().record()) return;
  if (const auto* depth = std::get_if<ReceivedDepth>(&item)) {
    RecordFrame(*depth, Sensor::kDepth);
  } else if (const auto* thermal = std::get_if<ReceivedThermal>(&item)) {
    RecordFrame(*thermal, Sensor::kThermal);
  } else {
    recording_.Offer(item, {}, stop_);
  }
}

template <typename Frame>
void Distributor::RecordFrame(Frame frame, Sensor sensor) {
  // A live edge does not wait for us, so nothing may hold up reception; a replay does.
  constexpr Nanoseconds kPatience = std::chrono::seconds(1);
  const Nanoseconds patience = start_.rig.waits_for_ground ? kPatience : Nanoseconds(0);
  frame.frame.reset();  // Pixels are for the reconstruction.
  const bool taken = recording_.Offer(std::move(frame), patience, stop_);
  if (!taken) start_.recording->CountLeftOut(sensor, NotRecorded::kDiskTooSlow);
  LogRecording(taken);
}

void Distributor::LogRecording(bool taken) {
  if (taken != recording_behind_) return;
  recording_behind_ = !taken;
  if (recording_behind_) {
    LOG(Ground, Warning) << "the disk does not take the recording fast enough: frames are left out "
                            "of it from here on, counted; the scan itself goes on, folder="
                         << start_.folder.string();
  } else {
    LOG(Ground, Info) << "the disk takes the recording again, frames_left_out="
                      << start_.recording->Get().left_out();
  }
}

}  // namespace isotherm
