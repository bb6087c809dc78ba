#include "ground/service/console_state.h"

#include <cmath>

#include "ground/subscriber/clock_watch.h"

namespace isotherm {
namespace {

const char* ScanStateName(ScanState state) {
  switch (state) {
    case ScanState::kScanning:
      return "scanning";
    case ScanState::kEnded:
      return "ended";
    case ScanState::kIdle:
      break;
  }
  return "idle";
}

live::Stream ToMessage(const StreamStatus& stream) {
  live::Stream message;
  message.set_rate_hz(stream.rate_hz);
  message.set_captured(stream.captured);
  message.set_queue(stream.queue_frames);
  for (const DropCount& drop : stream.dropped) {
    live::Stream::Drop& shown = *message.add_dropped();
    shown.set_reason(drop.reason);
    shown.set_frames(drop.frames);
  }
  return message;
}

live::Nuc ToMessage(const NucReport& nuc) {
  live::Nuc message;
  message.set_state(std::string(ToString(nuc.state)));
  message.set_policy(std::string(ToString(nuc.policy)));
  if (std::isfinite(nuc.seconds_since)) message.set_seconds_since(nuc.seconds_since);
  message.set_reason(nuc.reason);
  message.set_warming_up(nuc.warming_up);
  message.set_storm(nuc.storm);
  if (std::isfinite(nuc.fpa_celsius)) message.set_fpa_celsius(nuc.fpa_celsius);
  if (std::isfinite(nuc.housing_celsius)) message.set_housing_celsius(nuc.housing_celsius);
  return message;
}

void AddCounters(const StreamCounters& counters, live::Stream& stream) {
  stream.set_received(counters.received);
  stream.set_missing(counters.missing);
}

void DescribeEdge(const EdgeStatus& edge, live::State& state) {
  *state.mutable_depth() = ToMessage(edge.depth);
  *state.mutable_thermal() = ToMessage(edge.thermal);
  state.mutable_depth()->set_present(edge.depth.captured > 0);
  state.mutable_thermal()->set_present(edge.thermal.captured > 0);
  *state.mutable_nuc() = ToMessage(edge.nuc);
  state.set_scan_state(ScanStateName(edge.scan_state));
  live::State::Link& link = *state.mutable_link();
  link.set_publish_policy(edge.publish_policy == PublishPolicy::kLive ? "live" : "lossless");
  link.set_backlog_frames(edge.spool_frames);
  link.set_clock_synchronised(edge.clock.synchronised);
  if (std::isfinite(edge.feedback.p50_s)) link.set_feedback_p50_s(edge.feedback.p50_s);
  // 1 stands for a disk that is full.
  if (edge.disk_free_bytes > 0) state.mutable_disk()->set_rig_free_bytes(edge.disk_free_bytes);
}

void DescribeRecording(const RecordingProgress& recording, live::State::Disk& disk) {
  if (recording.free_bytes > 0) disk.set_free_bytes(recording.free_bytes);
  disk.set_text(DiskText(recording));
  disk.set_recording(recording.path.string());
  disk.set_recording_bytes(recording.bytes);
  disk.set_left_out(recording.left_out());
  disk.set_paused(recording.paused);
}

}  // namespace

void DescribeSituation(const GroundSituation& situation, live::State& state) {
  if (situation.edge) DescribeEdge(*situation.edge, state);
  AddCounters(situation.link.counters.depth, *state.mutable_depth());
  AddCounters(situation.link.counters.thermal, *state.mutable_thermal());
  live::State::Link& link = *state.mutable_link();
  link.set_rig_present(situation.link.edge_present);
  link.set_problem(situation.link.rig_problem);
  if (situation.link.counters.clock) link.set_clock(ClockText(*situation.link.counters.clock));
  state.set_moved_calibration(situation.moved_calibration);
  DescribeRecording(situation.recording, *state.mutable_disk());
  live::State::Load& load = *state.mutable_load();
  load.set_behind(situation.behind.now);
  load.set_thermal_left_out(situation.behind.thermal_frames);
  load.set_depth_not_integrated(situation.behind.depth_frames);
  load.set_results_being_written(static_cast<std::uint32_t>(situation.scans_being_written));
  if (situation.problem) {
    load.set_problem(*situation.problem);
  } else if (situation.folder_problem) {
    load.set_problem(*situation.folder_problem);
  } else if (situation.rebuilt_fraction) {
    load.set_problem(RebuildText(*situation.rebuilt_fraction));
  }
}

}  // namespace isotherm
