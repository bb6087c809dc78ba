#include "ground/scan_recorder.h"

#include "common/base/log.h"
#include "common/config/text_proto.h"
#include "common/transport/feedback_record.h"

namespace isotherm {

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

void ScanRecorder::Write(const RigDescription& rig) { Note(writer_->Write(rig.rig)); }
void ScanRecorder::Write(const ReceivedDepth& depth) {
  Note(writer_->Write(*depth.encoded, depth.arrival));
}
void ScanRecorder::Write(const ReceivedThermal& thermal) {
  Note(writer_->Write(*thermal.encoded, thermal.arrival));
}

void ScanRecorder::Write(const Feedback& feedback) {
  Note(WriteFeedback(feedback, std::nullopt, *writer_));
}

void ScanRecorder::Write(const OutsidePoseSample& sample) { Note(writer_->Write(sample.pose)); }

Status ScanRecorder::Close() {
  Note(writer_->Close());
  return first_error_;
}

}  // namespace isotherm
