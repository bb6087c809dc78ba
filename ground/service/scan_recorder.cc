#include "ground/service/scan_recorder.h"

#include <fmt/format.h>

#include <system_error>
#include <tuple>
#include <utility>

#include "common/base/log.h"
#include "common/base/printable.h"
#include "common/options/text_proto.h"
#include "common/recording/clock_record.h"
#include "common/recording/feedback_record.h"
#include "common/recording/recording_parts.h"

namespace isotherm {
namespace {

// A disk that takes this much more is well again; one that fails sooner is still the same failure,
// which is not reported again. The writer's chunks are synced every half second, so that several
// have reached the disk by then.
constexpr Nanoseconds kProven = std::chrono::seconds(3);

ScanRecorder::CreateWriter OnDisk(const GroundOptions& options, const Clock& clock) {
  RecordingOptions recording;
  recording.clock = &clock;
  recording.image_storage =
      options.live().expert().record_viewable() ? ImageStorage::kViewable : ImageStorage::kCompact;
  return [recording](const std::filesystem::path& path) {
    // The disk may have come since the scan began. That there is no folder is said by what follows.
    std::error_code ignored;
    std::filesystem::create_directories(path.parent_path(), ignored);
    return RecordingWriter::Create(path, recording);
  };
}

/// As the edge's recording has it; nothing if there is no camera.
void AddCamera(const std::string& name, const StreamMode& camera,
               std::map<std::string, std::string>& metadata) {
  if (camera.model.empty()) return;
  metadata[name] = camera.model;
  metadata[name + "_serial"] = camera.serial;
  metadata[name + "_mode"] = ModeText(camera);
}

}  // namespace

ScanRecorder::ScanRecorder(const std::filesystem::path& path, const GroundOptions& options,
                           const RigDescription& rig, const Clock& clock)
    : ScanRecorder(path, options, rig, clock, OnDisk(options, clock)) {}

ScanRecorder::ScanRecorder(const std::filesystem::path& path, const GroundOptions& options,
                           const RigDescription& rig, const Clock& clock, CreateWriter create)
    : path_(path),
      options_text_(ToTextProto(options)),
      rig_(rig),
      clock_(clock),
      create_(std::move(create)) {}

void ScanRecorder::Tend() {
  if (is_recording()) return NoteWorks();
  if (clock_.SteadyNow() < retry_at_) return;
  if (const Status begun = BeginFile(); !begun.ok()) return Fail(begun);
  WriteBeginning();
  if (is_recording() && part_ > 1) {
    LOG(Ground, Info) << "recording to " << files_.back().string();
  }
}

Status ScanRecorder::BeginFile() {
  // A file that exists is never written over: it may be the only record of another scan.
  const int part = IsDevice(path_) ? 1 : NextFreePart(path_, part_);
  const std::filesystem::path file = PartPath(path_, part);
  Result<std::unique_ptr<RecordingWriter>> writer = create_(file);
  if (!writer) return writer.error();
  if (files_.empty() && part > 1) {
    LOG(Ground, Info) << path_.string() << " exists already; recording beside it";
  }
  writer_ = std::move(*writer);
  part_ = part;
  files_.push_back(file);
  begun_at_ = clock_.SteadyNow();
  // Each file tells the clock's steps from its own beginning, so that it can be read without the
  // others.
  step_sum_s_ = 0.0;
  return OkStatus();
}

void ScanRecorder::WriteBeginning() {
  Note(writer_->WriteMetadata("configuration",
                              {{"program", "isotherm-ground"}, {"options", options_text_}}));
  WriteRig();
  if (is_recording() && rig_clock_) Note(WriteClockStep());
  if (is_recording() && rig_clock_) Note(WriteClockMetadata());
  WriteMarks();
}

void ScanRecorder::WriteRig() {
  if (is_recording()) Note(writer_->Write(rig_.rig));
  std::map<std::string, std::string> cameras;
  AddCamera("depth", rig_.depth, cameras);
  AddCamera("thermal", rig_.thermal, cameras);
  if (is_recording() && !cameras.empty()) Note(writer_->WriteMetadata("cameras", cameras));
}

void ScanRecorder::Write(const RigDescription& rig) {
  rig_ = rig;
  WriteRig();
}

template <typename Frame>
void ScanRecorder::WriteFrame(Sensor sensor, const Frame& frame) {
  const auto stream = static_cast<std::size_t>(sensor);
  // Counted before anything can fail: offered = recorded + lost + unwritable holds whatever happens
  // below.
  ++offered_[stream];
  Tend();
  if (!is_recording()) return;
  const Status written = writer_->Write(*frame.encoded, frame.arrival);
  // Such a frame fits into no file on any disk (too large, for instance); the file itself is good.
  if (!written.ok() && !EndsFile(written)) ++unwritable_[stream];
  Note(written);
}
template void ScanRecorder::WriteFrame(Sensor, const ReceivedDepth&);
template void ScanRecorder::WriteFrame(Sensor, const ReceivedThermal&);

void ScanRecorder::Write(const Feedback& feedback) {
  if (is_recording()) Note(WriteFeedback(feedback, std::nullopt, *writer_));
}

void ScanRecorder::Write(const ScanMark& mark) {
  marks_.push_back(mark);
  WriteMarks();
}

void ScanRecorder::WriteMarks() {
  if (!is_recording()) return;
  for (const ScanMark& mark : std::exchange(marks_, {})) {
    // Whoever sent it: recordings hold UTF-8 only.
    if (is_recording())
      Note(writer_->WriteLog(mark.time, "info", kMarkPrefix + Printable(mark.text)));
  }
}

void ScanRecorder::Write(const ExternalOdometrySample& sample) {
  if (is_recording()) Note(writer_->Write(sample.pose));
}

void ScanRecorder::Write(const SessionClock& clock) {
  const SessionClock before = std::exchange(rig_clock_, clock).value_or(SessionClock());
  if (is_recording()) Note(WriteClockStep());
  const auto kind = [](const SessionClock& counters) {
    return std::tuple(counters.rig.synchronised, counters.unsynchronised, counters.rig.steps,
                      counters.alarm, counters.offset.has_value());
  };
  // Only changes of kind are written: offsets change with every status, and metadata is not a
  // stream.
  if (is_recording() && kind(clock) != kind(before)) Note(WriteClockMetadata());
}

Status ScanRecorder::WriteClockStep() {
  const double step_s =
      rig_clock_->rig.step_sum_s - std::exchange(step_sum_s_, rig_clock_->rig.step_sum_s);
  if (step_s == 0.0) return OkStatus();
  const Nanoseconds total = FromSeconds(rig_clock_->rig.step_sum_s);
  return writer_->Write(ClockStep{rig_clock_->time - total, FromSeconds(step_s), total});
}

Status ScanRecorder::WriteClockMetadata() {
  std::map<std::string, std::string> state = ToMetadata(rig_clock_->rig);
  if (rig_clock_->unsynchronised) state["synchronised"] = "no";
  state["steps"] = fmt::format("{}", rig_clock_->rig.steps);
  state["alarms"] = fmt::format("{}", rig_clock_->alarms);
  if (rig_clock_->offset) {
    state["minus_ground_clock_s"] = fmt::format("{}", rig_clock_->offset->offset_s);
    state["minus_ground_clock_uncertainty_s"] =
        fmt::format("{}", rig_clock_->offset->uncertainty_s);
  }
  return writer_->WriteMetadata(kClockMetadata, state);
}

void ScanRecorder::Flush() {
  if (is_recording()) Note(writer_->Flush());
}

void ScanRecorder::Note(const Status& status) {
  if (status.ok()) return;
  if (EndsFile(status)) return Fail(status);
  if (std::exchange(refusal_, status).ok()) {
    LOG(Ground, Warning) << "not recorded: " << status.message();
  }
}

void ScanRecorder::Fail(const Status& status) {
  end_ = disk_error_ = status;
  // The cause is known already; closing after it mostly fails for the same reason.
  if (is_recording()) static_cast<void>(CloseFile());
  retry_at_ = clock_.SteadyNow() + back_off_.Next();
  if (!std::exchange(failing_, true)) {
    LOG(Ground, Error) << "the recording stops here, the scan goes on: " << status.message()
                       << "; a new file is begun when the disk takes it";
  }
}

void ScanRecorder::NoteWorks() {
  if (!failing_) {
    // Remembered while all is well, so that the message at the end of a failure says what that
    // failure cost.
    lost_before_ = Lost();
    return;
  }
  if (clock_.SteadyNow() - begun_at_ < kProven) return;
  failing_ = false;
  back_off_.Reset();
  LOG(Ground, Warning) << "the disk works again, recording to " << files_.back().string()
                       << "; frames not recorded=" << Lost() - lost_before_;
}

Status ScanRecorder::CloseFile() {
  Status closed = OkStatus();
  if (rig_clock_) closed = WriteClockMetadata();  // As it was in the end.
  if (const Status ended = writer_->Close(); closed.ok()) closed = ended;
  const RecordingStats stats = writer_->stats();
  writer_.reset();
  closed_.depth_frames += stats.depth_frames;
  closed_.thermal_frames += stats.thermal_frames;
  closed_.bytes += stats.bytes;
  // Each attempt on a full disk would leave an empty file behind, and use up a part number.
  if (EndsFile(closed) && RemoveIfWithoutFrames(files_.back(), stats)) {
    files_.pop_back();
    --part_;
  }
  return closed;
}

void ScanRecorder::EndFile(const Status& why) {
  end_ = why;
  static_cast<void>(Close());
}

Status ScanRecorder::Close() {
  if (is_recording()) Note(CloseFile());
  return status();
}

RecorderCounts ScanRecorder::counts(Sensor sensor) const {
  const RecordingStats open = is_recording() ? writer_->stats() : RecordingStats();
  const auto stream = static_cast<std::size_t>(sensor);
  RecorderCounts counts{.offered = offered_[stream], .unwritable = unwritable_[stream]};
  counts.recorded = sensor == Sensor::kDepth ? closed_.depth_frames + open.depth_frames
                                             : closed_.thermal_frames + open.thermal_frames;
  counts.lost = counts.offered - counts.recorded - counts.unwritable;
  return counts;
}

std::uint64_t ScanRecorder::Lost() const {
  return counts(Sensor::kDepth).lost + counts(Sensor::kThermal).lost;
}

std::uint64_t ScanRecorder::bytes() const {
  return closed_.bytes + (is_recording() ? writer_->stats().bytes : 0);
}

}  // namespace isotherm
