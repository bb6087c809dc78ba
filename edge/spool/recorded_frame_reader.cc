#include "edge/spool/recorded_frame_reader.h"

#include <utility>

namespace isotherm {

Status RecordedFrameReader::GoTo(const RecordedFrames::Place& place) {
  Close();
  // Opened anew each time: what has been written since is seen then.
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(place.file);
  if (!reader) return reader.error();
  if (Status sought = (*reader)->Seek(place.time); !sought.ok()) return sought;
  reader_ = std::move(*reader);
  at_ = place;
  return OkStatus();
}

Result<std::optional<RecordedFrameReader::Frame>> RecordedFrameReader::Next() {
  while (reader_ != nullptr) {
    Result<std::optional<RecordedItem>> item = reader_->Next();
    if (!item) return Err(item.error());
    if (!*item) break;
    if (auto* depth = std::get_if<RecordedDepth>(&**item)) {
      at_->time = depth->frame.header.capture_time;
      return std::optional<Frame>(std::move(depth->frame));
    }
    if (auto* thermal = std::get_if<RecordedThermal>(&**item)) {
      at_->time = thermal->frame.header.capture_time;
      return std::optional<Frame>(std::move(thermal->frame));
    }
  }
  return std::optional<Frame>();
}

void RecordedFrameReader::Close() {
  reader_.reset();
  at_.reset();
}

}  // namespace isotherm
