#include "edge/source/supervised_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {

SupervisedSource::SupervisedSource(std::unique_ptr<FrameSource> source,
                                   const FrameCheckOptions& options, const Clock& clock,
                                   FrameCallback on_frame, FrameCallback on_rejected,
                                   Nanoseconds longest_pause)
    : source_(std::move(source)),
      clock_(clock),
      on_frame_(std::move(on_frame)),
      on_rejected_(std::move(on_rejected)),
      max_bad_in_a_row_(options.expert().max_bad_in_a_row()),
      retry_min_(FromSeconds(options.expert().retry_min_s())),
      retry_max_(FromSeconds(options.expert().retry_max_s())),
      longest_pause_(longest_pause),
      check_(options),
      next_wait_(retry_min_) {}

Status SupervisedSource::Open() {
  ISOTHERM_RETURN_IF_ERROR(OpenAndCheckIdentity());
  const std::optional<Rig> rig = source_->rig();
  if (rig && !sizes_are_calibrated_) check_.Expect(*rig);
  return OkStatus();
}

void SupervisedSource::Expect(const Rig& rig) {
  check_.Expect(rig);
  sizes_are_calibrated_ = true;
  calibrated_serials_ = {rig.depth_serial, rig.thermal_serial};
}

void SupervisedSource::KeepTrying(const Status& reason) {
  // The rig is described before the camera is there: frames of temperatures are promised.
  if (!counts_only_) counts_only_ = false;
  ScheduleReopen(reason);
}

Status SupervisedSource::OpenAndCheckIdentity() {
  ISOTHERM_RETURN_IF_ERROR(source_->Open());
  for (const CameraDescription& camera : source_->cameras()) {
    if (Status same = CheckIdentity(camera); !same.ok()) {
      source_->Close();
      return same;
    }
  }
  for (const CameraDescription& camera : source_->cameras()) {
    // Told only when all cameras passed: an opening that is refused never happened for anybody
    // else.
    if (on_opened_) on_opened_(camera);
  }
  return OkStatus();
}

Status SupervisedSource::CheckSerial(const CameraDescription& camera) const {
  const auto index = static_cast<std::size_t>(camera.sensor);
  const std::string& calibrated = calibrated_serials_[index];
  if (!calibrated.empty() && camera.serial != calibrated) {
    return FailedPrecondition(fmt::format(
        "the camera with serial number \"{}\" is not used: the calibration is of \"{}\"; start "
        "with this camera's calibration (--rig)",
        camera.serial, calibrated));
  }
  const std::string& first = serials_[index];
  if (!first.empty() && camera.serial != first) {
    return FailedPrecondition(
        fmt::format("the camera with serial number \"{}\" is not used: the scan began with \"{}\", "
                    "and a calibration holds for one camera; start again to change it",
                    camera.serial, first));
  }
  return OkStatus();
}

Status SupervisedSource::CheckIdentity(const CameraDescription& camera) {
  ISOTHERM_RETURN_IF_ERROR(CheckSerial(camera));
  serials_[static_cast<std::size_t>(camera.sensor)] = camera.serial;
  if (camera.sensor != Sensor::kThermal) return OkStatus();
  if (counts_only_.value_or(camera.counts_only) != camera.counts_only) {
    return FailedPrecondition(fmt::format(
        "the thermal camera {} is not used: it sends {}, and the scan began with {}; start again "
        "to change it",
        camera.driver, camera.counts_only ? "counts" : "temperatures",
        *counts_only_ ? "counts" : "temperatures"));
  }
  counts_only_ = camera.counts_only;
  check_.KeepCounts(camera.counts_only);
  return OkStatus();
}

void SupervisedSource::ReportState(bool works) {
  if (works_ == works) return;
  works_ = works;
  if (on_works_) on_works_(works);
}

Result<SourceItem> SupervisedSource::Read(std::stop_token stop) {
  if (reopen_at_) return ReopenWhenDue(stop);
  Result<SourceItem> item = source_->Read(stop);
  CountLeftOut();
  if (!item) {
    ScheduleReopen(item.error());
    return NothingYet{};
  }
  if (RawFrame* frame = std::get_if<RawFrame>(&*item)) return Handle(std::move(*frame));
  return item;
}

std::optional<Status> SupervisedSource::Control(const CameraControl& control) {
  const bool restart = std::holds_alternative<RestartCamera>(control);
  if (reopen_at_) {
    return restart ? OkStatus() : Unavailable("the camera does not work; it is being opened again");
  }
  std::optional<Status> done = source_->Control(control);
  // A source that cannot restart its camera alone is restarted as a whole.
  if (!restart || !done || done->ok()) return done;
  ScheduleReopen(Unavailable("its thermal frames are frozen"));
  return OkStatus();
}

void SupervisedSource::Close() {
  source_->Close();
  CountLeftOut();
}

void SupervisedSource::CountLeftOut() {
  const std::array<std::uint64_t, 2> left_out = source_->TakeLeftOut();
  if (idle_) return;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const auto index = static_cast<std::size_t>(sensor);
    left_out_[index] += left_out[index];
    if (left_out[index] > 0 && on_loss_) on_loss_(sensor, Loss::kLeftOut, left_out[index]);
  }
}

void SupervisedSource::CountMissing(Sensor sensor, std::uint64_t number) {
  const auto index = static_cast<std::size_t>(sensor);
  const std::uint64_t expected = std::exchange(expected_numbers_[index], number + 1);
  if (number <= expected) return;
  const std::uint64_t missing = number - expected;
  // A hole in the numbers is either known (left out on the way here) or lost in the camera: each is
  // counted once, by its cause.
  const std::uint64_t explained = std::min(missing, left_out_[index]);
  left_out_[index] -= explained;
  if (missing > explained && on_loss_) on_loss_(sensor, Loss::kInCamera, missing - explained);
}

SourceItem SupervisedSource::Handle(RawFrame frame) {
  std::uint64_t& thrown_away = thrown_away_[static_cast<std::size_t>(frame.sensor)];
  if (idle_) {
    // The camera's numbers go on while nobody wants its frames; the session's begin at 0.
    thrown_away = frame.frame_number + 1;
    expected_numbers_[static_cast<std::size_t>(frame.sensor)] = 0;
    return NothingYet{};
  }
  frame.frame_number -= thrown_away;
  CountMissing(frame.sensor, frame.frame_number);
  on_frame_(frame.sensor);
  int& bad_in_a_row = bad_in_a_row_[static_cast<std::size_t>(frame.sensor)];
  const Status verdict = check_.Process(frame);
  if (verdict.ok()) {
    bad_in_a_row = 0;
    // Only a good frame ends a failure. Opening alone does not: a camera that opens and delivers
    // nothing would be reopened without any pause.
    next_wait_ = retry_min_;
    failure_.clear();
    ReportState(true);
    frame.reopened = std::exchange(is_first_[static_cast<std::size_t>(frame.sensor)], false);
    return frame;
  }
  on_rejected_(frame.sensor);
  // The first of a run says why; the rest is counted.
  if (bad_in_a_row == 0) {
    LOG(Source, Warning) << "dropped: " << verdict.message();
  }
  if (++bad_in_a_row >= max_bad_in_a_row_) {
    ScheduleReopen(verdict.WithContext(fmt::format("{} bad frames in a row", bad_in_a_row)));
  }
  return NothingYet{};
}

void SupervisedSource::ScheduleReopen(const Status& reason) {
  // A camera that is away for an hour says so once.
  if (std::exchange(failure_, reason.message()) != reason.message()) {
    LOG(Source, Error) << name() << ": " << reason.message()
                       << "; opening it again, wait_s=" << ToSeconds(next_wait_)
                       << ", doubling up to " << ToSeconds(retry_max_);
  }
  Close();
  ReportState(false);
  reopen_at_ = clock_.SteadyNow() + next_wait_;
  next_wait_ = std::min(2 * next_wait_, retry_max_);
  // Both cameras start anew: the one that worked was closed as well.
  bad_in_a_row_ = {};
}

SourceItem SupervisedSource::ReopenWhenDue(const std::stop_token& stop) {
  const SteadyTime now = clock_.SteadyNow();
  if (now < *reopen_at_) {
    Pause(stop, std::min(*reopen_at_ - now, longest_pause_));
    return NothingYet{};
  }
  reopen_at_.reset();
  ++reopened_;
  if (const Status opened = OpenAndCheckIdentity(); !opened.ok()) {
    ScheduleReopen(opened);
  } else {
    is_first_ = {true, true};
  }
  return NothingYet{};
}

}  // namespace isotherm
