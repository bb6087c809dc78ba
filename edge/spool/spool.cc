#include "edge/spool/spool.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "common/base/log.h"
#include "common/transport/feedback_record.h"
#include "edge/edge_options.pb.h"

namespace isotherm {

std::optional<std::filesystem::path> SpoolPath(const std::string& record, CaptureTime now) {
  if (record == "off") return std::nullopt;
  const std::filesystem::path path = record;
  std::error_code ignored;
  if (path.has_filename() && !std::filesystem::is_directory(path, ignored)) return path;
  const std::time_t seconds =
      std::chrono::floor<std::chrono::seconds>(now.time_since_epoch()).count();
  return path / fmt::format("edge-{:%Y%m%d-%H%M%S}.mcap", fmt::gmtime(seconds));
}

Result<std::unique_ptr<Spool>> Spool::Create(const std::filesystem::path& path,
                                             const SpoolOptions& options,
                                             const std::optional<Rig>& rig,
                                             const Metadata& metadata, FrameAccount& account) {
  RecordingOptions recording;
  recording.flush_interval = FromSeconds(options.flush_interval_s());
  Result<std::unique_ptr<RecordingWriter>> writer = RecordingWriter::Create(path, recording);
  if (!writer) return Err(writer.error());
  if (rig) {
    if (const Status written = (*writer)->Write(*rig); !written.ok()) return Err(written);
  }
  for (const auto& [name, values] : metadata) {
    const Status written = (*writer)->WriteMetadata(name, values);
    if (!written.ok()) return Err(written);
  }
  return std::make_unique<Spool>(path, std::move(*writer), account);
}

Spool::Spool(std::filesystem::path path, std::unique_ptr<RecordingWriter> writer,
             FrameAccount& account)
    : path_(std::move(path)), writer_(std::move(writer)), account_(account) {}

void Spool::Add(const EncodedFrame& frame) {
  ++offered_[static_cast<std::size_t>(frame.sensor())];
  if (first_error_.ok()) NoteError(WriteFrame(frame));
  UpdateAccount();
}

void Spool::Add(const Feedback& feedback, CaptureTime arrival) {
  if (first_error_.ok()) NoteError(WriteFeedback(feedback, arrival, *writer_, newest_));
}

Status Spool::WriteFrame(const EncodedFrame& frame) {
  const CaptureTime time =
      std::visit([](const auto& content) { return content.header.capture_time; }, frame.content);
  newest_ = std::max(newest_.value_or(time), time);
  for (const OutsidePoseSample& sample : frame.outside_poses)
    ISOTHERM_RETURN_IF_ERROR(writer_->Write(sample.pose));
  for (const RecordedLog& log : frame.log)
    ISOTHERM_RETURN_IF_ERROR(writer_->WriteLog(log.time, log.level, log.text));
  ISOTHERM_RETURN_IF_ERROR(WriteClockStep(frame));
  if (const auto* depth = std::get_if<EncodedDepthFrame>(&frame.content)) {
    return writer_->Write(*depth, frame.arrival);
  }
  const auto& thermal = std::get<EncodedThermalFrame>(frame.content);
  NoteShutter(thermal);
  return writer_->Write(thermal, frame.arrival);
}

Status Spool::WriteClockStep(const EncodedFrame& frame) {
  const Nanoseconds step = frame.wall_minus_time - wall_minus_time_;
  if (step == Nanoseconds(0)) return OkStatus();
  wall_minus_time_ = frame.wall_minus_time;
  const CaptureTime time =
      std::visit([](const auto& content) { return content.header.capture_time; }, frame.content);
  return writer_->Write(ClockStep{time, step, frame.wall_minus_time});
}

void Spool::NoteShutter(const EncodedThermalFrame& frame) {
  const CaptureTime time = frame.header.capture_time;
  const bool closed =
      frame.nuc_state == NucState::kInProgress || frame.nuc_state == NucState::kError;
  if (closed && !shutter_closed_at_) shutter_closed_at_ = time;
  if (closed || !shutter_closed_at_) return;
  NoteError(writer_->Write(NucEvent{*shutter_closed_at_, time, frame.nuc_source}));
  shutter_closed_at_.reset();
}

Status Spool::Close() {
  NoteError(writer_->Close());
  UpdateAccount();
  return first_error_;
}

void Spool::NoteError(const Status& status) {
  if (status.ok() || !first_error_.ok()) return;
  first_error_ = status;
  LOG(Spool, Error) << "recording ended early, publishing goes on: " << status.message();
}

void Spool::UpdateAccount() {
  const RecordingStats written = writer_->stats();
  const auto set = [this](Sensor sensor, std::uint64_t recorded) {
    account_.Set(sensor, FrameFate::kRecorded, recorded);
    account_.Set(sensor, FrameFate::kRecordFailed,
                 offered_[static_cast<std::size_t>(sensor)] - recorded);
  };
  set(Sensor::kDepth, written.depth_frames);
  set(Sensor::kThermal, written.thermal_frames);
}

}  // namespace isotherm
