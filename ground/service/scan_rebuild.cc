#include "ground/service/scan_rebuild.h"

#include <utility>
#include <variant>

#include "common/base/log.h"
#include "ground/offline/recorded_frames.h"

namespace isotherm {
namespace {

/// A frame's number takes a tenth of a millisecond to read.
constexpr int kItemsPerStep = 16;
/// The rig learns of so many frames at once.
constexpr std::size_t kNumbersAtOnce = 256;

}  // namespace

ScanRebuild::ScanRebuild(const SessionStart& start, const Clock& clock, Subscriber& subscriber,
                         LiveScan* scan)
    : session_(start.rig.session),
      recording_(start.recording),
      clock_(clock),
      subscriber_(subscriber),
      scan_(scan),
      begun_(clock.SteadyNow()),
      files_(start.earlier_files) {}

bool ScanRebuild::Begin() {
  std::erase_if(files_, [this](const std::filesystem::path& file) { return !IsOfSession(file); });
  recording_->Update([this](RecordingProgress& progress) { progress.earlier_files = files_; });
  return !files_.empty();
}

bool ScanRebuild::IsOfSession(const std::filesystem::path& file) const {
  const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(file);
  if (!reader) {
    LOG(Ground, Warning) << "not used for this scan: " << reader.error().message();
    return false;
  }
  while (true) {
    const Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (!item) continue;  // Said when the model is made.
    if (!*item) return false;
    const FrameHeader* header = HeaderOf(**item);
    if (header == nullptr) continue;
    if (header->session == session_) return true;
    LOG(Ground, Info) << file.string() << " is of another scan, and stays as it is";
    return false;
  }
}

bool ScanRebuild::Step() {
  if (is_survey_) {
    is_survey_ = Survey();
    if (is_survey_) return true;
    BeginModel();
    Report();
    return all_ != nullptr;
  }
  if (Rebuild()) return true;
  if (const Status& conflict = all_->conflict(); !conflict.ok()) {
    LOG(Ground, Warning) << "the model has only a part of what was recorded: "
                         << conflict.message();
    return false;
  }
  report_.is_finished = true;
  scan_->EndRecorded();
  recording_->Update([](RecordingProgress& progress) { progress.is_earlier_in_model = true; });
  Report();
  LOG(Ground, Info) << "the model is made anew of what was recorded, frames=" << report_.frames
                    << " elapsed_s=" << report_.elapsed_s
                    << "; left out of it meanwhile, frames=" << report_.left_out;
  return false;
}

bool ScanRebuild::Survey() {
  if (next_file_ == files_.size()) return false;
  if (!reader_) {
    Result<std::unique_ptr<RecordingReader>> opened = RecordingReader::Open(files_[next_file_]);
    if (!opened) {
      LOG(Ground, Warning) << "not used for this scan: " << opened.error().message();
      EndFile(false);
      return true;
    }
    reader_ = std::move(*opened);
    frames_in_file_ = 0;
  }
  for (int i = 0; i < kItemsPerStep; ++i) {
    const Result<std::optional<RecordedItem>> item = reader_->Next();
    if (!item) continue;  // Said when the model is made.
    if (!*item) {
      EndFile(frames_in_file_ > 0);
      return true;
    }
    const FrameHeader* header = HeaderOf(**item);
    if (header == nullptr) continue;
    // Of a file with frames of two scans no recording can be made.
    if (header->session != session_) continue;
    Note(std::holds_alternative<RecordedDepth>(**item) ? Sensor::kDepth : Sensor::kThermal,
         *header);
  }
  return true;
}

void ScanRebuild::EndFile(bool is_of_session) {
  reader_.reset();
  if (is_of_session) {
    recorded_frames_ += frames_in_file_;
    ++next_file_;
  } else {
    files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(next_file_));
  }
}

void ScanRebuild::Note(Sensor sensor, const FrameHeader& header) {
  ++frames_in_file_;
  std::vector<RecordedNumbers::Frame>& frames = frames_.at(static_cast<std::size_t>(sensor));
  frames.push_back({header.frame_number, header.capture_time});
  if (frames.size() >= kNumbersAtOnce) Send(sensor);
}

void ScanRebuild::Send(Sensor sensor) {
  std::vector<RecordedNumbers::Frame>& frames = frames_.at(static_cast<std::size_t>(sensor));
  subscriber_.AddRecorded({session_, sensor, std::exchange(frames, {})});
}

void ScanRebuild::BeginModel() {
  Send(Sensor::kDepth);
  Send(Sensor::kThermal);
  recording_->Update([this](RecordingProgress& progress) { progress.earlier_files = files_; });
  if (files_.empty() || scan_ == nullptr) return;
  LOG(Ground, Info) << "the scan was under way before this process, and goes on: folder="
                    << files_.front().parent_path().string()
                    << " recorded_frames=" << recorded_frames_;
  Result<std::unique_ptr<MergedRecording>> all = MergedRecording::OpenAll(files_);
  if (!all) {
    LOG(Ground, Warning) << "the model begins anew: " << all.error().message();
    return;
  }
  all_ = std::move(*all);
}

bool ScanRebuild::Rebuild() {
  Result<std::optional<RecordedItem>> item = all_->Next();
  if (!item) {
    LOG(Ground, Warning) << item.error().message();
    return true;
  }
  if (!*item) return false;
  std::visit([this](const auto& recorded) { Take(recorded); }, **item);
  return true;
}

void ScanRebuild::Take(const RecordedDepth& depth) {
  const Result<DepthFramePtr> frame = Unpack(depth, std::nullopt);
  if (!frame) return;  // Whoever put the files together has said so.
  scan_->AddRecorded(*frame);
  ++report_.frames;
}

void ScanRebuild::Take(const RecordedThermal& thermal) {
  // The stamps on this side contain the delay of the camera.
  const Result<ThermalFramePtr> frame = Unpack(thermal, Nanoseconds(0));
  if (!frame) return;
  scan_->AddRecorded(*frame);
  ++report_.frames;
}

void ScanRebuild::Report() {
  if (is_survey_ || files_.empty() || scan_ == nullptr) return;
  report_.elapsed_s = ToSeconds(clock_.SteadyNow() - begun_);
  scan_->SetRebuild(report_);
}

}  // namespace isotherm
