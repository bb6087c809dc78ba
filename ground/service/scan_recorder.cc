#include "ground/service/scan_recorder.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "common/base/log.h"
#include "common/config/text_proto.h"
#include "common/recording/clock_record.h"
#include "common/recording/feedback_record.h"

namespace isotherm {
namespace {

/// As the edge's recording has it; nothing if there is no camera.
void AddCamera(const std::string& name, const StreamMode& camera,
               std::map<std::string, std::string>& metadata) {
  if (camera.model.empty()) return;
  metadata[name] = camera.model;
  metadata[name + "_serial"] = camera.serial;
  metadata[name + "_mode"] = ModeText(camera);
}

}  // namespace

Result<std::unique_ptr<ScanRecorder>> ScanRecorder::Create(const std::filesystem::path& path,
                                                           const GroundOptions& options) {
  RecordingOptions recording;
  recording.image_storage =
      options.live().record_viewable() ? ImageStorage::kViewable : ImageStorage::kCompact;
  Result<std::unique_ptr<RecordingWriter>> writer = RecordingWriter::Create(path, recording);
  if (!writer) return Err(writer.error());
  std::unique_ptr<ScanRecorder> recorder(new ScanRecorder(std::move(*writer)));
  recorder->Note(recorder->writer_->WriteMetadata(
      "configuration", {{"program", "isotherm-ground"}, {"options", ToTextProto(options)}}));
  return recorder;
}

void ScanRecorder::Note(const Status& status) {
  if (status.ok() || !first_error_.ok()) return;
  first_error_ = status;
  LOG(Ground, Error) << "the recording ends here, the scan goes on: " << status.message();
}

void ScanRecorder::Write(const RigDescription& rig) {
  Note(writer_->Write(rig.rig));
  std::map<std::string, std::string> cameras;
  AddCamera("depth", rig.depth, cameras);
  AddCamera("thermal", rig.thermal, cameras);
  if (!cameras.empty()) Note(writer_->WriteMetadata("cameras", cameras));
}
void ScanRecorder::Write(const ReceivedDepth& depth) {
  Note(writer_->Write(*depth.encoded, depth.arrival));
}
void ScanRecorder::Write(const ReceivedThermal& thermal) {
  Note(writer_->Write(*thermal.encoded, thermal.arrival));
}

void ScanRecorder::Write(const Feedback& feedback) {
  Note(WriteFeedback(feedback, std::nullopt, *writer_));
}

void ScanRecorder::Write(const ExternalOdometrySample& sample) {
  Note(writer_->Write(sample.pose));
}

void ScanRecorder::Write(const SessionClock& clock) {
  const SessionClock before = std::exchange(clock_, clock).value_or(SessionClock());
  const double step_s = clock.rig.step_sum_s - before.rig.step_sum_s;
  if (step_s != 0.0) {
    const Nanoseconds total = FromSeconds(clock.rig.step_sum_s);
    Note(writer_->Write(ClockStep{clock.time - total, FromSeconds(step_s), total}));
  }
  const auto kind = [](const SessionClock& counters) {
    return std::tuple(counters.rig.synchronised, counters.unsynchronised, counters.rig.steps,
                      counters.alarm, counters.offset.has_value());
  };
  if (kind(clock) != kind(before)) WriteClockMetadata();
}

void ScanRecorder::WriteClockMetadata() {
  std::map<std::string, std::string> state = ToMetadata(clock_->rig);
  if (clock_->unsynchronised) state["synchronised"] = "no";
  state["steps"] = fmt::format("{}", clock_->rig.steps);
  state["alarms"] = fmt::format("{}", clock_->alarms);
  if (clock_->offset) {
    state["minus_ground_clock_s"] = fmt::format("{}", clock_->offset->offset_s);
    state["minus_ground_clock_uncertainty_s"] = fmt::format("{}", clock_->offset->uncertainty_s);
  }
  Note(writer_->WriteMetadata(kClockMetadata, state));
}

Status ScanRecorder::Close() {
  if (clock_) WriteClockMetadata();  // As it was in the end.
  clock_.reset();
  Note(writer_->Close());
  return first_error_;
}

}  // namespace isotherm
