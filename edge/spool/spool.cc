#include "edge/spool/spool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/log.h"
#include "common/base/units.h"
#include "common/recording/feedback_record.h"
#include "common/recording/recording_parts.h"
#include "edge/options/edge_options.pb.h"
#include "edge/spool/interrupted_scan.h"
#include "edge/spool/kept_part.h"
#include "edge/spool/older_recordings.h"

namespace isotherm {
namespace {

/// Free space is asked for once a second: at some megabytes a second nothing is missed, and a slow
/// disk is not asked with each frame.
constexpr Nanoseconds kLookInterval = std::chrono::seconds(1);
// A disk that takes this much more is well again; one that fails sooner is still the same failure,
// which is not reported again. The writer's chunks are synced every half second, so that several
// have reached the disk by then.
constexpr Nanoseconds kProven = std::chrono::seconds(3);

}  // namespace

Spool::Spool(SpoolParts parts)
    : parts_(std::move(parts)),
      disk_(parts_.options),
      quota_(parts_.options.quota_gb(), parts_.recordings_size) {
  if (parts_.before != nullptr) TakeOver(*parts_.before);
}

void Spool::TakeOver(const InterruptedScan& before) {
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal})
    recorded_frames_.AddDeleted(sensor, before.Of(sensor).deleted);
  for (std::size_t i = 0; i < before.runs.size(); ++i) {
    const RecordedRun& run = before.runs[i];
    if (i == 0 || run.file != before.runs[i - 1].file) recorded_frames_.BeginFile(run.file);
    recorded_frames_.Add(run.sensor, run.frames, run.time);
  }
  next_ = {before.Of(Sensor::kDepth).next, before.Of(Sensor::kThermal).next};
  closed_.depth_frames = before.Of(Sensor::kDepth).frames;
  closed_.thermal_frames = before.Of(Sensor::kThermal).frames;
  offered_ = {closed_.depth_frames, closed_.thermal_frames};
  taken_over_ = closed_.depth_frames + closed_.thermal_frames;
  UpdateCounters();
}

Status Spool::Begin() {
  const Status begun = BeginFile();
  if (!begun.ok()) Fail(begun);
  UpdateStatus();
  return begun;
}

Status Spool::BeginFile() {
  Result<RecordingFile> file = parts_.next_file();
  if (!file) return file.error();
  file_ = std::move(*file);
  path_ = file_->path;
  if (!IsDevice(path_)) recorded_frames_.BeginFile(path_);  // The others cannot be read back.
  // Each file tells the clock's steps from its own beginning, so that it can be read without the
  // others.
  wall_minus_time_ = Nanoseconds(0);
  if (std::exchange(is_next_part_, false)) {
    LOG(Spool, Debug) << "recording to " << path_.string();  // As a rule once in some seconds.
  } else {
    begun_at_ = parts_.clock.SteadyNow();
    LOG(Spool, Info) << "recording to " << path_.string();
  }
  return KeepsNewest() ? WriteBefore() : OkStatus();
}

Status Spool::WriteBefore() {
  const RecordedBefore before{StreamBefore{closed_.depth_frames, next_[0]},
                              StreamBefore{closed_.thermal_frames, next_[1]}};
  return file_->writer->WriteMetadata(kBeforeMetadata, ToMetadata(before));
}

void Spool::BeginFileWhenDue() {
  if (IsRecording()) return;
  LookAtDisk();
  if (at_reserve_ || parts_.clock.SteadyNow() < retry_at_) return;
  if (const Status begun = BeginFile(); !begun.ok()) Fail(begun);
}

void Spool::Add(const EncodedFrame& frame) {
  // Counted before anything can fail: what no file has is then known as not recorded.
  ++offered_[static_cast<std::size_t>(frame.sensor())];
  EndPartWhenDue();
  BeginFileWhenDue();
  WriteLines();
  if (IsRecording()) Note(WriteFrame(frame));
  UpdateCounters();
}

void Spool::Add(const RigUpdate& update) {
  if (parts_.update) parts_.update(update);
  if (IsRecording()) Note(WriteRig(update));
}

Status Spool::WriteRig(const RigUpdate& update) {
  if (update.rig) ISOTHERM_RETURN_IF_ERROR(file_->writer->Write(*update.rig));
  return file_->writer->WriteMetadata("cameras", update.cameras);
}

void Spool::Add(const Feedback& feedback, CaptureTime arrival) {
  if (IsRecording()) Note(WriteFeedback(feedback, arrival, *file_->writer, newest_));
}

void Spool::Add(const RecordedLog& line) {
  constexpr std::size_t kMaxWaiting = 100;  // Nobody has more to say while a disk is full.
  if (waiting_lines_.size() < kMaxWaiting) waiting_lines_.push_back(line);
  WriteLines();
}

void Spool::WriteLines() {
  if (!IsRecording()) return;
  for (const RecordedLog& line : std::exchange(waiting_lines_, {}))
    if (IsRecording()) Note(file_->writer->WriteLog(line.time, line.level, line.text));
}

void Spool::Tend(bool idle) {
  // A chunk is closed by the next frame's time; when none comes, nobody else closes it.
  if (idle && IsRecording()) Note(file_->writer->Flush());
  if (IsRecording()) NoteWorks();
  LookAtDisk();
  BeginFileWhenDue();
  UpdateCounters();
  UpdateStatus();
}

void Spool::LookAtDisk() {
  const SteadyTime now = parts_.clock.SteadyNow();
  if (now < next_look_) return;
  next_look_ = now + kLookInterval;
  AskForFreeBytes();
  if (!free_bytes_ && parts_.options.quota_gb() == 0.0) return;
  const DiskLevel before = std::exchange(level_, Measure());
  if (level_ == DiskLevel::kReserve) MakeRoom();
  // A reader may hold what was deleted, so that the room is there a little later.
  if (level_ == DiskLevel::kReserve && KeepsNewest() && DeleteOldest()) return;
  if (level_ == DiskLevel::kReserve) return EndAtReserve();
  WarnIfLittleIsKept();
  if (std::exchange(at_reserve_, false)) {
    LOG(Spool, Info) << "there is space on the disk again, free_mb="
                     << std::lround(static_cast<double>(free_bytes_.value_or(0)) / kBytesPerMb)
                     << "; frames not recorded=" << NotRecorded() - not_recorded_before_;
    problem_ = OkStatus();
  }
  if (level_ == DiskLevel::kLow && before == DiskLevel::kEnough && !KeepsNewest()) {
    LOG(Spool, Warning) << (disk_.is_quota_first() ? "the quota of recordings (spool.quota_gb)"
                                                   : "the disk")
                        << " of " << path_.string()
                        << (disk_.is_quota_first() ? " is used up in " : " is full in ")
                        << std::lround(disk_.left_s() / 60.0)
                        << " min: delete old recordings, or end the scan in time";
  }
}

DiskLevel Spool::Measure() {
  const SteadyTime now = parts_.clock.SteadyNow();
  if (MayDelete() && parts_.deletable_size && now >= deletable_due_) {
    deletable_due_ = now + QuotaWatch::kInterval;
    deletable_bytes_ = parts_.deletable_size();
  }
  const std::uint64_t own_bytes = OwnBytes();
  quota_left_bytes_ = quota_.Left(now, own_bytes);
  // Without an answer the disk is not what ends the recording.
  return disk_.Update(now,
                      {free_bytes_.value_or(std::numeric_limits<std::uint64_t>::max()),
                       quota_left_bytes_, deletable_bytes_},
                      own_bytes, at_reserve_);
}

std::uint64_t Spool::OwnBytes() const {
  return closed_.bytes + (IsRecording() ? file_->writer->stats().bytes : 0);
}

bool Spool::KeepsNewest() const { return parts_.options.when_full() == KEEP_NEWEST; }

bool Spool::MayDelete() const {
  return parts_.options.when_full() == DELETE_FETCHED && parts_.make_room;
}

void Spool::EndPartWhenDue() {
  if (!KeepsNewest() || !IsRecording()) return;
  const double part_bytes =
      parts_.options.quota_gb() * QuotaWatch::kBytesPerGb / DiskWatch::kKeptParts;
  if (static_cast<double>(file_->writer->stats().bytes) < part_bytes) return;
  Status ended = file_->writer->WriteMetadata(kGoesOnMetadata, {{"in", "the next file"}});
  const Status closed = CloseFile();
  if (ended.ok()) ended = closed;
  is_next_part_ = ended.ok();
  Note(ended);
}

bool Spool::DeleteOldest() {
  constexpr int kMaxAtOnce = 2;
  bool was_any = false;
  for (int i = 0; i < kMaxAtOnce && level_ == DiskLevel::kReserve && parts_.delete_oldest; ++i) {
    const std::optional<DeletedFile> deleted = parts_.delete_oldest();
    if (!deleted) break;
    was_any = true;
    if (deleted->is_of_present) {
      LOG(Spool, Debug) << "deleted " << deleted->path.string() << " to keep what is newer";
      recorded_frames_.DeleteUpTo(deleted->path);
    } else {
      LOG(Spool, Warning) << "deleted " << deleted->path.string() << ", which was "
                          << (deleted->was_fetched ? "" : "NOT ")
                          << "fetched, to keep what is newer (spool.when_full=KEEP_NEWEST)";
    }
    quota_.AskAgain();
    AskForFreeBytes();
    level_ = Measure();
  }
  return was_any;
}

void Spool::MakeRoom() {
  while (MayDelete() && level_ == DiskLevel::kReserve) {
    const std::uint64_t free_before = free_bytes_.value_or(0);
    const bool is_for_disk = !disk_.is_quota_first();
    // A file system that keeps what is deleted (snapshots, hard links) would lose all for nothing.
    if (is_for_disk && futile_at_ && free_before <= *futile_at_) return;
    const std::optional<DeletedRecording> deleted = parts_.make_room();
    if (!deleted) return;
    LOG(Spool, Warning) << "deleted " << deleted->name << ", which was fetched, to make room: "
                        << std::lround(static_cast<double>(deleted->bytes) / kBytesPerMb) << " MB";
    quota_.AskAgain();
    deletable_due_ = {};
    AskForFreeBytes();
    level_ = Measure();
    futile_at_.reset();
    if (is_for_disk && free_bytes_.value_or(0) <= free_before) futile_at_ = free_before;
  }
}

void Spool::AskForFreeBytes() {
  const Result<std::uint64_t> free = parts_.free_bytes();
  free_bytes_ = free ? std::optional(*free) : std::nullopt;
  // Reported when it changes, not every second.
  if (std::exchange(free_bytes_unknown_, !free) == !free) return;
  if (free) {
    LOG(Spool, Info) << "the free space of the disk of " << path_.string() << " is known again";
  } else {
    LOG(Spool, Warning) << free.error().message()
                        << "; nobody will be told before it is full, recording goes on";
  }
}

void Spool::EndAtReserve() {
  if (std::exchange(at_reserve_, true)) return;
  const Status closed = IsRecording() ? CloseFile() : OkStatus();
  const std::string what =
      disk_.is_quota_first()
          ? fmt::format("all recordings take their {:g} GB (spool.quota_gb)",
                        parts_.options.quota_gb())
          : fmt::format(
                "the disk is full but for its reserve of {:.0f} MB (spool.expert.reserve_mb, "
                "reserve_s)",
                disk_.reserve_bytes() / kBytesPerMb);
  problem_ = ResourceExhausted(
      fmt::format("{}: {} is complete up to here, no frame is recorded from now on; {}", what,
                  path_.empty() ? "the recording" : path_.string(),
                  KeepsNewest() ? "none of the rig's recordings can be deleted: make room"
                                : "delete old recordings, or fetch them and set "
                                  "spool.when_full=DELETE_FETCHED"));
  if (first_error_.ok()) first_error_ = closed.ok() ? problem_ : closed;
  LOG(Spool, Error) << problem_.message()
                    << (parts_.options.when_full() == STOP_SCAN
                            ? "; the scan is stopped (spool.when_full=STOP_SCAN)"
                            : "; publishing goes on");
}

Status Spool::WriteFrame(const EncodedFrame& frame) {
  RecordingWriter& writer = *file_->writer;
  const CaptureTime time =
      std::visit([](const auto& content) { return content.header.capture_time; }, frame.content);
  newest_ = std::max(newest_.value_or(time), time);
  // What happened before the frame stands before it in the file, so that a replay gets it in time.
  for (const ExternalOdometrySample& sample : frame.external_odometry)
    ISOTHERM_RETURN_IF_ERROR(writer.Write(sample.pose));
  for (const RecordedLog& log : frame.log)
    ISOTHERM_RETURN_IF_ERROR(writer.WriteLog(log.time, log.level, log.text));
  ISOTHERM_RETURN_IF_ERROR(WriteClockStep(frame));
  if (const auto* depth = std::get_if<EncodedDepthFrame>(&frame.content)) {
    ISOTHERM_RETURN_IF_ERROR(writer.Write(*depth, frame.arrival));
    NoteRecorded(Sensor::kDepth, depth->header);
    return OkStatus();
  }
  const auto& thermal = std::get<EncodedThermalFrame>(frame.content);
  NoteShutter(thermal);
  // Noting the shutter may have ended the file: then there is no writer any more.
  if (!IsRecording()) return OkStatus();
  ISOTHERM_RETURN_IF_ERROR(writer.Write(thermal, frame.arrival));
  NoteRecorded(Sensor::kThermal, thermal.header);
  return OkStatus();
}

void Spool::NoteRecorded(Sensor sensor, const FrameHeader& header) {
  recorded_frames_.Add(sensor, header.frame_number, header.capture_time);
  std::uint64_t& next = next_[static_cast<std::size_t>(sensor)];
  next = std::max(next, header.frame_number + 1);
}

Status Spool::WriteClockStep(const EncodedFrame& frame) {
  const Nanoseconds step = frame.wall_minus_time - wall_minus_time_;
  if (step == Nanoseconds(0)) return OkStatus();
  wall_minus_time_ = frame.wall_minus_time;
  const CaptureTime time =
      std::visit([](const auto& content) { return content.header.capture_time; }, frame.content);
  return file_->writer->Write(ClockStep{time, step, frame.wall_minus_time});
}

void Spool::NoteShutter(const EncodedThermalFrame& frame) {
  const CaptureTime time = frame.header.capture_time;
  const bool closed =
      frame.nuc_state == NucState::kInProgress || frame.nuc_state == NucState::kError;
  if (closed && !shutter_closed_at_) shutter_closed_at_ = time;
  // An event is written when it is over, since it has both times. One that lasts to the end of the
  // scan has no record; its frames say what they are.
  if (closed || !shutter_closed_at_) return;
  Note(file_->writer->Write(NucEvent{*shutter_closed_at_, time, frame.nuc_source}));
  shutter_closed_at_.reset();
}

Status Spool::CloseFile() {
  const Status closed = file_->writer->Close();
  const RecordingStats stats = file_->writer->stats();
  closed_.depth_frames += stats.depth_frames;
  closed_.thermal_frames += stats.thermal_frames;
  closed_.bytes += stats.bytes;
  file_.reset();
  RemoveIfWithoutFrames(path_, stats);
  return closed;
}

Status Spool::Close() {
  if (IsRecording()) Note(CloseFile());
  UpdateCounters();
  UpdateStatus();
  return first_error_;
}

void Spool::Note(const Status& status) {
  if (status.ok()) return;
  if (!EndsFile(status)) {
    if (first_error_.ok()) first_error_ = status;
    if (refused_++ == 0) {
      LOG(Spool, Warning) << "not recorded: " << status.message();
    }
    return;
  }
  Fail(status);
}

void Spool::Fail(const Status& status) {
  if (first_error_.ok()) first_error_ = status;
  // The cause is known already; closing after it mostly fails for the same reason.
  if (IsRecording()) static_cast<void>(CloseFile());
  retry_at_ = parts_.clock.SteadyNow() + back_off_.Next();
  if (problem_.ok()) {
    LOG(Spool, Error) << "recording ended early, publishing goes on: " << status.message()
                      << "; a new file is begun when the disk takes it";
  }
  problem_ = status;
}

void Spool::NoteWorks() {
  if (problem_.ok() || parts_.clock.SteadyNow() - begun_at_ < kProven) return;
  problem_ = OkStatus();
  back_off_.Reset();
  LOG(Spool, Warning) << "the disk works again, recording to " << path_.string()
                      << "; frames not recorded=" << NotRecorded() - not_recorded_before_;
}

}  // namespace isotherm
