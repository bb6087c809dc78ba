#include "ground/playback/player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/log.h"
#include "ground/offline/recorded_frames.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr double kMinSpeed = 0.25, kMaxSpeed = 8.0;

}  // namespace

Result<std::unique_ptr<Player>> Player::Open(const Clock& clock, const GroundOptions& options,
                                             const std::filesystem::path& recording,
                                             ConsoleFeed& feed) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(recording);
  if (!reader) return Err(reader.error());
  const RecordingInfo& info = (*reader)->info();
  const auto depth = info.messages_by_topic.find("/depth");
  if (depth == info.messages_by_topic.end() || !info.start || !info.end) {
    return Err(FailedPrecondition(recording.string() +
                                  ": there are no depth frames, so no surface can be shown"));
  }
  Result<Rig> rig = (*reader)->ReadRig();
  if (!rig) return Err(rig.error().WithContext(recording.string()));
  std::unique_ptr<Player> player(
      new Player(clock, options, recording, feed, std::move(*reader), std::move(*rig)));
  if (Status begun = player->Restart(); !begun.ok()) return Err(std::move(begun));
  return player;
}

Player::Player(const Clock& clock, const GroundOptions& options,
               const std::filesystem::path& recording, ConsoleFeed& feed,
               std::unique_ptr<RecordingReader> reader, Rig rig)
    : clock_(clock),
      options_(options),
      recording_(recording),
      feed_(feed),
      reader_(std::move(reader)),
      rig_(std::move(rig)),
      start_(*reader_->info().start),
      duration_s_(ToSeconds(*reader_->info().end - start_)),
      base_time_(clock.SteadyNow()) {
  const MutexLock lock(mutex_);
  state_.set_duration_s(duration_s_);
  state_.set_speed(1.0);
  state_.set_playing(true);
}

void Player::Control(const live::PlaybackControl& control) {
  const MutexLock lock(mutex_);
  wanted_.MergeFrom(control);
  is_wanted_ = true;
}

live::Playback Player::state() const {
  const MutexLock lock(mutex_);
  return state_;
}

Status Player::Restart() {
  if (Status status = reader_->Seek(start_); !status.ok()) return status;
  RigDescription rig;
  rig.rig = rig_;
  rig.waits_for_ground = true;
  feed_.BeginScan(rig, recording_.filename().string(), recording_.parent_path().string());
  Result<std::unique_ptr<LiveScan>> scan = LiveScan::Create(clock_, options_, rig, &feed_);
  if (!scan) return scan.error();
  scan_ = std::move(*scan);
  next_.reset();
  is_at_end_ = false;
  position_s_ = 0.0;
  Rebase();
  return OkStatus();
}

void Player::Rebase() {
  base_position_s_ = position_s_;
  base_time_ = clock_.SteadyNow();
}

SteadyTime Player::DueTime(double position_s) const {
  const double speed = state().speed();
  return base_time_ + FromSeconds((position_s - base_position_s_) / speed);
}

void Player::TakeControl() {
  live::PlaybackControl control;
  {
    const MutexLock lock(mutex_);
    if (!std::exchange(is_wanted_, false)) return;
    control.Swap(&wanted_);
    wanted_.Clear();
    if (control.has_speed() && std::isfinite(control.speed()))
      state_.set_speed(std::clamp(control.speed(), kMinSpeed, kMaxSpeed));
    if (control.has_playing()) state_.set_playing(control.playing());
  }
  if (control.has_position_s() && std::isfinite(control.position_s())) {
    const double target_s = std::clamp(control.position_s(), 0.0, duration_s_);
    if (target_s < position_s_ || is_at_end_) {
      if (const Status status = Restart(); !status.ok()) {
        LOG(Console, Error) << status.message();
      }
    }
    seek_to_s_ = target_s;
  }
  Rebase();
}

bool Player::ReadNext() {
  while (!next_ && !is_at_end_) {
    Result<std::optional<RecordedItem>> item = reader_->Next();
    if (!item) continue;  // Told when it was recorded, or by `isotherm inspect`.
    if (!*item) {
      is_at_end_ = true;
      break;
    }
    const auto* depth = std::get_if<RecordedDepth>(&**item);
    const auto* thermal = std::get_if<RecordedThermal>(&**item);
    if (depth == nullptr && thermal == nullptr) continue;
    next_s_ = PositionOf(depth != nullptr ? depth->frame.header.capture_time
                                          : thermal->frame.header.capture_time);
    next_ = std::move(**item);
  }
  return next_.has_value();
}

Nanoseconds Player::Step() {
  TakeControl();
  const bool has_next = ReadNext();
  const bool plays = state().playing();
  if (seek_to_s_ && (!has_next || next_s_ >= *seek_to_s_)) {
    position_s_ = has_next ? *seek_to_s_ : duration_s_;
    seek_to_s_.reset();
    Rebase();
  }
  Nanoseconds wait = 100ms;
  if (has_next && (seek_to_s_ || plays)) {
    const Nanoseconds early = DueTime(next_s_) - clock_.SteadyNow();
    if (!seek_to_s_ && early > 0ns) {
      wait = std::min(wait, early);
    } else {
      position_s_ = next_s_;
      const RecordedItem item = std::move(*next_);
      next_.reset();
      Play(item);
      wait = 0ns;
    }
  }
  if (wait > 0ns && scan_->has_more_to_show()) scan_->WhileIdle();
  const MutexLock lock(mutex_);
  if (!has_next) state_.set_playing(false);
  state_.set_position_s(position_s_);
  state_.set_seeking(seek_to_s_.has_value());
  return wait;
}

void Player::Play(const RecordedItem& item) {
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) {
    Play(*depth);
  } else if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
    Play(*thermal);
  }
  GiveFeedback();
}

void Player::Play(const RecordedDepth& recorded) {
  Result<DepthFramePtr> frame = Unpack(recorded, std::nullopt);
  if (!frame) return;
  const CaptureTime now = clock_.Now();
  scan_->Add(
      ReceivedDepth{.frame = std::move(*frame), .encoded = nullptr, .arrival = now, .queued = now});
}

void Player::Play(const RecordedThermal& recorded) {
  Result<ThermalFramePtr> frame = Unpack(recorded, Nanoseconds(0));
  if (!frame) return;
  const CaptureTime now = clock_.Now();
  scan_->Add(ReceivedThermal{
      .frame = std::move(*frame), .encoded = nullptr, .arrival = now, .queued = now});
}

void Player::GiveFeedback() {
  const std::optional<Feedback> feedback = scan_->TakeFeedback();
  if (!feedback) return;
  feed_.Add(*feedback);
  scan_->ThinkAhead();
}

}  // namespace isotherm
