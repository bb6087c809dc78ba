#include "edge/source/replay_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <variant>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/codec/codec.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// More than any camera needs; what a file says beyond it is not believed.
constexpr double kMaxDelay_s = 10.0;
// Between the last frame of a loop and the first of the next; about one frame period.
constexpr Nanoseconds kLoopGap = std::chrono::milliseconds(33);

/// Seconds under `key` in the recording's metadata "timing"; 0 if absent or no number.
Nanoseconds KnownDelay(const RecordingInfo& info, const std::string& key) {
  const auto timing = info.metadata.find("timing");
  if (timing == info.metadata.end()) return Nanoseconds(0);
  const auto value = timing->second.find(key);
  if (value == timing->second.end()) return Nanoseconds(0);
  double seconds = 0.0;
  const std::string& text = value->second;
  std::from_chars(text.data(), text.data() + text.size(), seconds);
  return std::abs(seconds) < kMaxDelay_s ? FromSeconds(seconds) : Nanoseconds(0);
}

}  // namespace

ReplaySource::ReplaySource(const SourceOptions& options, std::filesystem::path recording,
                           const Clock& clock, Nanoseconds longest_pause)
    : name_("replay of " + recording.string()),
      path_(std::move(recording)),
      clock_(clock),
      rate_(options.rate()),
      loops_(options.loops()),
      rebase_(options.expert().rebase() && options.rate() > 0.0),
      longest_pause_(longest_pause) {}

Status ReplaySource::Open() {
  // Opened again after a failure downstream, it goes on where it was.
  if (reader_) return OkStatus();
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(path_);
  if (!reader) return reader.error();
  reader_ = std::move(*reader);
  known_delay_ = {KnownDelay(reader_->info(), "depth_delay_s"),
                  KnownDelay(reader_->info(), "thermal_delay_s")};
  if (Result<Rig> rig = reader_->ReadRig()) {
    rig_ = std::move(*rig);
  } else if (rig.error().code() != StatusCode::kNotFound) {
    return rig.error();
  }
  return OkStatus();
}

Result<SourceItem> ReplaySource::Read(std::stop_token stop) {
  if (!pending_) {
    Result<std::optional<PlayedItem>> item = NextItem();
    if (!item) return Err(item.error());
    if (!*item) return SourceItem(StartNextLoop() ? SourceItem(NothingYet{}) : EndOfStream{});
    PlaceInTime(**item);
    pending_ = std::move(*item);
  }
  if (rate_ > 0.0) {
    const Nanoseconds early = DueTime(*pending_) - clock_.SteadyNow();
    Pause(stop, std::min(early, longest_pause_));
    if (clock_.SteadyNow() < DueTime(*pending_)) return NothingYet{};
  }
  PlayedItem item = std::move(*pending_);
  pending_.reset();
  return std::visit([](auto& value) { return SourceItem(std::move(value)); }, item);
}

Result<std::optional<ReplaySource::PlayedItem>> ReplaySource::NextItem() {
  while (true) {
    Result<std::optional<RecordedItem>> item = reader_->Next();
    // Damage costs the messages in it, not the rest of the scan.
    if (!item && item.error().code() == StatusCode::kDataLoss) {
      if (unreadable_++ == 0) {
        LOG(Source, Warning) << "skipped: " << item.error().message();
      }
      continue;
    }
    if (!item) return Err(item.error());
    if (!*item) return std::nullopt;
    if (!IsInTime(**item)) {
      if (unreadable_++ == 0) {
        LOG(Source, Warning) << name_ << ": skipped: a time is more than a month from the first";
      }
      continue;
    }
    if (auto* depth = std::get_if<RecordedDepth>(&**item)) return PlayedItem(ToRawFrame(*depth));
    auto* thermal = std::get_if<RecordedThermal>(&**item);
    if (thermal != nullptr && thermal->frame.image.encoding == Encoding::kCounts16) {
      if (counts_left_out_++ == 0) {
        LOG(Source, Warning) << name_
                             << ": thermal frames hold counts, not temperatures, and are "
                                "not played";
      }
      continue;
    }
    if (thermal != nullptr) return PlayedItem(ToRawFrame(*thermal));
    if (auto* pose = std::get_if<ExternalOdometry>(&**item)) return PlayedItem(std::move(*pose));
    if (const auto* nuc = std::get_if<NucEvent>(&**item)) last_nuc_event_ = *nuc;
  }
}

bool ReplaySource::IsInTime(const RecordedItem& item) const {
  // One wild time would move everything that follows it by years, or make the replay wait that
  // long.
  constexpr Nanoseconds kMaxScan = std::chrono::hours(24 * 31);
  std::optional<CaptureTime> time;
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) {
    time = depth->arrival.value_or(depth->frame.header.capture_time);
  } else if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
    time = thermal->arrival.value_or(thermal->frame.header.capture_time);
  } else if (const auto* pose = std::get_if<ExternalOdometry>(&item)) {
    time = pose->time;
  }
  return !time || !first_arrival_ ||
         (*time - *first_arrival_ <= kMaxScan && *first_arrival_ - *time <= kMaxScan);
}

RawFrame ReplaySource::ToRawFrame(const RecordedDepth& recorded) {
  RawFrame frame =
      Prepare(Sensor::kDepth, recorded.frame.header, recorded.frame.image, recorded.arrival);
  frame.depth_scale = recorded.frame.depth_scale;
  return frame;
}

RawFrame ReplaySource::ToRawFrame(const RecordedThermal& recorded) {
  const EncodedThermalFrame& thermal = recorded.frame;
  RawFrame frame = Prepare(Sensor::kThermal, thermal.header, thermal.image, recorded.arrival);
  frame.thermal_scale = thermal.scale;
  frame.housekeeping = thermal.housekeeping;
  const CaptureTime time = thermal.header.capture_time;
  frame.shutter_closed =
      thermal.nuc_state == NucState::kInProgress || thermal.nuc_state == NucState::kError ||
      (last_nuc_event_ && time >= last_nuc_event_->start && time < last_nuc_event_->end);
  return frame;
}

RawFrame ReplaySource::Prepare(Sensor sensor, const FrameHeader& header, const EncodedImage& image,
                               const std::optional<CaptureTime>& arrival) {
  RawFrame frame;
  frame.sensor = sensor;
  const auto index = static_cast<std::size_t>(sensor);
  frame.frame_number = frames_[index]++;
  if (arrival) {
    frame.device_ticks = header.device_ticks;
    // A recording's stamps have the delay taken out already; the timestamper takes it out again, so
    // it is put back here.
    frame.arrival_wall = *arrival + known_delay_[index];
  } else {
    const auto time =
        std::chrono::floor<std::chrono::microseconds>(header.capture_time.time_since_epoch());
    frame.device_ticks = DeviceTicks(time);
    frame.arrival_wall = CaptureTime(time);
  }
  // An image that cannot be decoded stays empty: the frame check refuses and counts it.
  if (Result<Image<std::uint16_t>> pixels = Decode(image)) frame.pixels = std::move(*pixels);
  return frame;
}

bool ReplaySource::StartNextLoop() {
  ++loops_played_;
  if (!first_arrival_ || (loops_ != 0 && loops_played_ >= loops_)) return false;
  const Status sought = reader_->Seek(reader_->info().start.value_or(CaptureTime{}));
  if (!sought.ok()) {
    LOG(Source, Error) << name_ << ": cannot play it again: " << sought.message();
    return false;
  }
  last_nuc_event_.reset();
  // Times go on from loop to loop: for the rest of the edge it is one long scan.
  loop_offset_ = last_arrival_ - *first_arrival_ + kLoopGap;
  return true;
}

void ReplaySource::PlaceInTime(PlayedItem& item) {
  auto* frame = std::get_if<RawFrame>(&item);
  // A pose comes when it is true.
  CaptureTime& arrival = frame ? frame->arrival_wall : std::get<ExternalOdometry>(item).time;
  if (!first_arrival_) {
    first_arrival_ = arrival;
    started_at_ = clock_.SteadyNow();
    if (rebase_) rebase_offset_ = clock_.Now() - arrival;
  }
  if (frame) frame->device_ticks += std::chrono::floor<std::chrono::microseconds>(loop_offset_);
  arrival += loop_offset_;
  last_arrival_ = std::max(last_arrival_, arrival);
  arrival += rebase_offset_;
}

SteadyTime ReplaySource::DueTime(const PlayedItem& item) const {
  const auto* frame = std::get_if<RawFrame>(&item);
  const CaptureTime arrival = frame ? frame->arrival_wall : std::get<ExternalOdometry>(item).time;
  const Nanoseconds since_start = arrival - rebase_offset_ - *first_arrival_;
  return started_at_ + FromSeconds(ToSeconds(since_start) / rate_);
}

}  // namespace isotherm
